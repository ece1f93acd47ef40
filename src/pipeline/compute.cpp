// The one place that knows the order of the stages.

#include <matstruct/compute.h>

#include <sys/resource.h>

#include <cmath>

#include <fmt/format.h>

#include <matstruct/io.h>
#include <matstruct/metrics.h>

#include "base/index.h"
#include "base/tolerances.h"
#include "extract/dual.h"
#include "extract/guards.h"
#include "extract/thinning.h"
#include "pipeline/preserve_loop.h"
#include "pipeline/stage_clock.h"
#include "prepare/domain.h"
#include "rpd/rpd.h"
#include "spheres/initial_spheres.h"

namespace matstruct {

namespace {

Report::Tiling tiling_of(const Domain& domain, const Rpd& rpd) {
  Report::Tiling tiling;
  tiling.volume_error = std::abs(total_volume(rpd) - domain.volume) / domain.volume;
  tiling.euler_equal = total_euler(rpd) == domain.euler;
  tiling.holds = tiling.volume_error <= tolerance::kTilingVolume && tiling.euler_equal && rpd.broken == 0;
  return tiling;
}

MedialMesh in_input_units(MedialMesh mesh, const Frame& frame) {
  for (Vec3& c : mesh.centers) c = frame.to_input(c);
  for (double& r : mesh.radii) r /= frame.scale;
  return mesh;
}

TriSurface in_input_units(TriSurface surface, const Frame& frame) {
  for (Vec3& x : surface.vertices) x = frame.to_input(x);
  return surface;
}

Report::Features features_of(const LineCheck& lines, const MedialMesh& mesh,
                             const std::vector<Index>& vertex_of_sphere) {
  Report::Features f;
  f.lines = lines.lines;
  f.lines_preserved = lines.preserved;
  f.corners = static_cast<Index>(std::count(mesh.types.begin(), mesh.types.end(), SphereType::kCorner));
  f.holds = f.lines == f.lines_preserved;
  for (const Edge& e : lines.feature_edges) {
    const Edge in_mesh{vertex_of_sphere[uz(e[0])], vertex_of_sphere[uz(e[1])]};
    f.holds = f.holds && in_mesh[0] != kInvalid && in_mesh[1] != kInvalid &&
              std::binary_search(mesh.edges.begin(), mesh.edges.end(), in_mesh);
  }
  return f;
}

void certify(const Domain& domain, const MedialMesh& mesh, Report& report) {
  TetMesh touching = domain.solid;
  for (Tetrahedron& tet : touching.tets)
    for (Index& v : tet) v = domain.points[uz(v)];
  report.input.betti = betti_numbers(touching);
  report.topology.betti = betti_numbers(mesh);
  report.topology.equal = report.topology.betti == report.input.betti;
  const Thinness thin = thinness(mesh);
  report.thin.tetrahedra = thin.tetrahedra;
  report.thin.pockets = thin.pockets - report.input.betti.b2;
  report.thin.holds = thin.tetrahedra == 0 && report.thin.pockets == 0;
}

Report::Metrics measure(const MedialMesh& mesh, const TriSurface& surface, Index samples, Context& context) {
  const Hausdorff h = hausdorff_distance(mesh, surface, samples, context);
  Report::Metrics m;
  m.triangle_quality = triangle_quality(mesh);
  m.surface_to_envelope_percent = 100 * h.surface_to_envelope / h.diagonal;
  m.envelope_to_surface_percent = 100 * h.envelope_to_surface / h.diagonal;
  m.hausdorff_percent = h.percent();
  return m;
}

Report::Input facts_of(const Domain& domain) {
  Report::Input input;
  input.tets = count(domain.solid.tets);
  input.surface_triangles = count(domain.surface.triangles);
  input.diagonal = domain.diagonal / domain.frame.scale;
  input.volume = domain.volume / std::pow(domain.frame.scale, 3);
  return input;
}

}  // namespace

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

namespace {

Result compute(const TetMesh& solid, const std::vector<SharpSegment>* sharp, const Options& options, Context& context) {
  options.validate();
  context.threads = options.threads;
  StageClock clock(context);
  Result result;
  Report& report = result.report;
  report.options = options;

  clock.begin("preparing the solid");
  const Domain domain = prepare_domain(solid, options, context, sharp);
  report.input = facts_of(domain);

  clock.begin("sampling spheres");
  Spheres spheres = initial_spheres(domain, options, context);

  clock.begin("restricted power diagram");
  RpdEngine engine(domain);
  engine.compute(weighted_points(spheres), context);

  clock.begin("preserving topology and features");
  const PreserveResult kept = preserve(domain, options, spheres, engine, context);
  report.preservation = {kept.rounds, kept.inserted, kept.violations_left, kept.violations_left == 0};
  if (!report.preservation.holds)
    context.warnings.push_back(
        fmt::format("{} cells, facets or edges of the power diagram are still not contractible after "
                    "{} rounds; the topology certificate decides.",
                    kept.violations_left, kept.rounds));
  report.tiling = tiling_of(domain, engine.diagram());

  clock.begin("thinning");
  const GuardRemoval guarded = remove_guards(dual_complex(engine.diagram()), spheres);
  const DualComplex& dual = guarded.dual;
  if (!guarded.forced.empty())
    context.warnings.push_back(
        fmt::format("{} helper spheres on concave lines could not be removed by collapses; the topology "
                    "certificate decides.",
                    guarded.forced.size()));
  MedialMesh mesh = thin(domain, spheres, dual, kept.lines.feature_edges, {options.thinning}, context);
  std::vector<Index> vertex_of_sphere(spheres.seeds.size(), kInvalid);
  for (Index v = 0; v < count(dual.vertices); ++v) vertex_of_sphere[uz(dual.vertices[uz(v)])] = v;
  report.features = features_of(kept.lines, mesh, vertex_of_sphere);

  clock.begin("certifying the topology");
  certify(domain, mesh, report);
  result.mesh = in_input_units(std::move(mesh), domain.frame);
  result.surface = in_input_units(domain.surface, domain.frame);

  clock.begin("measuring");
  report.metrics = measure(result.mesh, result.surface, options.samples, context);
  clock.end();

  report.stages = clock.stages();
  report.seconds = clock.total();
  report.peak_memory_mib = peak_memory_mib();
  report.warnings = context.warnings;
  report.guarantees_hold = report.topology.equal && report.thin.holds && report.tiling.holds && report.features.holds;
  context.report("done", 1);
  return result;
}

}  // namespace

Result compute(const TetMesh& solid, const Options& options, Context& context) {
  return compute(solid, nullptr, options, context);
}

Result compute(const Solid& solid, const Options& options, Context& context) {
  context.warnings.insert(context.warnings.end(), solid.warnings.begin(), solid.warnings.end());
  Result result = compute(solid.mesh, solid.sharp ? &*solid.sharp : nullptr, options, context);
  Report::Input& input = result.report.input;
  input.part = solid.name;
  input.repair = solid.repair;
  input.deviation_percent = solid.deviation_percent;
  input.seconds = solid.seconds;
  return result;
}

}  // namespace matstruct
