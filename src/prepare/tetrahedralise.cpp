#include "prepare/tetrahedralise.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <matstruct/error.h>

#include "base/index.h"
#include "base/tolerances.h"
#include "geometry/box.h"
#include "prepare/boundary.h"
#include "prepare/clean_solid.h"
#include "prepare/closed_surface.h"
#include "prepare/flat_regions.h"
#include "prepare/mesher_process.h"
#include "prepare/messages.h"
#include "prepare/point_index.h"
#include "prepare/self_intersection.h"
#include "prepare/slivers.h"

namespace matstruct {

namespace {

using Clock = std::chrono::steady_clock;

void refuse_self_intersection(const ClosedSurface& closed, const TriSurface& input) {
  const auto found = find_self_intersection(closed.surface);
  if (!found) return;
  const auto corners = [&](Index t) {
    const Triangle& v = closed.surface.triangles[uz(t)];
    const auto p = [&](std::size_t k) { return place(input.vertices[uz(closed.input_vertex[uz(v[k])])]); };
    return fmt::format("{} {} {}", p(0), p(1), p(2));
  };
  throw SurfaceError(SurfaceDefect::kSelfIntersection,
                     fmt::format("the surface cuts itself: {} of triangles intersect, for example {} and {}.",
                                 counted(uz(found->pairs), "pair", "pairs"), corners(found->triangles[0]),
                                 corners(found->triangles[1])));
}

// A way to have a surface filled. HXT gives up or crashes on some surfaces that it fills when they lie otherwise.
struct Attempt {
  mesher::Algorithm algorithm;
  const char* name;
  double share;             ///< of the time that is left
  bool as_resolved = true;  ///< also for a surface whose intersections were resolved
  bool quick = false;       ///< also if others shall not be tried
  Frame pose{};             ///< into which the surface is turned
};
const Attempt kMerged = {.algorithm = mesher::Algorithm::kHxt, .name = "HXT with flat regions merged", .share = 0.25};
const Attempt kAttempts[] = {
    {.algorithm = mesher::Algorithm::kHxt, .name = "HXT", .share = 0.5, .quick = true},
    // No axis stays where one was. What resolving left apart by rounding only shall be snapped, not filled.
    {.algorithm = mesher::Algorithm::kHxt,
     .name = "HXT on the turned surface",
     .share = 0.5,
     .as_resolved = false,
     .pose = {.offset = {}, .axes = {Vec3{2, -1, 2} / 3, Vec3{2, 2, -1} / 3, Vec3{-1, 2, 2} / 3}}},
    {.algorithm = mesher::Algorithm::kDelaunay, .name = "Delaunay", .share = 1}};

mesher::Request make_request(const ClosedSurface& closed) {
  mesher::Request request;
  for (const Triangle& t : closed.surface.triangles) request.corners.insert(request.corners.end(), t.begin(), t.end());
  request.shells = closed.triangle_shell;
  for (const std::vector<Index>& solid : closed.solids) {
    request.solids.push_back(count(solid));
    request.solids.insert(request.solids.end(), solid.begin(), solid.end());
  }
  return request;
}

// Ascending but, where the orientation asks for it, for the last two.
Tetrahedron normal_form(Tetrahedron tet) {
  bool odd = false;
  for (std::size_t i = 1; i < tet.size(); ++i)
    for (std::size_t k = i; k > 0 && tet[k - 1] > tet[k]; --k) {
      std::swap(tet[k - 1], tet[k]);
      odd = !odd;
    }
  if (odd) std::swap(tet[2], tet[3]);
  return tet;
}

// In input units, with the surface's vertices as they came. Gmsh orders tets by where they lie in memory, which differs
// with the length of a path: they are sorted.
TetMesh make_solid(const mesher::Answer& answer, const ClosedSurface& closed, const TriSurface& input,
                   const Frame& pose) {
  TetMesh solid;
  for (const Index v : closed.input_vertex) solid.vertices.push_back(input.vertices[uz(v)]);
  for (std::size_t i = 3 * closed.input_vertex.size(); i + 2 < answer.points.size(); i += 3) {
    const Vec3 p{answer.points[i], answer.points[i + 1], answer.points[i + 2]};
    solid.vertices.push_back(closed.frame.to_input(pose.turned_back(p)));
  }
  for (std::size_t i = 0; i + 3 < answer.corners.size(); i += 4)
    solid.tets.push_back(normal_form(
        Tetrahedron{answer.corners[i], answer.corners[i + 1], answer.corners[i + 2], answer.corners[i + 3]}));
  std::sort(solid.tets.begin(), solid.tets.end());
  return solid;
}

std::vector<Triangle> normal_form(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) t = from_least_vertex(t);
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// What is wrong with the mesher's tets as a filling of the surface; nothing if they are right.
std::string find_fault(TetMesh& solid, const ClosedSurface& closed) {
  const auto bad = [&](Index v) { return v < 0 || v >= count(solid.vertices); };
  for (const Tetrahedron& tet : solid.tets)
    if (std::any_of(tet.begin(), tet.end(), bad)) return "made tets of unknown vertices";
  try {
    if (!repair_slivers(solid, frames_of(solid))) return "made flat or inverted tets";
    const Boundary boundary = find_boundary(solid, [](Index v) { return fmt::format("vertex {}", v); });
    if (normal_form(boundary.triangles) != normal_form(closed.surface.triangles))
      return "did not keep the triangles of the surface";
  } catch (const Error&) {
    return "made tets that overlap";
  }
  return "";
}

// The edges that are known to be sharp, as pairs of vertices.
std::vector<Edge> edges_between(const std::vector<Vec3>& points, const Frame& frame,
                                const std::vector<SharpSegment>& sharp) {
  const PointIndex index(points, tolerance::kFlat);
  std::vector<Edge> edges;
  for (const SharpSegment& s : sharp) {
    const Index a = index.find(frame.unrounded(s.a)), b = index.find(frame.unrounded(s.b));
    if (a != kInvalid && b != kInvalid) edges.push_back(ordered_edge(a, b));
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

// The same solids with merged flat regions. Nothing where that cannot be done.
std::optional<ClosedSurface> merged_once(const ClosedSurface& closed, const TriSurface& input,
                                         const std::vector<SharpSegment>* sharp) {
  std::vector<Vec3> exact;
  for (const Index v : closed.input_vertex) exact.push_back(closed.frame.unrounded(input.vertices[uz(v)]));
  const auto kept = sharp ? edges_between(exact, closed.frame, *sharp) : std::vector<Edge>{};
  const auto flat = merge_flat_regions(closed.surface, exact, kept);
  if (!flat) return std::nullopt;
  ClosedSurface merged{.frame = closed.frame,
                       .surface = {.vertices = {}, .triangles = flat->triangles},
                       .input_vertex = {},
                       .triangle_shell = {},
                       .shells = closed.shells,
                       .solids = closed.solids};
  for (const Index v : flat->vertices) {
    merged.surface.vertices.push_back(closed.surface.vertices[uz(v)]);
    merged.input_vertex.push_back(closed.input_vertex[uz(v)]);
  }
  for (const Index t : flat->input_triangles) merged.triangle_shell.push_back(closed.triangle_shell[uz(t)]);
  return merged;
}

// Once more in the frame of what is left, which does not depend on the vertices that are gone.
std::optional<ClosedSurface> merged_flat(const ClosedSurface& closed, const TriSurface& input,
                                         const std::vector<SharpSegment>* sharp) {
  auto merged = merged_once(closed, input, sharp);
  if (!merged) return std::nullopt;
  std::vector<Vec3> points;
  for (const Index v : merged->input_vertex) points.push_back(input.vertices[uz(v)]);
  merged->frame = fit_frame(points, merged->surface.triangles, Coordinates::kRounded);
  for (std::size_t v = 0; v < points.size(); ++v) merged->surface.vertices[v] = merged->frame.to_internal(points[v]);
  return merged_once(*merged, input, sharp);
}

// Asks Gmsh for tets, one way after another.
class Filling {
 public:
  Filling(const TriSurface& input, const FillOptions& options, Context& context, Clock::time_point begin)
      : input_(input), options_(options), context_(context), begin_(begin) {}

  // Within a share of the time that is left, as HXT may run for ever.
  std::optional<TetMesh> fill(const ClosedSurface& closed, const Attempt& attempt) {
    mesher::Request request = make_request(closed);
    request.size = options_.tet_size * box_diagonal(closed.surface.vertices);
    request.algorithm = attempt.algorithm;
    for (const Vec3& vertex : closed.surface.vertices) {
      const Vec3 p = attempt.pose.turned(vertex);
      request.points.insert(request.points.end(), {p.x, p.y, p.z});
    }
    const std::chrono::duration<double> spent = Clock::now() - begin_;
    const mesher::Answer answer = mesher::run(request, attempt.share * (options_.seconds - spent.count()), context_);
    TetMesh solid = make_solid(answer, closed, input_, attempt.pose);
    const std::string fault = answer.error.empty() ? find_fault(solid, closed) : answer.error;
    if (fault.empty()) return solid;
    faults_ += fmt::format("{}Gmsh's {} {}", faults_.empty() ? "" : "; ", attempt.name, fault);
    return std::nullopt;
  }

  std::optional<TetMesh> fill_merged(const ClosedSurface& closed) {
    const auto merged = merged_flat(closed, input_, options_.sharp);
    return merged ? fill(*merged, kMerged) : std::nullopt;
  }

  const std::string& faults() const { return faults_; }

 private:
  const TriSurface& input_;
  const FillOptions& options_;
  Context& context_;
  Clock::time_point begin_;
  std::string faults_;
};

ClosedSurface closed_and_simple(const TriSurface& surface, Context& context) {
  return close_surface(surface, context, [&](const ClosedSurface& c) { refuse_self_intersection(c, surface); });
}

}  // namespace

TetMesh tetrahedralise(const TriSurface& surface, Context& context, const FillOptions& options) {
  Filling filling(surface, options, context, Clock::now());
  context.report("tetrahedralise", 0);
  const ClosedSurface closed =
      options.resolved ? close_resolved_surface(surface, context) : closed_and_simple(surface, context);
  context.report("tetrahedralise", 0.3);
  std::optional<TetMesh> solid;
  if (options.merge_flat && !options.resolved) solid = filling.fill_merged(closed);
  for (const Attempt& attempt : kAttempts)
    if (!solid && (!options.resolved || attempt.as_resolved) && (!options.quick || attempt.quick))
      solid = filling.fill(closed, attempt);
  if (!solid)
    throw SurfaceError(SurfaceDefect::kNotFilled,
                       fmt::format("the surface could not be filled with tetrahedra: {}.", filling.faults()));
  context.report("tetrahedralise", 1);
  return std::move(*solid);
}

std::optional<TetMesh> refill_merged(const TetMesh& solid, Context& context, const FillOptions& options) {
  const auto begin = Clock::now();
  const std::size_t warnings = context.warnings.size();
  const VertexName name = [](Index v) { return fmt::format("vertex {}", v); };
  std::optional<TetMesh> refilled;
  try {
    const CleanSolid clean = clean_solid(solid, Coordinates::kExact, context);
    TriSurface surface{.vertices = {}, .triangles = find_boundary(clean.mesh, name).triangles};
    match_triangles(surface.triangles, count(clean.mesh.vertices), name);
    for (const Vec3& p : clean.mesh.vertices) surface.vertices.push_back(clean.frame.to_input(p));
    for (Index v = 0; v < count(surface.vertices); ++v)
      if (const Index input = clean.input_vertex[uz(v)]; input != kInvalid)
        surface.vertices[uz(v)] = solid.vertices[uz(input)];
    Filling filling(surface, options, context, begin);
    refilled = filling.fill_merged(closed_and_simple(surface, context));
    const double volume = volume_of(solid);
    if (refilled && !(std::abs(volume_of(*refilled) - volume) <= tolerance::kSameMeasure * volume)) refilled.reset();
  } catch (const Error&) {
    // What is wrong with the tets is for prepare_domain() to say.
  }
  if (!refilled) context.warnings.resize(warnings);
  return refilled;
}

}  // namespace matstruct
