#include "prepare/boundary.h"

#include <algorithm>

#include <matstruct/error.h>

#include "base/index.h"
#include "prepare/messages.h"

namespace matstruct {

namespace {

// A facet of a tet: sorted vertices, and whether sorting them was an even permutation of the outward order.
struct Facet {
  Triangle key;
  Index tet = 0;
  std::uint8_t local = 0;
  bool even = true;
};

Facet make_facet(const TetMesh& mesh, Index tet, std::size_t local) {
  const Tetrahedron& v = mesh.tets[uz(tet)];
  const auto& f = kTetFacets[local];
  Facet facet{.key = {v[f[0]], v[f[1]], v[f[2]]}, .tet = tet, .local = static_cast<std::uint8_t>(local)};
  const auto order = [&](std::size_t a, std::size_t b) {
    if (facet.key[a] <= facet.key[b]) return;
    std::swap(facet.key[a], facet.key[b]);
    facet.even = !facet.even;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return facet;
}

std::vector<Facet> sorted_facets(const TetMesh& mesh) {
  std::vector<Facet> facets;
  facets.reserve(4 * mesh.tets.size());
  for (Index t = 0; t < count(mesh.tets); ++t)
    for (std::size_t k = 0; k < 4; ++k) facets.push_back(make_facet(mesh, t, k));
  std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) {
    if (a.key != b.key) return a.key < b.key;
    return a.tet < b.tet;
  });
  return facets;
}

std::string corners(const Triangle& t, const VertexName& name) {
  return fmt::format("{}, {}, {}", name(t[0]), name(t[1]), name(t[2]));
}

// An edge of a triangle, opposite its local vertex `local`, with lower < upper.
struct HalfEdge {
  Edge key;
  Index triangle = 0;
  std::uint8_t local = 0;
  bool forward = true;  // the triangle runs from the lower to the upper vertex
};

std::vector<HalfEdge> sorted_half_edges(const std::vector<Triangle>& triangles) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles.size());
  for (Index t = 0; t < count(triangles); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[uz(t)][(k + 1) % 3], b = triangles[uz(t)][(k + 2) % 3];
      edges.push_back(
          {.key = ordered_edge(a, b), .triangle = t, .local = static_cast<std::uint8_t>(k), .forward = a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    if (a.key != b.key) return a.key < b.key;
    return a.triangle < b.triangle;
  });
  return edges;
}

[[noreturn]] void refuse_edge(const HalfEdge& edge, std::size_t triangles, const VertexName& name) {
  const std::string where = fmt::format("the edge from {} to {}", name(edge.key[0]), name(edge.key[1]));
  if (triangles == 1) throw Error(fmt::format("the boundary is open along {}: one triangle ends there.", where));
  if (triangles == 2)
    throw Error(fmt::format("the boundary is not oriented at {}: its two triangles run along it in the same direction.",
                            where));
  throw Error(fmt::format("the boundary is pinched along {}: {} triangles meet there instead of 2.", where, triangles));
}

void check_fans(const std::vector<Triangle>& triangles, const std::vector<std::array<Index, 3>>& neighbors,
                Index vertices, const VertexName& name) {
  UnionFind corners_of = triangle_fans(triangles, neighbors);
  std::vector<Index> fans(uz(vertices), 0);
  for (Index t = 0; t < count(triangles); ++t)
    for (Index k = 0; k < 3; ++k)
      if (corners_of.find(3 * t + k) == 3 * t + k) ++fans[uz(triangles[uz(t)][uz(k)])];
  const auto bad = std::find_if(fans.begin(), fans.end(), [](Index n) { return n > 1; });
  if (bad == fans.end()) return;
  throw Error(fmt::format("the boundary is pinched at {}: its triangles form {} fans instead of 1.",
                          name(static_cast<Index>(bad - fans.begin())), *bad));
}

}  // namespace

