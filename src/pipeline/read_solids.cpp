// From a file of any kind to solids.
#include <matstruct/solid.h>

#include <chrono>
#include <numbers>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <matstruct/compute.h>
#include <matstruct/error.h>
#include <matstruct/io.h>

#include "base/index.h"
#include "base/tolerances.h"
#include "io/file_kind.h"
#include "prepare/cad_model.h"
#include "prepare/closed_surface.h"
#include "prepare/mesher_process.h"
#include "prepare/solidify.h"
#include "prepare/tetrahedralise.h"

namespace matstruct {

namespace {

using Clock = std::chrono::steady_clock;

// Whatever goes on in `work` is timed, and its warnings are the solid's own.
template <class Work>
void with_solid(Solid& solid, Context& context, const Work& work) {
  const auto begin = Clock::now();
  std::vector<std::string> earlier = std::exchange(context.warnings, {});
  try {
    work();
  } catch (...) {
    context.warnings = std::move(earlier);
    throw;
  }
  solid.warnings.insert(solid.warnings.end(), context.warnings.begin(), context.warnings.end());
  context.warnings = std::move(earlier);
  solid.seconds += std::chrono::duration<double>(Clock::now() - begin).count();
}

void set_sharp_lines(const std::filesystem::path& file, const std::vector<Vec3>& vertices, Solid& solid) {
  if (file.empty()) return;
  solid.sharp.emplace();
  for (const Edge& e : read_sharp_lines(file, count(vertices)))
    solid.sharp->push_back({vertices[uz(e[0])], vertices[uz(e[1])], std::nullopt});
}

Solid read_mesh(const std::filesystem::path& file, const ReadOptions& options, Context& context) {
  Solid solid;
  with_solid(solid, context, [&] {
    if (is_surface_file(file) || !options.keep_triangles) mesher::start(context);
    auto model = read_model(file);
    if (auto* tets = std::get_if<TetMesh>(&model)) {
      solid.mesh = std::move(*tets);
      set_sharp_lines(options.features, solid.mesh.vertices, solid);
      if (options.keep_triangles) return;
      if (auto other = refill_merged(solid.mesh, context, {.tet_size = options.tet_size, .sharp = solid.known_sharp()}))
        solid.mesh = std::move(*other);
      return;
    }
    const TriSurface& surface = std::get<TriSurface>(model);
    set_sharp_lines(options.features, surface.vertices, solid);
    Solidified made = solidify(surface, options, context, solid.known_sharp());
    solid.mesh = std::move(made.mesh);
    solid.repair = std::move(made.repair);
  });
  return solid;
}

// A tessellation may cut itself where walls are thinner than its deflection, and Gmsh fails on some: finer ones are
// tried before any repair. The ways of filling that seldom help are left to them: each one that fails takes as long as
// a finer tessellation.
void fill_cad_solid(const std::filesystem::path& file, CadSolid part, std::size_t number, const ReadOptions& options,
                    Solid& solid, Context& context) {
  constexpr double kFiner = 0.5, kFinest = 1.0 / 16;
  constexpr double kSeconds = tolerance::kMesherSeconds / 2;
  const auto begin = Clock::now();
  double deflection = options.deflection;
  const auto may_be_finer = [&] { return kFiner * deflection >= kFinest * options.deflection; };
  while (true) {
    try {
      solid.mesh = tetrahedralise(part.surface, context,
                                  {.tet_size = options.tet_size,
                                   .seconds = kSeconds,
                                   .merge_flat = !options.keep_triangles,
                                   .quick = deflection == options.deflection,
                                   .sharp = &part.edges});
      break;
    } catch (const SurfaceError& error) {
      if (std::chrono::duration<double>(Clock::now() - begin).count() > kSeconds) throw;
      if (error.defect == SurfaceDefect::kOpen || !may_be_finer()) {
        Solidified made = solidify(part.surface, options, context, &part.edges);
        solid.mesh = std::move(made.mesh);
        solid.repair = std::move(made.repair);
        break;
      }
    }
    // Angles and not the deflection may bound the triangles.
    const std::size_t triangles = part.surface.triangles.size();
    while (may_be_finer() && part.surface.triangles.size() == triangles) {
      deflection *= kFiner;
      CadModel finer = read_cad_model(file, deflection, context);
      if (finer.solids.size() > number) part = std::move(finer.solids[number]);
    }
  }
  if (deflection != options.deflection)
    context.warnings.push_back(
        fmt::format("the tessellation could not be filled with tetrahedra and was made {:.2g} times finer.",
                    options.deflection / deflection));
  solid.sharp = std::move(part.edges);
  solid.deviation_percent = part.deviation_percent;
}

std::vector<Solid> read_cad(const std::filesystem::path& file, const ReadOptions& options, Context& context) {
  if (!options.features.empty())
    throw Error(
        fmt::format("{}: the vertices of a CAD model have no ids that a file of sharp lines could name; its own "
                    "edges are used.",
                    options.features.string()));
  check_readable(file);
  std::vector<Solid> solids(1);
  CadModel model;
  with_solid(solids[0], context, [&] {
    context.report("reading the CAD model", 0);
    model = read_cad_model(file, options.deflection, context);
    if (!model.note.empty()) context.warnings.push_back(model.note);
  });
  solids.resize(model.solids.size());
  for (std::size_t s = 0; s < solids.size(); ++s) {
    if (solids.size() > 1) solids[s].name = model.solids[s].name;
    with_solid(solids[s], context, [&] {
      try {
        fill_cad_solid(file, std::move(model.solids[s]), s, options, solids[s], context);
      } catch (const Error& error) {
        // What the reader noticed may be why.
        if (model.note.empty()) throw;
        throw Error(fmt::format("{} Note: {}", error.what(), model.note));
      }
    });
  }
  return solids;
}

}  // namespace

bool is_cad_file(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".step" || extension == ".stp" || extension == ".brep" || extension == ".brp";
}

void ReadOptions::validate() const {
  const auto check = [](const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high))
      throw Error(fmt::format("{} is {}, but must be between {} and {}.", name, value, low, high));
  };
  check("deflection", deflection, 1e-6, 0.1);
  if (tet_size != 0) check("tet_size", tet_size, 1e-3, 10);
  check("hole_size", hole_size, 0, 1);
  check("wrap_size", wrap_size, 1e-3, 0.5);
}

std::vector<Solid> read_solids(const std::filesystem::path& file, const ReadOptions& options, Context& context) {
  options.validate();
  if (is_cad_file(file)) return read_cad(file, options, context);
  std::vector<Solid> solids;
  solids.push_back(read_mesh(file, options, context));
  return solids;
}

TetMesh read_solid(const std::filesystem::path& file, Context& context) {
  std::vector<Solid> solids = read_solids(file, {}, context);
  if (solids.size() > 1)
    throw Error(
        fmt::format("{}: the file holds {} solids; read them with read_solids().", file.string(), solids.size()));
  context.warnings.insert(context.warnings.end(), solids[0].warnings.begin(), solids[0].warnings.end());
  return std::move(solids[0].mesh);
}

}  // namespace matstruct
