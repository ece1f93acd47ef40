#include "prepare/tetrahedralise.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include <matstruct/error.h>

#include "base/index.h"
#include "geometry/box.h"
#include "prepare/boundary.h"
#include "prepare/clean_solid.h"
#include "prepare/closed_surface.h"
#include "prepare/mesher_process.h"
#include "prepare/messages.h"
#include "prepare/self_intersection.h"
#include "prepare/slivers.h"

namespace matstruct {

namespace {

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
  bool as_resolved = true;  ///< also for a surface whose intersections were resolved
  Frame pose{};             ///< into which the surface is turned
};
const Attempt kAttempts[] = {
    {mesher::Algorithm::kHxt, "HXT"},
    // No axis stays where one was. What resolving left apart by rounding only shall be snapped, not filled.
    {mesher::Algorithm::kHxt,
     "HXT on the turned surface",
     false,
     {.offset = {}, .axes = {Vec3{2, -1, 2} / 3, Vec3{2, 2, -1} / 3, Vec3{-1, 2, 2} / 3}}},
    {mesher::Algorithm::kDelaunay, "Delaunay"}};

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

// In input units, with the surface's vertices as they came.
TetMesh make_solid(const mesher::Answer& answer, const ClosedSurface& closed, const TriSurface& input,
                   const Frame& pose) {
  TetMesh solid;
  for (const Index v : closed.input_vertex) solid.vertices.push_back(input.vertices[uz(v)]);
  for (std::size_t i = 3 * closed.input_vertex.size(); i + 2 < answer.points.size(); i += 3) {
    const Vec3 p{answer.points[i], answer.points[i + 1], answer.points[i + 2]};
    solid.vertices.push_back(closed.frame.to_input(pose.turned_back(p)));
  }
  for (std::size_t i = 0; i + 3 < answer.corners.size(); i += 4)
    solid.tets.push_back({answer.corners[i], answer.corners[i + 1], answer.corners[i + 2], answer.corners[i + 3]});
  return solid;
}

// A triangle with its least vertex first, which keeps the orientation.
Triangle rotated(const Triangle& t) {
  Triangle result = t;
  std::rotate(result.begin(), std::min_element(result.begin(), result.end()), result.end());
  return result;
}

std::vector<Triangle> normal_form(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) t = rotated(t);
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// What is wrong with the mesher's tets as a filling of the surface; nothing if they are right.
std::string find_fault(TetMesh& solid, const ClosedSurface& closed) {
  const auto bad = [&](Index v) { return v < 0 || v >= count(solid.vertices); };
  for (const Tetrahedron& tet : solid.tets)
    if (std::any_of(tet.begin(), tet.end(), bad)) return "made tets of unknown vertices";
  try {
    if (!repair_slivers(solid, {frame_of(solid, Coordinates::kExact), frame_of(solid, Coordinates::kRounded)}))
      return "made flat or inverted tets";
    const Boundary boundary = find_boundary(solid, [](Index v) { return fmt::format("vertex {}", v); });
    if (normal_form(boundary.triangles) != normal_form(closed.surface.triangles))
      return "did not keep the triangles of the surface";
  } catch (const Error&) {
    return "made tets that overlap";
  }
  return "";
}

}  // namespace

TetMesh tetrahedralise(const TriSurface& surface, Context& context, const FillOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  context.report("tetrahedralise", 0);
  const ClosedSurface closed =
      options.resolved
          ? close_resolved_surface(surface, context)
          : close_surface(surface, context, [&](const ClosedSurface& c) { refuse_self_intersection(c, surface); });
  context.report("tetrahedralise", 0.3);
  mesher::Request request = make_request(closed);
  request.size = options.tet_size * box_diagonal(closed.surface.vertices);
  std::string faults;
  for (const Attempt& attempt : kAttempts) {
    if (options.resolved && !attempt.as_resolved) continue;
    request.algorithm = attempt.algorithm;
    request.points.clear();
    for (const Vec3& vertex : closed.surface.vertices) {
      const Vec3 p = attempt.pose.turned(vertex);
      request.points.insert(request.points.end(), {p.x, p.y, p.z});
    }
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    const mesher::Answer answer = mesher::run(request, options.seconds - spent.count(), context);
    TetMesh solid = make_solid(answer, closed, surface, attempt.pose);
    const std::string fault = answer.error.empty() ? find_fault(solid, closed) : answer.error;
    if (fault.empty()) {
      context.report("tetrahedralise", 1);
      return solid;
    }
    faults += fmt::format("{}Gmsh's {} {}", faults.empty() ? "" : "; ", attempt.name, fault);
  }
  throw SurfaceError(SurfaceDefect::kNotFilled,
                     fmt::format("the surface could not be filled with tetrahedra: {}.", faults));
}

}  // namespace matstruct
