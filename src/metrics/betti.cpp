// Betti numbers over GF(2) by column reduction of the boundary matrices (Edelsbrunner, Letscher & Zomorodian 2002) from
// the highest dimension down, leaving out columns that are known to vanish (Chen & Kerber 2011, "Persistent homology
// computation with a twist"): a simplex that is the pivot of a reduced column one dimension up is itself a cycle.
//
// Notation: d_k the matrix of the boundary map from k-simplices to (k-1)-simplices, rank_k its rank, n_k the number of
// k-simplices. b_k = n_k - rank_k - rank_(k+1).
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <matstruct/error.h>
#include <matstruct/metrics.h>

#include "base/index.h"
#include "base/union_find.h"

namespace matstruct {

namespace {

template <std::size_t N>
using Simplices = std::vector<std::array<Index, N>>;

/// Marks the rows that are pivots of reduced columns; their number is the rank.
struct Pivots {
  std::vector<char> is_pivot;
  Index rank = 0;
};

/// Vertices of each simplex ascending, simplices in lexicographic order.
template <std::size_t N>
Simplices<N> canonical(Simplices<N> simplices, Index vertices) {
  for (auto& simplex : simplices) {
    std::sort(simplex.begin(), simplex.end());
    if (simplex.front() < 0 || simplex.back() >= vertices)
      throw Error(fmt::format("simplex ({}) of a complex with {} vertices has a vertex out of range.",
                              fmt::join(simplex, ", "), vertices));
    if (std::adjacent_find(simplex.begin(), simplex.end()) != simplex.end())
      throw Error(fmt::format("simplex ({}) has the same vertex twice.", fmt::join(simplex, ", ")));
  }
  std::sort(simplices.begin(), simplices.end());
  const auto twin = std::adjacent_find(simplices.begin(), simplices.end());
  if (twin != simplices.end())
    throw Error(fmt::format("simplex ({}) is in the complex twice.", fmt::join(*twin, ", ")));
  return simplices;
}

/// Column of each simplex in its boundary matrix: the ids of its facets, ascending.
template <std::size_t N>
Simplices<N> boundary_matrix(const Simplices<N>& simplices, const Simplices<N - 1>& facets) {
  Simplices<N> columns(simplices.size());
  for (std::size_t s = 0; s < simplices.size(); ++s) {
    for (std::size_t omitted = 0; omitted < N; ++omitted) {
      std::array<Index, N - 1> facet;
      std::copy_n(simplices[s].begin(), omitted, facet.begin());
      std::copy(simplices[s].begin() + omitted + 1, simplices[s].end(), facet.begin() + omitted);
      const auto found = std::lower_bound(facets.begin(), facets.end(), facet);
      if (found == facets.end() || *found != facet)
        throw Error(fmt::format("face ({}) of simplex ({}) is not in the complex.", fmt::join(facet, ", "),
                                fmt::join(simplices[s], ", ")));
      // Leaving out a later vertex gives an earlier facet.
      columns[s][N - 1 - omitted] = static_cast<Index>(found - facets.begin());
    }
  }
  return columns;
}

/// Reduces the columns that are not known to vanish, left to right.
template <std::size_t N>
Pivots reduce(const Simplices<N>& columns, Index rows, const std::vector<char>& vanishes) {
  Pivots pivots{std::vector<char>(uz(rows), 0)};
  std::vector<std::vector<Index>> by_pivot(uz(rows));  // reduced column of each pivot row, ascending
  std::vector<Index> column, sum;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (vanishes[j]) continue;
    column.assign(columns[j].begin(), columns[j].end());
    while (!column.empty() && pivots.is_pivot[uz(column.back())]) {
      const std::vector<Index>& other = by_pivot[uz(column.back())];
      sum.clear();
      std::set_symmetric_difference(column.begin(), column.end(), other.begin(), other.end(), std::back_inserter(sum));
      column.swap(sum);
    }
    if (column.empty()) continue;
    pivots.is_pivot[uz(column.back())] = 1;
    ++pivots.rank;
    by_pivot[uz(column.back())] = column;
  }
  return pivots;
}

}  // namespace

Betti betti_numbers(const SimplicialComplex& complex) {
  const auto edges = canonical(complex.edges, complex.vertices);
  const auto triangles = canonical(complex.triangles, complex.vertices);
  const auto tets = canonical(complex.tets, complex.vertices);

  const std::vector<char> none(tets.size(), 0);
  const Pivots d3 = reduce(boundary_matrix(tets, triangles), count(triangles), none);
  const Pivots d2 = reduce(boundary_matrix(triangles, edges), count(edges), d3.is_pivot);
  // The rank of d_1 is that of a graph: the size of a spanning forest.
  UnionFind components(complex.vertices);
  Index rank1 = 0;
  for (const Edge& e : edges) rank1 += components.unite(e[0], e[1]) ? 1 : 0;

  return {complex.vertices - rank1, count(edges) - rank1 - d2.rank, count(triangles) - d2.rank - d3.rank};
}

Betti betti_numbers(const MedialMesh& mesh) {
  return betti_numbers(SimplicialComplex{count(mesh.centers), mesh.edges, mesh.faces, {}});
}

namespace {

/// The distinct facets of simplices whose vertices are ascending.
template <std::size_t N>
Simplices<N - 1> facets_of(const Simplices<N>& simplices) {
  Simplices<N - 1> facets;
  facets.reserve(N * simplices.size());
  for (const auto& simplex : simplices) {
    for (std::size_t omitted = 0; omitted < N; ++omitted) {
      auto& facet = facets.emplace_back();
      std::copy_n(simplex.begin(), omitted, facet.begin());
      std::copy(simplex.begin() + omitted + 1, simplex.end(), facet.begin() + omitted);
    }
  }
  std::sort(facets.begin(), facets.end());
  facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
  return facets;
}

/// Points of the array that are no part of the solid.
Index unused_vertices(const SimplicialComplex& complex) {
  std::vector<char> used(uz(complex.vertices), 0);
  for (const Edge& e : complex.edges)
    for (const Index v : e) used[uz(v)] = 1;
  return complex.vertices - static_cast<Index>(std::count(used.begin(), used.end(), 1));
}

}  // namespace

Betti betti_numbers(const TetMesh& solid) {
  SimplicialComplex complex;
  complex.vertices = count(solid.vertices);
  complex.tets = canonical(solid.tets, complex.vertices);
  complex.triangles = facets_of(complex.tets);
  complex.edges = facets_of(complex.triangles);
  Betti betti = betti_numbers(complex);
  betti.b0 -= unused_vertices(complex);
  return betti;
}

}  // namespace matstruct
