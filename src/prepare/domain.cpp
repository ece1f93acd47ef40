#include "prepare/domain.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <matstruct/error.h>

#include "base/index.h"
#include "base/union_find.h"
#include "geometry/box.h"
#include "geometry/exact.h"
#include "prepare/boundary.h"
#include "prepare/clean_solid.h"
#include "prepare/features.h"
#include "prepare/messages.h"
#include "prepare/pinches.h"

namespace matstruct {

namespace {

// Renumbers vertices so that those of the boundary come first, both groups in their old order. Returns their number.
Index put_boundary_first(CleanSolid& clean, Boundary& boundary) {
  std::vector<Index> id(clean.mesh.vertices.size(), kInvalid);
  for (const Triangle& triangle : boundary.triangles)
    for (const Index v : triangle) id[uz(v)] = 0;
  Index on_boundary = 0;
  for (Index& i : id)
    if (i != kInvalid) i = on_boundary++;
  Index next = on_boundary;
  for (Index& i : id)
    if (i == kInvalid) i = next++;
  CleanSolid moved = clean;
  for (std::size_t v = 0; v < id.size(); ++v) {
    moved.mesh.vertices[uz(id[v])] = clean.mesh.vertices[v];
    moved.input_vertex[uz(id[v])] = clean.input_vertex[v];
  }
  for (Tetrahedron& tet : moved.mesh.tets)
    for (Index& v : tet) v = id[uz(v)];
  for (Triangle& triangle : boundary.triangles)
    for (Index& v : triangle) v = id[uz(v)];
  clean = std::move(moved);
  return on_boundary;
}

Index count_distinct(std::vector<Index> labels) {
  std::sort(labels.begin(), labels.end());
  return static_cast<Index>(std::unique(labels.begin(), labels.end()) - labels.begin());
}

// Of a solid whose boundary is a closed 2-manifold: the Euler characteristic is half of the boundary's, and each
// component has one boundary surface more than it has cavities.
Betti solid_topology(const Boundary& boundary, const std::vector<std::array<Index, 3>>& triangle_neighbors,
                     Index boundary_vertices) {
  UnionFind sets(count(boundary.tet_neighbors));
  Index components = count(boundary.tet_neighbors);
  for (Index t = 0; t < count(boundary.tet_neighbors); ++t)
    for (const Index other : boundary.tet_neighbors[uz(t)])
      if (other != kInvalid && sets.unite(t, other)) --components;
  const Index triangles = count(boundary.triangles);
  const Index euler = (boundary_vertices - triangles / 2) / 2;  // V - E + F of the boundary with 2 E = 3 F
  const Index cavities = count_distinct(triangle_components(triangle_neighbors)) - components;
  return {.b0 = components, .b1 = components + cavities - euler, .b2 = cavities};
}

std::vector<Index> equal_points(const std::vector<Vec3>& vertices) {
  std::vector<Index> order(vertices.size()), points(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](Index v) { return std::array{vertices[uz(v)].x, vertices[uz(v)].y, vertices[uz(v)].z}; };
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
  for (std::size_t n = 0; n < order.size(); ++n)
    points[uz(order[n])] = n > 0 && key(order[n - 1]) == key(order[n]) ? points[uz(order[n - 1])] : order[n];
  return points;
}

// Euler characteristic of the solid that touches itself, from that of the solid cut apart: vertices with equal points
// are one, and so are edges between them.
Index glued_euler(const TetMesh& mesh, const std::vector<Index>& points, Index euler) {
  Index copies = 0;
  std::vector<Edge> edges, glued;
  for (Index v = 0; v < count(points); ++v) copies += points[uz(v)] != v ? 1 : 0;
  if (copies == 0) return euler;
  for (const Tetrahedron& t : mesh.tets)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b) {
        if (t[a] >= t[b]) continue;
        edges.push_back({t[a], t[b]});
        const Index p = points[uz(t[a])], q = points[uz(t[b])];
        glued.push_back(ordered_edge(p, q));
      }
  const auto distinct = [](std::vector<Edge>& list) {
    std::sort(list.begin(), list.end());
    return static_cast<Index>(std::unique(list.begin(), list.end()) - list.begin());
  };
  return euler - copies + distinct(edges) - distinct(glued);
}

std::vector<Vec3> normals_of(const TriSurface& surface) {
  std::vector<Vec3> normals;
  normals.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles)
    normals.push_back(
        triangle_normal(surface.vertices[uz(t[0])], surface.vertices[uz(t[1])], surface.vertices[uz(t[2])]));
  return normals;
}

std::string noise_warning(const Features& features, double diagonal) {
  const std::size_t noise = uz(features.noise_edges);
  if (features.edges.empty())
    return fmt::format("the surface has no sharp features but noise: {} taken as smooth.",
                       noise == 1 ? "1 sharp edge was" : fmt::format("{} sharp edges were", noise));
  return fmt::format(
      "many sharp edges of the surface are noise: {} of {} were taken as smooth, and bumps up to {:.2g} % of "
      "the diagonal count as noise.",
      noise, noise + features.edges.size(), 100 * features.noise_height / diagonal);
}

