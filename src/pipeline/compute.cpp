// The one place that knows the order of the stages.

#include <matstruct/compute.h>

#include <sys/resource.h>

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <matstruct/io.h>
#include <matstruct/metrics.h>

#include "base/index.h"
#include "base/tolerances.h"
#include "extract/axis_oracle.h"
#include "extract/bare_lines.h"
#include "extract/remesh.h"
#include "extract/sheet_gaps.h"
#include "extract/small_strata.h"
#include "extract/stratified_mesh.h"
#include "pipeline/contacts_stage.h"
#include "pipeline/stage_clock.h"
#include "pipeline/structure_loop.h"
#include "prepare/domain.h"
#include "prepare/edge_heights.h"
#include "rpd/rpd.h"
#include "spheres/initial_spheres.h"
#include "spheres/unround.h"

namespace matstruct {

namespace {

// If the mesh has not the topology or the sharp lines of the solid, it is made anew of so many times the density, which
// helps where power cells have handles; up to the options' limit.
constexpr int kAttempts = 3;
constexpr double kDenser = 1.25, kGreatestGamma = 1000;

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

Structure in_input_units(Structure structure, const Frame& frame) {
  for (SheetStratum& sheet : structure.sheets) {
    sheet.area /= frame.scale * frame.scale;
    for (double* radius : {&sheet.mean_radius, &sheet.min_radius, &sheet.max_radius}) *radius /= frame.scale;
  }
  for (auto* curves : {&structure.seams, &structure.boundaries, &structure.curves})
    for (CurveStratum& curve : *curves) curve.length /= frame.scale;
  return structure;
}

// Those of the pairs of spheres that are edges of the mesh, as such.
std::vector<Edge> edges_in_mesh(const MedialMesh& mesh, const std::vector<Edge>& edges,
                                const std::vector<Index>& vertex_of_sphere) {
  std::vector<Edge> result;
  for (const Edge& e : edges) {
    const Edge in_mesh{vertex_of_sphere[uz(e[0])], vertex_of_sphere[uz(e[1])]};
    if (in_mesh[0] != kInvalid && std::binary_search(mesh.edges.begin(), mesh.edges.end(), in_mesh))
      result.push_back(in_mesh);
  }
  return result;
}

std::vector<Index> vertices_of(const std::vector<Index>& spheres, Index all) {
  std::vector<Index> vertex(uz(all), kInvalid);
  for (Index v = 0; v < count(spheres); ++v) vertex[uz(spheres[uz(v)])] = v;
  return vertex;
}

// `vertex_of_sphere` follows.
MedialMesh remeshed(const Domain& domain, const Options& options, const StructureResult& structure, FinderPool& finders,
                    MedialMesh mesh, const std::vector<Edge>& feature_edges, std::vector<Index>& vertex_of_sphere,
                    const Context& context) {
  const std::vector<Edge> fixed = edges_in_mesh(mesh, feature_edges, vertex_of_sphere);
  const double target = target_spacing(domain, options);
  std::vector<TangentSphere> spheres;
  for (const Index s : structure.thin.spheres) spheres.push_back(structure.medial[uz(s)]);
  const AxisOracle axis =
      structure.organic ? shrinking_oracle(domain, smooth_angle(options)) : contact_oracle(finders, spheres, target);
  RemeshResult result = remesh(stratify(std::move(mesh), fixed), axis, {target}, context);
  for (Index& v : vertex_of_sphere)
    if (v != kInvalid) v = result.vertex_of_input[uz(v)];
  return std::move(result.mesh);
}

Report::Features features_of(const LineCheck& lines, const MedialMesh& mesh,
                             const std::vector<Index>& vertex_of_sphere) {
  Report::Features f;
  f.lines = lines.lines;
  f.lines_preserved = lines.preserved;
  f.corners = static_cast<Index>(std::count(mesh.types.begin(), mesh.types.end(), SphereType::kCorner));
  f.holds = f.lines == f.lines_preserved &&
            edges_in_mesh(mesh, lines.feature_edges, vertex_of_sphere).size() == lines.feature_edges.size();
  return f;
}

// As it is, touching itself or not.
Betti topology_of(const Domain& domain) {
  TetMesh touching = domain.solid;
  for (Tetrahedron& tet : touching.tets)
    for (Index& v : tet) v = domain.points[uz(v)];
  return betti_numbers(touching);
}

void certify(const MedialMesh& mesh, Report& report) {
  report.topology.betti = betti_numbers(mesh);
  report.topology.equal = report.topology.betti == report.input.betti;
  const Thinness thin = thinness(mesh);
  report.thin.pockets = thin.pockets - report.input.betti.b2;
  // A hollow tetrahedron is a pocket; around a small cavity of the solid it is right.
  report.thin.tetrahedra = std::min(thin.tetrahedra, std::max<Index>(report.thin.pockets, 0));
  report.thin.holds = report.thin.tetrahedra == 0 && report.thin.pockets == 0;
}

// Lines that are lost though preservation has ended well; where it has not, denser spheres take long and help no more.
bool worth_another(const Report& report) {
  return !report.topology.equal || !report.thin.holds || (!report.features.holds && report.preservation.holds);
}

Report::Metrics measure(const MedialMesh& mesh, const TriSurface& surface, const Options& options, Context& context) {
  const Hausdorff h = hausdorff_distance(mesh, surface, options.samples, context);
  const Medialness medial = medialness(mesh, surface, options.samples, context);
  const StructureErrors errors = structure_errors(mesh, surface, options.convex_angle, context);
  Report::Metrics m;
  m.triangle_quality = triangle_quality(mesh);
  m.surface_to_envelope_percent = 100 * h.surface_to_envelope / h.diagonal;
  m.envelope_to_surface_percent = 100 * h.envelope_to_surface / h.diagonal;
  m.hausdorff_percent = h.percent();
  m.medialness_mean_percent = 100 * medial.mean / h.diagonal;
  m.medialness_max_percent = 100 * medial.max / h.diagonal;
  m.mser = errors.mser();
  m.spikes = errors.spikes;
  m.spike_share = errors.spike_share();
  return m;
}

Report::Input facts_of(const Domain& domain, const TetMesh& solid) {
  Report::Input input;
  input.tets = count(domain.solid.tets);
  input.surface_triangles = count(domain.surface.triangles);
  input.diagonal = domain.diagonal / domain.frame.scale;
  input.volume = volume_of(solid);  // without the rounding of the domain
  input.betti = topology_of(domain);
  return input;
}

}  // namespace

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

namespace {

// drop_small_strata() of a mesh of the spheres structure.thin.spheres, which follow it. `small`: without what is known
// of the spheres.
void drop_small_strata_of(const Domain& domain, double smooth_angle, SmallStrataOptions small,
                          StructureResult& structure, MedialMesh& mesh) {
  std::vector<Index>& spheres = structure.thin.spheres;
  for (const Index s : spheres) {
    const TangentSphere& sphere = structure.medial[uz(s)];
    small.contacts.push_back(clear_contacts(domain, sphere));
    small.faint.push_back(!on_medial_curve(sphere) && is_faint(domain, sphere, tolerance::kStrongTurn * smooth_angle));
  }
  const std::vector<Edge> fixed =
      edges_in_mesh(mesh, structure.kept.lines.feature_edges, vertices_of(spheres, count(structure.medial)));
  std::vector<Index> left = drop_small_strata(mesh, fixed, small);
  for (Index& v : left) v = spheres[uz(v)];
  spheres = std::move(left);
}

// From spheres on the surface to the finished mesh, internal units.
MedialMesh medial_mesh(const Domain& domain, const Options& options, FinderPool& finders, StageClock& clock,
                       Report& report, Context& context) {
  clock.begin("sampling spheres");
  Spheres spheres = initial_spheres(domain, options, context);

  RpdEngine engine(domain);
  StructureResult structure = build_structure(domain, options, spheres, engine, finders, clock, context);
  const PreserveResult& kept = structure.kept;
  report.preservation = {kept.rounds, kept.inserted, kept.violations_left, kept.violations_left == 0};
  if (!report.preservation.holds)
    context.warnings.push_back(
        fmt::format("{} cells, facets or edges of the power diagram are still not contractible after "
                    "{} rounds; the topology certificate decides.",
                    kept.violations_left, kept.rounds));
  report.particles = structure.particles;
  report.tiling = tiling_of(domain, engine.diagram());
  if (structure.forced_guards > 0)
    context.warnings.push_back(
        fmt::format("{} helper spheres on concave lines could not be removed by collapses and became medial spheres.",
                    structure.forced_guards));
  MedialMesh mesh = std::move(structure.thin.mesh);
  std::vector<Index> vertex_of_sphere = vertices_of(structure.thin.spheres, count(structure.medial));
  if (!structure.organic && options.clean) {
    const double deviation = options.deviation / 100 * domain.diagonal, spacing = target_spacing(domain, options);
    const double smooth = smooth_angle(options);
    const SmallStrataOptions small{
        .spacing = spacing, .cover = deviation, .resolution = height_of_facets(domain, smooth)};
    drop_small_strata_of(domain, smooth, small, structure, mesh);
    fill_sheet_gaps(finders, structure.medial, structure.thin.spheres, deviation, mesh);
    // Where filled gaps have lengthened one seam, what is left of another one may be small now.
    drop_small_strata_of(domain, smooth, small, structure, mesh);
    cover_bare_lines(finders, spacing, structure.medial, structure.thin.spheres, mesh);
    vertex_of_sphere = vertices_of(structure.thin.spheres, count(structure.medial));
  }

  clock.begin("remeshing");
  if (options.remesh)
    mesh = remeshed(domain, options, structure, finders, std::move(mesh), kept.lines.feature_edges, vertex_of_sphere,
                    context);
  report.features = features_of(kept.lines, mesh, vertex_of_sphere);
  return mesh;
}

Result compute(const TetMesh& solid, const std::vector<SharpSegment>* sharp, const Options& options, Context& context) {
  options.validate();
  context.threads = options.threads;
  StageClock clock(context);
  Result result;
  Report& report = result.report;
  report.options = options;

  clock.begin("preparing the solid");
  const Domain domain = prepare_domain(solid, options, context, sharp, Coordinates::kRounded);
  report.input = facts_of(domain, solid);

  FinderPool finders(domain, smooth_angle(options));
  MedialMesh mesh;
  Options used = options;
  for (int attempt = 1;; ++attempt) {
    const std::size_t warnings = context.warnings.size();
    mesh = medial_mesh(domain, used, finders, clock, report, context);
    clock.begin("certifying the topology");
    certify(mesh, report);
    if (!worth_another(report) || attempt == kAttempts) break;
    const double too_coarse = std::exchange(used.gamma, std::min(kDenser * used.gamma, kGreatestGamma));
    context.warnings.resize(warnings);
    context.warnings.push_back(
        fmt::format("the mesh for a gamma of {:g} had not the solid's topology and sharp lines; {:g} was taken.",
                    too_coarse, used.gamma));
  }

  clock.begin("finding contacts");
  result.contacts = vertex_contacts(finders, mesh, context);
  const TriSurface unrounded{.vertices = domain.unrounded, .triangles = domain.surface.triangles};
  const SurfaceQuery query(unrounded);
  unround(domain, query, context, result.contacts, mesh);
  result.structure = structure_of(mesh);
  mesh.types = types_by_structure(mesh, result.structure);
  report.structure = strata_facts(query, domain.diagonal, mesh, result.structure, result.contacts);

  result.structure = in_input_units(std::move(result.structure), domain.frame);
  for (Vec3& x : result.contacts.points) x = domain.frame.to_input(x);
  result.mesh = in_input_units(std::move(mesh), domain.frame);
  result.surface = in_input_units(unrounded, domain.frame);

  clock.begin("measuring");
  report.metrics = measure(result.mesh, result.surface, options, context);
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
  Result result = compute(solid.mesh, solid.known_sharp(), options, context);
  Report::Input& input = result.report.input;
  input.part = solid.name;
  input.repair = solid.repair;
  input.deviation_percent = solid.deviation_percent;
  input.seconds = solid.seconds;
  return result;
}

}  // namespace matstruct