Boundary find_boundary(const TetMesh& mesh, const VertexName& name) {
  constexpr std::array<Index, 4> kNone = {kInvalid, kInvalid, kInvalid, kInvalid};
  Boundary boundary;
  boundary.tet_neighbors.assign(mesh.tets.size(), kNone);
  boundary.tet_triangles.assign(mesh.tets.size(), kNone);
  const std::vector<Facet> facets = sorted_facets(mesh);
  for (std::size_t begin = 0, end = 0; begin < facets.size(); begin = end) {
    while (end < facets.size() && facets[end].key == facets[begin].key) ++end;
    const Facet &a = facets[begin], &b = facets[end - 1];
    if (end - begin > 2)
      throw Error(fmt::format("{} tets, among them tets {} and {}, share one facet ({}).", end - begin, a.tet, b.tet,
                              corners(a.key, name)));
    if (end - begin == 1) continue;
    if (a.even == b.even)
      throw Error(fmt::format("tets {} and {} overlap: both lie on the same side of the facet they share ({}).", a.tet,
                              b.tet, corners(a.key, name)));
    boundary.tet_neighbors[uz(a.tet)][a.local] = b.tet;
    boundary.tet_neighbors[uz(b.tet)][b.local] = a.tet;
  }
  for (Index t = 0; t < count(mesh.tets); ++t)
    for (std::size_t k = 0; k < 4; ++k) {
      if (boundary.tet_neighbors[uz(t)][k] != kInvalid) continue;
      const Tetrahedron& v = mesh.tets[uz(t)];
      boundary.tet_triangles[uz(t)][k] = count(boundary.triangles);
      boundary.triangles.push_back({v[kTetFacets[k][0]], v[kTetFacets[k][1]], v[kTetFacets[k][2]]});
      boundary.triangle_tets.push_back(t);
    }
  return boundary;
}

std::vector<std::array<Index, 3>> pair_triangles(const std::vector<Triangle>& triangles, const VertexName& name) {
  std::vector<std::array<Index, 3>> neighbors(triangles.size(), {kInvalid, kInvalid, kInvalid});
  const std::vector<HalfEdge> edges = sorted_half_edges(triangles);
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].key == edges[begin].key) ++end;
    const HalfEdge &a = edges[begin], &b = edges[end - 1];
    if (end - begin != 2 || a.forward == b.forward) refuse_edge(a, end - begin, name);
    neighbors[uz(a.triangle)][a.local] = b.triangle;
    neighbors[uz(b.triangle)][b.local] = a.triangle;
  }
  return neighbors;
}

std::vector<std::array<Index, 3>> match_triangles(const std::vector<Triangle>& triangles, Index vertices,
                                                  const VertexName& name) {
  auto neighbors = pair_triangles(triangles, name);
  check_fans(triangles, neighbors, vertices, name);
  return neighbors;
}

Triangle from_least_vertex(Triangle triangle) {
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

UnionFind triangle_fans(const std::vector<Triangle>& triangles, const std::vector<std::array<Index, 3>>& neighbors) {
  UnionFind fans(3 * count(triangles));
  const auto corner = [&](Index t, Index vertex) {
    const Triangle& v = triangles[uz(t)];
    return 3 * t + (v[0] == vertex ? 0 : (v[1] == vertex ? 1 : 2));
  };
  for (Index t = 0; t < count(triangles); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t end : {(k + 1) % 3, (k + 2) % 3}) {
        const Index vertex = triangles[uz(t)][end];
        fans.unite(corner(t, vertex), corner(neighbors[uz(t)][k], vertex));
      }
  return fans;
}

std::vector<Index> triangle_components(const std::vector<std::array<Index, 3>>& neighbors) {
  UnionFind sets(count(neighbors));
  for (Index t = 0; t < count(neighbors); ++t)
    for (const Index other : neighbors[uz(t)]) sets.unite(t, other);
  std::vector<Index> component(neighbors.size());
  for (Index t = 0; t < count(neighbors); ++t) component[uz(t)] = sets.find(t);
  return component;
}

}  // namespace matstruct
