// Adjacency of a tetrahedral mesh and its boundary surface, with proof that the boundary is a 2-manifold.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <matstruct/types.h>

#include "base/union_find.h"

namespace matstruct {

/// Names a vertex of the mesh in messages, with its coordinates in input units.
using VertexName = std::function<std::string(Index)>;

/// The facets of a tet (a, b, c, d) of positive orientation, as local vertices; facet k is opposite vertex k and
/// counter-clockwise seen from outside the tet.
inline constexpr std::array<std::array<std::size_t, 3>, 4> kTetFacets = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// Tets across facets and the facets that have none. Same shapes as in Domain; `triangles` index the mesh's vertices.
struct Boundary {
  std::vector<std::array<Index, 4>> tet_neighbors;
  std::vector<std::array<Index, 4>> tet_triangles;
  std::vector<Triangle> triangles;  ///< outward, ordered by tet and facet
  std::vector<Index> triangle_tets;
};

/// Matches facets by sorting, O(n log n). Throws Error if more than two tets share a facet, or two that lie on the same
/// side of it.
Boundary find_boundary(const TetMesh& mesh, const VertexName& name);

/// Neighbours of oriented triangles across the edges opposite their local vertices. Throws Error unless each edge has
/// exactly two triangles, which run along it in opposite directions.
std::vector<std::array<Index, 3>> pair_triangles(const std::vector<Triangle>& triangles, const VertexName& name);

/// The same, which throws Error also unless the triangles at each vertex form one fan.
std::vector<std::array<Index, 3>> match_triangles(const std::vector<Triangle>& triangles, Index vertices,
                                                  const VertexName& name);

/// The triangle with its least vertex first, of the same orientation.
Triangle from_least_vertex(Triangle triangle);

/// Fans of paired triangles around vertices, as sets of corners: 3 t + k for local vertex k of triangle t.
UnionFind triangle_fans(const std::vector<Triangle>& triangles, const std::vector<std::array<Index, 3>>& neighbors);

/// For each triangle the least triangle it is connected with through neighbours.
std::vector<Index> triangle_components(const std::vector<std::array<Index, 3>>& neighbors);

}  // namespace matstruct
