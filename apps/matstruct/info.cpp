// matstruct info: what a file holds.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <matstruct/io.h>
#include <matstruct/metrics.h>

#include "base/index.h"
#include "commands.h"
#include "console.h"
#include "prepare/domain.h"
#include "prepare/tetrahedralise.h"

namespace matstruct::tool {

namespace {

struct InfoArguments {
  std::filesystem::path file;
  ConsoleOptions console;
};

void print_bounds(const std::vector<Vec3>& points) {
  if (points.empty()) return;
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) low = min(low, p), high = max(high, p);
  fmt::print("bounding box     ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}), diagonal {:.6g}\n", low.x, low.y,
             low.z, high.x, high.y, high.z, distance(low, high));
}

void print_topology(const Betti& betti) {
  fmt::print("topology         components {}, tunnels {}, cavities {}\n", betti.b0, betti.b1, betti.b2);
}

void print_features(const Features& features) {
  const auto of_kind = [&](EdgeKind kind) {
    return std::count_if(features.lines.begin(), features.lines.end(),
                         [&](const FeatureLine& line) { return line.kind == kind; });
  };
  fmt::print("sharp lines      {} convex, {} concave, {} corners, {} edges\n", of_kind(EdgeKind::kConvex),
             of_kind(EdgeKind::kConcave), features.corners.size(), features.edges.size());
}

void print_domain(const Domain& domain) {
  fmt::print("volume           {:.6g}\n",
             domain.volume / (domain.frame.scale * domain.frame.scale * domain.frame.scale));
  fmt::print("boundary         {} vertices, {} triangles\n", domain.surface.vertices.size(),
             domain.surface.triangles.size());
  print_topology(domain.topology);
  print_features(domain.features);
}

/// What is inside; a model that encloses no solid is described as such, with the reason.
template <class Model, class ToSolid>
void print_solid(const Model& model, const ToSolid& to_solid, Context& context) {
  try {
    print_domain(prepare_domain(to_solid(model), Options{}, context));
  } catch (const Error& error) {
    fmt::print("not a solid      {}\n", error.what());
  }
}

void describe(const TetMesh& solid, Context& context) {
  fmt::print("kind             tetrahedral mesh\n");
  fmt::print("elements         {} vertices, {} tetrahedra\n", solid.vertices.size(), solid.tets.size());
  print_bounds(solid.vertices);
  print_solid(solid, std::identity{}, context);
}

void describe(const TriSurface& surface, Context& context) {
  fmt::print("kind             surface\n");
  fmt::print("elements         {} vertices, {} triangles\n", surface.vertices.size(), surface.triangles.size());
  print_bounds(surface.vertices);
  print_solid(
      surface, [&](const TriSurface& s) { return tetrahedralise(s, context); }, context);
}

void describe(const MedialMesh& mesh) {
  fmt::print("kind             medial mesh\n");
  fmt::print("elements         {} spheres, {} edges, {} faces\n", mesh.centers.size(), mesh.edges.size(),
             mesh.faces.size());
  print_bounds(mesh.centers);
  const auto [least, greatest] = std::minmax_element(mesh.radii.begin(), mesh.radii.end());
  if (least != mesh.radii.end()) fmt::print("radius           {:.6g} to {:.6g}\n", *least, *greatest);
  const auto typed = [&](SphereType type) { return std::count(mesh.types.begin(), mesh.types.end(), type); };
  fmt::print("sphere types     sheet {}, seam {}, junction {}, sharp edge {}, corner {}\n", typed(SphereType::kSheet),
             typed(SphereType::kSeam), typed(SphereType::kJunction), typed(SphereType::kSharpEdge),
             typed(SphereType::kCorner));
  print_topology(betti_numbers(mesh));
  fmt::print("thin             {} tetrahedra\n", thinness(mesh).tetrahedra);
  fmt::print("triangle quality {:.4f}\n", triangle_quality(mesh));
}

int info_command(const InfoArguments& arguments) {
  Console console(arguments.console);
  Context& context = console.context();
  naming(arguments.file, [&] {
    if (arguments.file.extension() == ".ma")
      describe(read_ma(arguments.file));
    else
      std::visit([&](const auto& model) { describe(model, context); }, read_model(arguments.file));
  });
  console.finish();
  return kDone;
}

}  // namespace

Action add_info(CLI::App& command) {
  auto arguments = std::make_shared<InfoArguments>();
  command.add_option("FILE", arguments->file, "medial mesh (.ma), tetrahedral mesh or surface")->required();
  add_console_options(command, arguments->console);
  return [arguments] { return info_command(*arguments); };
}

}  // namespace matstruct::tool
