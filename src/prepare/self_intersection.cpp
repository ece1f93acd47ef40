#include "prepare/self_intersection.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include "base/index.h"
#include "base/union_find.h"
#include "prepare/boundary.h"

namespace matstruct {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

Kernel::Point_3 point(const TriSurface& surface, Index vertex) {
  const Vec3& p = surface.vertices[uz(vertex)];
  return {p.x, p.y, p.z};
}

// Faces get the ids of the surface's triangles; each fan of triangles around a vertex gets a vertex of its own, as
// the mesh must be a 2-manifold.
Mesh make_mesh(const TriSurface& surface) {
  const auto neighbors = pair_triangles(surface.triangles, [](Index v) { return fmt::format("vertex {}", v); });
  UnionFind fans = triangle_fans(surface.triangles, neighbors);
  Mesh mesh;
  std::vector<Mesh::Vertex_index> vertex_of(3 * surface.triangles.size());
  for (Index corner = 0; corner < count(vertex_of); ++corner) {
    const Index fan = fans.find(corner);  // its least corner
    if (fan == corner)
      vertex_of[uz(corner)] = mesh.add_vertex(point(surface, surface.triangles[uz(corner / 3)][uz(corner % 3)]));
    vertex_of[uz(corner)] = vertex_of[uz(fan)];
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    mesh.add_face(vertex_of[3 * t], vertex_of[3 * t + 1], vertex_of[3 * t + 2]);
  return mesh;
}

// True if two triangles have one vertex in common and nothing else: a touch, which the mesh with its vertices cut apart
// takes for an intersection.
bool touch_in_vertex(const TriSurface& surface, Index a, Index b) {
  Triangle s = surface.triangles[uz(a)], t = surface.triangles[uz(b)];
  const auto common = std::find_first_of(s.begin(), s.end(), t.begin(), t.end());
  if (common == s.end()) return false;
  std::rotate(s.begin(), common, s.end());
  std::rotate(t.begin(), std::find(t.begin(), t.end(), s[0]), t.end());
  const auto cuts = [&](const Triangle& edge, const Triangle& triangle) {
    return CGAL::do_intersect(
        Kernel::Segment_3(point(surface, edge[1]), point(surface, edge[2])),
        Kernel::Triangle_3(point(surface, triangle[0]), point(surface, triangle[1]), point(surface, triangle[2])));
  };
  return !cuts(s, t) && !cuts(t, s);
}

}  // namespace

std::optional<SelfIntersection> find_self_intersection(const TriSurface& surface) {
  const Mesh mesh = make_mesh(surface);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(pairs));
  std::erase_if(pairs, [&](const auto& pair) {
    return touch_in_vertex(surface, static_cast<Index>(pair.first), static_cast<Index>(pair.second));
  });
  if (pairs.empty()) return std::nullopt;
  SelfIntersection result{.pairs = count(pairs), .triangles = {count(surface.triangles), 0}};
  for (const auto& [a, b] : pairs) {
    const std::array<Index, 2> pair = {static_cast<Index>(std::min(a, b)), static_cast<Index>(std::max(a, b))};
    result.triangles = std::min(result.triangles, pair);
  }
  return result;
}

}  // namespace matstruct
