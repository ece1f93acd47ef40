// matstruct info: what a file holds.
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include <matstruct/io.h>
#include <matstruct/metrics.h>
#include <matstruct/solid.h>

#include "base/index.h"
#include "commands.h"
#include "console.h"
#include "prepare/boundary.h"
#include "prepare/domain.h"
#include "prepare/surface_facts.h"
#include "reading.h"

namespace matstruct::tool {

namespace {

struct InfoArguments {
  std::filesystem::path file;
  ReadOptions read{.keep_triangles = true};
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

// Genus of each surface of the boundary, greatest first.
std::vector<Index> genera(const Domain& domain) {
  const std::vector<Index> shell = triangle_components(domain.triangle_neighbors);
  std::map<Index, std::pair<std::set<Index>, Index>> shells;  // vertices, and number of triangles
  for (std::size_t t = 0; t < shell.size(); ++t) {
    auto& [vertices, triangles] = shells[shell[t]];
    vertices.insert(domain.surface.triangles[t].begin(), domain.surface.triangles[t].end());
    ++triangles;
  }
  std::vector<Index> result;
  for (const auto& [name, parts] : shells) result.push_back(1 - (count(parts.first) - parts.second / 2) / 2);
  std::sort(result.rbegin(), result.rend());
  return result;
}

void print_domain(const Domain& domain) {
  fmt::print("volume           {:.6g}\n",
             domain.volume / (domain.frame.scale * domain.frame.scale * domain.frame.scale));
  fmt::print("boundary         {} vertices, {} triangles; genus of its surfaces {}\n", domain.surface.vertices.size(),
             domain.surface.triangles.size(), fmt::join(genera(domain), ", "));
  print_topology(domain.topology);
  print_features(domain.features);
}

std::string places(const std::vector<Vec3>& points) {
  std::vector<std::string> list;
  for (const Vec3& p : points) list.push_back(fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z));
  return fmt::format("{}", fmt::join(list, ", "));
}

// "none", or the number and the first places.
std::string found(Index number, const std::vector<Vec3>& where) {
  if (number == 0) return "none";
  return fmt::format("{}, at {}{}", number, places(where), number > count(where) ? ", ..." : "");
}

void print_surface(const TriSurface& surface, Context& context) {
  const SurfaceFacts facts = surface_facts(surface, context);
  fmt::print("closed           {}\n", facts.border_edges == 0 ? "yes" : "no");
  fmt::print("components       {}\n", facts.components);
  fmt::print("border edges     {}\n", found(facts.border_edges, facts.border_places));
  fmt::print("crowded edges    {}\n", found(facts.crowded_edges, facts.crowded_places));
  if (facts.intersections_unknown.empty())
    fmt::print("intersections    {}\n", found(facts.intersections, facts.intersection_places));
  else
    fmt::print("intersections    not known: {}\n", facts.intersections_unknown);
}

void print_solid(const Solid& solid, Context& context) {
  if (!solid.name.empty()) fmt::print("part             {}\n", solid.name);
  fmt::print("solid            {} vertices, {} tetrahedra\n", solid.mesh.vertices.size(), solid.mesh.tets.size());
  for (const std::string& step : solid.repair.steps) fmt::print("repair           {}\n", step);
  if (solid.deviation_percent > 0)
    fmt::print("tessellation     within {:.2g} % of the diagonal of the CAD surface\n", solid.deviation_percent);
  print_domain(prepare_domain(solid.mesh, Options{}, context, solid.known_sharp()));
}

void describe_model(const std::filesystem::path& file, const ReadOptions& options, Context& context) {
  if (is_cad_file(file)) {
    fmt::print("kind             CAD model\n");
  } else {
    const auto model = read_model(file);
    const auto* surface = std::get_if<TriSurface>(&model);
    const auto* tets = std::get_if<TetMesh>(&model);
    fmt::print("kind             {}\n", surface ? "surface" : "tetrahedral mesh");
    fmt::print("elements         {} vertices, {} {}\n", surface ? surface->vertices.size() : tets->vertices.size(),
               surface ? surface->triangles.size() : tets->tets.size(), surface ? "triangles" : "tetrahedra");
    print_bounds(surface ? surface->vertices : tets->vertices);
    if (surface) print_surface(*surface, context);
  }
  try {
    for (const Solid& solid : read_solids(file, options, context)) print_solid(solid, context);
  } catch (const Error& error) {
    if (is_cad_file(file)) throw;
    fmt::print("not a solid      {}\n", error.what());
  }
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
  check_usage(arguments.read);
  Console console(arguments.console);
  Context& context = console.context();
  naming(arguments.file, [&] {
    if (arguments.file.extension() == ".ma")
      describe(read_ma(arguments.file));
    else
      describe_model(arguments.file, arguments.read, context);
  });
  console.finish();
  return kDone;
}

}  // namespace

Action add_info(CLI::App& command) {
  auto arguments = std::make_shared<InfoArguments>();
  command.add_option("FILE", arguments->file, "medial mesh (.ma), tetrahedral mesh, surface or CAD model")->required();
  add_read_options(command, arguments->read);
  add_console_options(command, arguments->console);
  return [arguments] { return info_command(*arguments); };
}

}  // namespace matstruct::tool
