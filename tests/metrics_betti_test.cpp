// Betti numbers: surfaces and solids of known topology, and random complexes against ranks of dense matrices.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <matstruct/error.h>
#include <matstruct/metrics.h>

#include "base/index.h"
#include "base/random.h"

namespace matstruct {
namespace {

/// The complex of all faces of the given simplices.
template <std::size_t N>
void add_faces(const std::array<Index, N>& simplex, std::set<Edge>& edges, std::set<Triangle>& triangles,
               std::set<Tetrahedron>& tets) {
  auto s = simplex;
  std::sort(s.begin(), s.end());
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = i + 1; j < N; ++j) {
      edges.insert({s[i], s[j]});
      for (std::size_t k = j + 1; k < N; ++k) triangles.insert({s[i], s[j], s[k]});
    }
  }
  if constexpr (N == 4) tets.insert(s);
}

template <std::size_t N>
SimplicialComplex closure(Index vertices, const std::vector<std::array<Index, N>>& simplices) {
  std::set<Edge> edges;
  std::set<Triangle> triangles;
  std::set<Tetrahedron> tets;
  for (const auto& s : simplices) add_faces(s, edges, triangles, tets);
  return {vertices, {edges.begin(), edges.end()}, {triangles.begin(), triangles.end()}, {tets.begin(), tets.end()}};
}

/// An m x n grid of squares, each cut in two, closed up in both directions; the second closing may reverse the first
/// direction, which makes a Klein bottle of the torus.
SimplicialComplex closed_grid(Index m, Index n, bool reversed) {
  const auto id = [&](Index i, Index j) {
    if (j == n) i = reversed ? (m - i) % m : i;
    return (i % m) * n + j % n;
  };
  std::vector<Triangle> triangles;
  for (Index i = 0; i < m; ++i) {
    for (Index j = 0; j < n; ++j) {
      triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  return closure(m * n, triangles);
}

/// A ring of n cubes, each cut into six tetrahedra around its diagonal (Kuhn), without its surface given.
TetMesh solid_torus(Index n) {
  TetMesh mesh;
  mesh.vertices.resize(uz(4 * n));
  const auto id = [&](Index i, Index j, Index k) { return 4 * (i % n) + 2 * j + k; };
  for (Index i = 0; i < n; ++i) {
    std::array<int, 3> order{0, 1, 2};
    do {
      std::array<Index, 3> at{i, 0, 0};
      Tetrahedron tet{id(at[0], at[1], at[2])};
      for (std::size_t step = 0; step < 3; ++step) {
        ++at[static_cast<std::size_t>(order[step])];
        tet[step + 1] = id(at[0], at[1], at[2]);
      }
      mesh.tets.push_back(tet);
    } while (std::next_permutation(order.begin(), order.end()));
  }
  return mesh;
}

const std::vector<Triangle> kProjectivePlane{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 1, 5},
                                             {1, 2, 4}, {2, 4, 5}, {2, 3, 5}, {1, 3, 5}, {1, 3, 4}};

TEST(BettiNumbers, Surfaces) {
  const std::vector<Triangle> sphere{{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  EXPECT_EQ(betti_numbers(closure(4, sphere)), (Betti{1, 0, 1}));
  EXPECT_EQ(betti_numbers(closed_grid(5, 7, false)), (Betti{1, 2, 1}));
  EXPECT_EQ(betti_numbers(closed_grid(5, 7, true)), (Betti{1, 2, 1}));  // Klein bottle, over GF(2)
  EXPECT_EQ(betti_numbers(closure(6, kProjectivePlane)), (Betti{1, 1, 1}));
}

TEST(BettiNumbers, PointsAndGraphs) {
  EXPECT_EQ(betti_numbers(SimplicialComplex{}), (Betti{0, 0, 0}));
  EXPECT_EQ(betti_numbers(SimplicialComplex{3, {}, {}, {}}), (Betti{3, 0, 0}));
  EXPECT_EQ(betti_numbers(SimplicialComplex{4, {{0, 1}, {2, 1}, {2, 0}}, {}, {}}), (Betti{2, 1, 0}));
}

TEST(BettiNumbers, Solids) {
  EXPECT_EQ(betti_numbers(solid_torus(5)), (Betti{1, 1, 0}));
  // A tetrahedron cut into four around a vertex.
  TetMesh ball{std::vector<Vec3>(5), {{0, 1, 2, 4}, {0, 1, 3, 4}, {0, 2, 3, 4}, {1, 2, 3, 4}}};
  EXPECT_EQ(betti_numbers(ball), (Betti{1, 0, 0}));
  ball.vertices.resize(7);  // points of no tetrahedron are not part of the solid
  EXPECT_EQ(betti_numbers(ball), (Betti{1, 0, 0}));
}

TEST(BettiNumbers, ShellHasACavity) {
  // Prisms over the faces of a hollow tetrahedron, each cut into three.
  std::vector<Tetrahedron> tets;
  for (const Triangle& t : std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}) {
    tets.push_back({t[0], t[1], t[2], t[2] + 4});
    tets.push_back({t[0], t[1], t[1] + 4, t[2] + 4});
    tets.push_back({t[0], t[0] + 4, t[1] + 4, t[2] + 4});
  }
  EXPECT_EQ(betti_numbers(TetMesh{std::vector<Vec3>(8), tets}), (Betti{1, 0, 1}));
}

TEST(BettiNumbers, MedialMeshOfSeveralParts) {
  MedialMesh mesh;
  mesh.centers.resize(8);
  mesh.radii.resize(8, 1);
  mesh.faces = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  mesh.edges = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}, {4, 5}, {4, 6}, {5, 6}};
  EXPECT_EQ(betti_numbers(mesh), (Betti{3, 1, 1}));  // a hollow tetrahedron, a ring and a lone sphere
}

