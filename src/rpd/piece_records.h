// From a clipped piece to its records: which names it holds, and its shares of Euler characteristics.
#pragma once

#include <vector>

#include "prepare/domain.h"
#include "rpd/rpd.h"

namespace matstruct {

/// A simplex of the mesh belongs to the least tet around it, which alone counts the names on it. Vertices are taken as
/// points (Domain::points), so that the solid's edges and vertices are counted once where it touches itself.
struct TetOwnership {
  std::array<bool, 4> facets{};        ///< facet opposite local vertex k
  std::array<bool, 4> vertices{};      ///< local vertex k
  std::array<bool, 6> edges{};         ///< local edge in the order of kTetEdges
  std::array<Index, 6> sharp_edges{};  ///< sharp edge on an owned local edge, else kInvalid
};

inline constexpr std::array<std::array<int, 2>, 6> kTetEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

std::vector<TetOwnership> tet_ownership(const Domain& domain);

/// Records of some tets, in the order in which pieces were added.
struct PieceRecords {
  std::vector<RpdCell> cells;
  std::vector<RpdFacet> facets;
  std::vector<RpdEdge> edges;
  std::vector<RpdVertex> vertices;
  std::vector<RpdStretch> stretches;
  std::vector<RpdCrossing> crossings;
  std::vector<Index> facet_of_plane;  ///< workspace of append_piece()
};

/// Appends the records of the piece that `clipper` holds; returns its share of the whole complex's Euler
/// characteristic.
std::int32_t append_piece(Clipper& clipper, const Domain& domain, const TetOwnership& own, Index tet, Index sphere,
                          PieceRecords& out);

}  // namespace matstruct
