// Two steps in turn, until nothing is left to do:
// (a) The tets at a vertex that are connected through facets at the vertex form a fan. Each fan after the first gets a
//     copy of the vertex. Facet adjacency survives: two tets that share a facet are in one fan at each of its vertices.
// (b) An edge whose ends are still common to several fans of its own is split at a new vertex in its middle. There the
//     fans have nothing in common but that vertex, so (a) separates them.
// Copies lie on the originals: the solid as a set of points stays the same, only its combinatorial closure changes.
#include "prepare/pinches.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/index.h"
#include "base/union_find.h"
#include "geometry/exact.h"

namespace matstruct {

namespace {

using Neighbors = std::vector<std::array<Index, 4>>;

constexpr std::array<std::array<std::size_t, 2>, 6> kTetEdges = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

Edge edge_of(const Tetrahedron& tet, std::size_t local) {
  return ordered_edge(tet[kTetEdges[local][0]], tet[kTetEdges[local][1]]);
}

Index local_vertex(const Tetrahedron& tet, Index vertex) {
  return static_cast<Index>(std::find(tet.begin(), tet.end(), vertex) - tet.begin());
}

Index local_edge(const Tetrahedron& tet, const Edge& edge) {
  Index local = 0;
  while (edge_of(tet, uz(local)) != edge) ++local;
  return local;
}

// Calls visit(tet, other, k) once for each facet between two tets; it is opposite local vertex k of `tet`.
template <class Visit>
void for_each_inner_facet(const Neighbors& neighbors, Visit visit) {
  for (Index t = 0; t < count(neighbors); ++t)
    for (std::size_t k = 0; k < 4; ++k)
      if (neighbors[uz(t)][k] > t) visit(t, neighbors[uz(t)][k], k);
}

// Sets of tet corners, 4 t + k for local vertex k of tet t.
UnionFind vertex_fans(const std::vector<Tetrahedron>& tets, const Neighbors& neighbors) {
  UnionFind fans(4 * count(tets));
  for_each_inner_facet(neighbors, [&](Index t, Index other, std::size_t k) {
    for (std::size_t j = 0; j < 4; ++j)
      if (j != k) fans.unite(4 * t + static_cast<Index>(j), 4 * other + local_vertex(tets[uz(other)], tets[uz(t)][j]));
  });
  return fans;
}

// Sets of tet edges, 6 t + e for local edge e of tet t.
UnionFind edge_fans(const std::vector<Tetrahedron>& tets, const Neighbors& neighbors) {
  UnionFind fans(6 * count(tets));
  for_each_inner_facet(neighbors, [&](Index t, Index other, std::size_t k) {
    for (std::size_t e = 0; e < 6; ++e)
      if (kTetEdges[e][0] != k && kTetEdges[e][1] != k)
        fans.unite(6 * t + static_cast<Index>(e), 6 * other + local_edge(tets[uz(other)], edge_of(tets[uz(t)], e)));
  });
  return fans;
}

// Step (a).
void separate_vertices(CleanSolid& clean, const Neighbors& neighbors, PinchCut& cut) {
  TetMesh& mesh = clean.mesh;
  UnionFind fans = vertex_fans(mesh.tets, neighbors);
  std::vector<char> taken(mesh.vertices.size(), 0);
  std::vector<Index> vertex_of(4 * mesh.tets.size(), kInvalid);
  for (Index corner = 0; corner < count(vertex_of); ++corner) {  // the name of a fan is its least corner
    Index& vertex = mesh.tets[uz(corner / 4)][uz(corner % 4)];
    if (fans.find(corner) == corner) {
      vertex_of[uz(corner)] = taken[uz(vertex)] ? count(mesh.vertices) : vertex;
      if (taken[uz(vertex)]) {
        if (cut.copies++ == 0) cut.example = vertex;
        mesh.vertices.push_back(Vec3(mesh.vertices[uz(vertex)]));
        clean.input_vertex.push_back(Index(clean.input_vertex[uz(vertex)]));
      } else {
        taken[uz(vertex)] = 1;
      }
    }
    vertex = vertex_of[uz(fans.find(corner))];
  }
}

// Edges with more than one fan, ascending.
std::vector<Edge> pinched_edges(const std::vector<Tetrahedron>& tets, const Neighbors& neighbors) {
  UnionFind fans = edge_fans(tets, neighbors);
  std::vector<Edge> edges;
  for (Index i = 0; i < 6 * count(tets); ++i)
    if (fans.find(i) == i) edges.push_back(edge_of(tets[uz(i / 6)], uz(i % 6)));
  std::sort(edges.begin(), edges.end());
  std::vector<Edge> pinched;
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i] == edges[i - 1] && (pinched.empty() || pinched.back() != edges[i])) pinched.push_back(edges[i]);
  return pinched;
}