/// Rank over GF(2) of the boundary matrix of simplices on N vertices, by dense elimination.
template <std::size_t N>
Index dense_rank(const std::vector<std::array<Index, N>>& simplices,
                 const std::vector<std::array<Index, N - 1>>& facets) {
  std::vector<std::vector<char>> rows;
  for (const auto& s : simplices) {
    std::vector<char> row(facets.size(), 0);
    for (std::size_t f = 0; f < facets.size(); ++f)
      row[f] = std::includes(s.begin(), s.end(), facets[f].begin(), facets[f].end()) ? 1 : 0;
    rows.push_back(row);
  }
  Index rank = 0;
  for (std::size_t column = 0; column < facets.size(); ++column) {
    const auto pivot = std::find_if(rows.begin() + rank, rows.end(), [&](const auto& row) { return row[column] != 0; });
    if (pivot == rows.end()) continue;
    std::swap(*pivot, rows[uz(rank)]);
    for (std::size_t r = uz(rank) + 1; r < rows.size(); ++r) {
      if (rows[r][column] == 0) continue;
      for (std::size_t k = column; k < facets.size(); ++k)
        rows[r][k] = static_cast<char>(rows[r][k] ^ rows[uz(rank)][k]);
    }
    ++rank;
  }
  return rank;
}