Features find_features(const TriSurface& surface, const std::vector<Index>& points,
                       const std::vector<std::array<Index, 3>>& neighbors, const std::vector<Vec3>& normals,
                       const Frame& frame, const Options& options, const std::vector<SharpSegment>* given,
                       Context& context) {
  const double diagonal = box_diagonal(surface.vertices);
  if (!given) {
    Features features = detect_features(surface, points, neighbors, normals, diagonal, options);
    if (features.mostly_noise) context.warnings.push_back(noise_warning(features, diagonal));
    return features;
  }
  std::vector<SharpSegment> internal = *given;
  for (SharpSegment& s : internal) {
    s.a = frame.to_internal(s.a);
    s.b = frame.to_internal(s.b);
  }
  Features features = given_features(surface, points, neighbors, normals, diagonal, options, internal);
  if (features.given_lost > 0)
    context.warnings.push_back(fmt::format("{} of {} given sharp edges are no edges of the surface, or flat.",
                                           features.given_lost, given->size()));
  return features;
}

void cut_apart(CleanSolid& clean, Boundary& boundary, const VertexName& name, Context& context) {
  const PinchCut cut = cut_pinches(clean, boundary, name);
  if (cut.copies == 0) return;
  context.warnings.push_back(
      fmt::format("the solid touches itself in vertices or edges and was cut apart there: {} copied, for example {}.",
                  cut.copies == 1 ? "1 vertex was" : fmt::format("{} vertices were", cut.copies), name(cut.example)));
}

}  // namespace

double volume_of(const TetMesh& mesh) {
  double six_volumes = 0;
  for (const Tetrahedron& tet : mesh.tets) {
    const Vec3& a = mesh.vertices[uz(tet[0])];
    six_volumes += std::abs(
        dot(cross(mesh.vertices[uz(tet[1])] - a, mesh.vertices[uz(tet[2])] - a), mesh.vertices[uz(tet[3])] - a));
  }
  return six_volumes / 6;
}

Domain prepare_domain(const TetMesh& solid, const Options& options, Context& context,
                      const std::vector<SharpSegment>* given, Coordinates coordinates) {
  options.validate();
  context.report("prepare", 0);
  CleanSolid clean = clean_solid(solid, coordinates, context);
  const VertexName name = [&](Index v) {
    const Index input = clean.input_vertex[uz(v)];
    if (input == kInvalid)
      return fmt::format("a new vertex {}", place(clean.frame.to_input(clean.mesh.vertices[uz(v)])));
    return fmt::format("vertex {} {}", input, place(solid.vertices[uz(input)]));
  };
  Boundary boundary = find_boundary(clean.mesh, name);
  cut_apart(clean, boundary, name, context);
  const Index boundary_vertices = put_boundary_first(clean, boundary);
  context.report("prepare", 0.4);
  auto triangle_neighbors = match_triangles(boundary.triangles, boundary_vertices, name);
  const Betti topology = solid_topology(boundary, triangle_neighbors, boundary_vertices);
  const auto& points = clean.mesh.vertices;
  TriSurface surface{.vertices = {points.begin(), points.begin() + boundary_vertices},
                     .triangles = std::move(boundary.triangles)};
  std::vector<Vec3> unrounded = surface.vertices;
  for (Index v = 0; v < boundary_vertices; ++v)
    if (const Index input = clean.input_vertex[uz(v)]; input != kInvalid)
      unrounded[uz(v)] = clean.frame.unrounded(solid.vertices[uz(input)]);
  std::vector<Vec3> normals = normals_of(surface);
  std::vector<Index> point_ids = equal_points(points);
  Features features =
      find_features(surface, point_ids, triangle_neighbors, normals, clean.frame, options, given, context);
  const Index euler = glued_euler(clean.mesh, point_ids, topology.b0 - topology.b1 + topology.b2);
  context.report("prepare", 0.7);
  SurfaceQuery query(surface);
  Domain domain{.frame = clean.frame,
                .diagonal = box_diagonal(surface.vertices),
                .volume = volume_of(clean.mesh),
                .topology = topology,
                .euler = euler,
                .solid = std::move(clean.mesh),
                .points = std::move(point_ids),
                .tet_neighbors = std::move(boundary.tet_neighbors),
                .tet_triangles = std::move(boundary.tet_triangles),
                .surface = std::move(surface),
                .triangle_tets = std::move(boundary.triangle_tets),
                .triangle_neighbors = std::move(triangle_neighbors),
                .triangle_normals = std::move(normals),
                .unrounded = std::move(unrounded),
                .features = std::move(features),
                .query = std::move(query)};
  context.report("prepare", 1);
  return domain;
}

}  // namespace matstruct
