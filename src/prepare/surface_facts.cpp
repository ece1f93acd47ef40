#include "prepare/surface_facts.h"

#include <algorithm>

#include "base/index.h"
#include "base/tolerances.h"
#include "base/union_find.h"
#include "prepare/closed_surface.h"
#include "prepare/mesher_process.h"

namespace matstruct {

namespace {

constexpr std::size_t kPlaces = 5;

Index count_components(const TriSurface& surface) {
  UnionFind sets(count(surface.vertices));
  Index components = count(surface.vertices);
  for (const Triangle& t : surface.triangles) {
    if (sets.unite(t[0], t[1])) --components;
    if (sets.unite(t[1], t[2])) --components;
  }
  return components;
}

void count_edges(const TriSurface& surface, SurfaceFacts& facts) {
  std::vector<Edge> edges;
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::sort(edges.begin(), edges.end());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end] == edges[begin]) ++end;
    if (end - begin == 2) continue;
    ++(end - begin == 1 ? facts.border_edges : facts.crowded_edges);
    auto& places = end - begin == 1 ? facts.border_places : facts.crowded_places;
    const Vec3 &a = surface.vertices[uz(edges[begin][0])], &b = surface.vertices[uz(edges[begin][1])];
    if (places.size() < kPlaces) places.push_back((a + b) * 0.5);
  }
}

void find_intersections(const TriSurface& surface, SurfaceFacts& facts, Context& context) {
  mesher::Request request;
  request.task = mesher::Task::kIntersections;
  request.size = kPlaces;
  for (const Vec3& p : surface.vertices) request.points.insert(request.points.end(), {p.x, p.y, p.z});
  for (const Triangle& t : surface.triangles) request.corners.insert(request.corners.end(), t.begin(), t.end());
  const mesher::Answer answer = mesher::run(request, tolerance::kMesherSeconds, context);
  facts.intersections_unknown = answer.error;
  facts.intersections = static_cast<Index>(answer.changed);
  for (std::size_t i = 0; i + 2 < answer.points.size(); i += 3)
    facts.intersection_places.push_back({answer.points[i], answer.points[i + 1], answer.points[i + 2]});
}

}  // namespace

SurfaceFacts surface_facts(const TriSurface& surface, Context& context) {
  const TriSurface welded = weld_surface(surface);
  SurfaceFacts facts;
  facts.components = count_components(welded);
  count_edges(welded, facts);
  find_intersections(welded, facts, context);
  return facts;
}

}  // namespace matstruct