TEST(BettiNumbers, RandomComplexesAgreeWithDenseRanks) {
  Index with_tunnels = 0, with_cavities = 0;
  for (std::uint64_t trial = 0; trial < 150; ++trial) {
    KeyedRandom random(1, 2, trial);
    const auto vertices = static_cast<Index>(5 + random.next() % 6);
    const auto vertex = [&] { return static_cast<Index>(random.next() % static_cast<std::uint64_t>(vertices)); };
    std::set<Edge> edges;
    std::set<Triangle> triangles;
    std::set<Tetrahedron> tets;
    const std::uint64_t simplices = random.next() % 120;
    for (std::uint64_t k = 0; k < simplices; ++k) {
      const Tetrahedron t{vertex(), vertex(), vertex(), vertex()};
      if (std::set<Index>(t.begin(), t.end()).size() < 4) continue;
      if (k % 5 == 0)
        add_faces(t, edges, triangles, tets);
      else if (k % 5 < 4)
        add_faces(Triangle{t[0], t[1], t[2]}, edges, triangles, tets);
      else
        add_faces(Edge{t[0], t[1]}, edges, triangles, tets);
    }
    const SimplicialComplex complex{
        vertices, {edges.begin(), edges.end()}, {triangles.begin(), triangles.end()}, {tets.begin(), tets.end()}};
    std::vector<std::array<Index, 1>> points;
    for (Index v = 0; v < vertices; ++v) points.push_back({v});
    const Index rank1 = dense_rank(complex.edges, points);
    const Index rank2 = dense_rank(complex.triangles, complex.edges);
    const Index rank3 = dense_rank(complex.tets, complex.triangles);
    const Betti expected{vertices - rank1, count(complex.edges) - rank1 - rank2,
                         count(complex.triangles) - rank2 - rank3};
    EXPECT_EQ(betti_numbers(complex), expected);
    with_tunnels += expected.b1 > 0 ? 1 : 0;
    with_cavities += expected.b2 > 0 ? 1 : 0;
  }
  EXPECT_GT(with_tunnels, 20);
  EXPECT_GT(with_cavities, 20);
}

TEST(BettiNumbers, DoNotDependOnTheOrderOfInput) {
  SimplicialComplex torus = closed_grid(6, 8, false);
  std::reverse(torus.edges.begin(), torus.edges.end());
  std::rotate(torus.triangles.begin(), torus.triangles.begin() + 11, torus.triangles.end());
  for (Triangle& t : torus.triangles) std::swap(t[0], t[2]);
  EXPECT_EQ(betti_numbers(torus), (Betti{1, 2, 1}));
}

TEST(BettiNumbers, RefuseWhatIsNoComplex) {
  const SimplicialComplex no_edge{3, {{0, 1}, {1, 2}}, {{0, 1, 2}}, {}};
  const SimplicialComplex no_triangle{4, closure(4, std::vector<Tetrahedron>{{0, 1, 2, 3}}).edges, {}, {{0, 1, 2, 3}}};
  const SimplicialComplex out_of_range{2, {{0, 2}}, {}, {}};
  const SimplicialComplex negative{2, {{-1, 1}}, {}, {}};
  const SimplicialComplex twice{2, {{0, 1}, {1, 0}}, {}, {}};
  const SimplicialComplex loop{2, {{1, 1}}, {}, {}};
  for (const auto& complex : {no_edge, no_triangle, out_of_range, negative, twice, loop})
    EXPECT_THROW(betti_numbers(complex), Error);
}

/// The same complex with its vertices numbered at random.
SimplicialComplex shuffled(SimplicialComplex complex) {
  std::vector<std::pair<std::uint64_t, Index>> order;
  for (Index v = 0; v < complex.vertices; ++v)
    order.emplace_back(KeyedRandom(3, 4, static_cast<std::uint64_t>(v)).next(), v);
  std::sort(order.begin(), order.end());
  const auto rename = [&](auto& simplices) {
    for (auto& simplex : simplices)
      for (Index& v : simplex) v = order[uz(v)].second;
  };
  rename(complex.edges);
  rename(complex.triangles);
  rename(complex.tets);
  return complex;
}

TEST(BettiNumbers, LargeComplexes) {
  const SimplicialComplex torus = closed_grid(150, 120, false);  // 108 000 simplices
  EXPECT_EQ(betti_numbers(torus), (Betti{1, 2, 1}));
  EXPECT_EQ(betti_numbers(shuffled(torus)), (Betti{1, 2, 1}));
  EXPECT_EQ(betti_numbers(solid_torus(4000)), (Betti{1, 1, 0}));  // 108 000 simplices
  const SimplicialComplex ring = closure(16000, solid_torus(4000).tets);
  EXPECT_EQ(betti_numbers(shuffled(ring)), (Betti{1, 1, 0}));
}

}  // namespace
}  // namespace matstruct