std::vector<std::vector<Index>> tets_around(const std::vector<Tetrahedron>& tets, const std::vector<Edge>& edges) {
  std::vector<std::vector<Index>> around(edges.size());
  for (Index t = 0; t < count(tets); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const Edge edge = edge_of(tets[uz(t)], e);
      const auto place = std::lower_bound(edges.begin(), edges.end(), edge);
      if (place != edges.end() && *place == edge) around[static_cast<std::size_t>(place - edges.begin())].push_back(t);
    }
  return around;
}

Tetrahedron replaced(Tetrahedron tet, Index old, Index now) {
  std::replace(tet.begin(), tet.end(), old, now);
  return tet;
}

// A point of the edge such that both halves of all its tets are positive in spite of its rounding, the middle if
// possible.
std::optional<Vec3> splitting_point(const TetMesh& mesh, const Edge& edge, const std::vector<Index>& tets) {
  const auto positive = [&](const Tetrahedron& tet, Index moved, const Vec3& to) {
    const auto p = [&](std::size_t k) { return tet[k] == moved ? to : mesh.vertices[uz(tet[k])]; };
    return orientation(p(0), p(1), p(2), p(3)) > 0;
  };
  constexpr int kFinest = 64;
  for (int parts = 2; parts <= kFinest; parts *= 2)
    for (int i = 1; i < parts; i += 2) {
      const Vec3 point = lerp(mesh.vertices[uz(edge[0])], mesh.vertices[uz(edge[1])], static_cast<double>(i) / parts);
      if (std::all_of(tets.begin(), tets.end(), [&](Index t) {
            return positive(mesh.tets[uz(t)], edge[0], point) && positive(mesh.tets[uz(t)], edge[1], point);
          }))
        return point;
    }
  return std::nullopt;
}

// Step (b) for those edges that share no tet with an earlier one. Returns the number of edges split.
Index split_edges(CleanSolid& clean, const std::vector<Edge>& edges) {
  TetMesh& mesh = clean.mesh;
  const auto around = tets_around(mesh.tets, edges);
  std::vector<char> touched(mesh.tets.size(), 0);
  Index split = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (std::any_of(around[i].begin(), around[i].end(), [&](Index t) { return touched[uz(t)]; })) continue;
    const auto point = splitting_point(mesh, edges[i], around[i]);
    if (!point) continue;
    const Index middle = count(mesh.vertices);
    mesh.vertices.push_back(*point);
    clean.input_vertex.push_back(kInvalid);
    for (const Index t : around[i]) {
      touched[uz(t)] = 1;
      mesh.tets.push_back(replaced(mesh.tets[uz(t)], edges[i][0], middle));
      mesh.tets[uz(t)] = replaced(mesh.tets[uz(t)], edges[i][1], middle);
    }
    ++split;
  }
  return split;
}

}  // namespace

PinchCut cut_pinches(CleanSolid& clean, Boundary& boundary, const VertexName& name) {
  PinchCut cut;
  while (true) {
    separate_vertices(clean, boundary.tet_neighbors, cut);
    const std::vector<Edge> pinched = pinched_edges(clean.mesh.tets, boundary.tet_neighbors);
    const Index split = split_edges(clean, pinched);
    if (split == 0) break;  // nothing left, or edges too short for a point in between
    cut.middles += split;
    boundary = find_boundary(clean.mesh, name);
  }
  if (cut.copies > 0) boundary = find_boundary(clean.mesh, name);
  return cut;
}

}  // namespace matstruct
