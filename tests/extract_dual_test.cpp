// From a diagram to the medial mesh: the dual complex, the removal of guards, thinning. All but the first keep the
// homotopy type, and Betti numbers must say so.

#include "extract/dual.h"

#include <gtest/gtest.h>

#include <matstruct/metrics.h>

#include <map>

#include "base/index.h"
#include "base/random.h"
#include "dual_betti.h"
#include "extract/guards.h"
#include "preserved.h"
#include "shapes.h"
#include "thinned.h"

namespace matstruct {
namespace {

constexpr double kGamma = 10;

Options coarse() {
  return {.gamma = kGamma, .threads = 2};
}

template <class Simplex>
bool sorted_unique(const std::vector<Simplex>& simplices) {
  return std::adjacent_find(simplices.begin(), simplices.end(), std::greater_equal<>()) == simplices.end();
}

bool holds(const std::vector<Index>& vertices, Index v) {
  return std::binary_search(vertices.begin(), vertices.end(), v);
}

void expect_closed(const DualComplex& dual) {
  EXPECT_TRUE(sorted_unique(dual.vertices));
  EXPECT_TRUE(sorted_unique(dual.edges));
  EXPECT_TRUE(sorted_unique(dual.triangles));
  EXPECT_TRUE(sorted_unique(dual.tets));
  ASSERT_EQ(dual.lengths.size(), dual.triangles.size());
  const auto has_edge = [&](Index i, Index j) {
    return std::binary_search(dual.edges.begin(), dual.edges.end(), Edge{i, j});
  };
  const auto has_triangle = [&](Index i, Index j, Index k) {
    return std::binary_search(dual.triangles.begin(), dual.triangles.end(), Triangle{i, j, k});
  };
  for (const auto& [i, j] : dual.edges) EXPECT_TRUE(i < j && holds(dual.vertices, i) && holds(dual.vertices, j));
  for (const auto& [i, j, k] : dual.triangles) EXPECT_TRUE(j < k && has_edge(i, j) && has_edge(i, k) && has_edge(j, k));
  for (const auto& [i, j, k, l] : dual.tets)
    EXPECT_TRUE(has_triangle(i, j, k) && has_triangle(i, j, l) && has_triangle(i, k, l) && has_triangle(j, k, l));
  for (const double length : dual.lengths) EXPECT_GE(length, 0);
}

std::vector<WeightedPoint> random_spheres(Index n, std::uint64_t seed) {
  std::vector<WeightedPoint> spheres;
  for (Index k = 0; k < n; ++k) {
    KeyedRandom random(seed, 0, static_cast<std::uint64_t>(k));
    const auto number = [&] { return random.uniform() - 0.5; };
    spheres.push_back({{number(), number(), number()}, 0.01 * random.uniform()});
  }
  return spheres;
}

TEST(DualComplex, IsClosedUnderTakingFaces) {
  for (const auto& shape : shapes::all())
    for (const Index n : {1, 5, 60}) {
      SCOPED_TRACE(shape.name + " with " + std::to_string(n) + " spheres");
      Context context;
      const Domain domain = prepare_domain(shape.mesh, {}, context);
      RpdEngine engine(domain);
      engine.compute(random_spheres(n, 4), context);
      expect_closed(dual_complex(engine.diagram()));
    }
}

TEST(DualComplex, OfFourSpheresInACube) {
  Context context;
  const Domain domain = prepare_domain(shapes::box({1, 1, 1}), {}, context);
  const auto at = [&](const Vec3& p) { return WeightedPoint{domain.frame.to_internal(p), 0}; };
  RpdEngine engine(domain);
  engine.compute({at({0.2, 0.2, 0.2}), at({0.8, 0.8, 0.2}), at({0.2, 0.8, 0.8}), at({0.8, 0.2, 0.8})}, context);
  const DualComplex dual = dual_complex(engine.diagram());
  EXPECT_EQ(dual.vertices, (std::vector<Index>{0, 1, 2, 3}));
  EXPECT_EQ(dual.edges.size(), 6u);
  EXPECT_EQ(dual.tets, (std::vector<Tetrahedron>{{0, 1, 2, 3}}));
  // The four segments of equal distance to three spheres run from the cube's centre to four of its corners.
  ASSERT_EQ(dual.lengths.size(), 4u);
  for (const double length : dual.lengths) EXPECT_NEAR(length, domain.diagonal / 2, 1e-12);
}

// ---- guards ---------------------------------------------------------------------------------------------------------

Spheres spheres_with_guards(const std::vector<bool>& guard) {
  Spheres spheres;
  for (const bool g : guard) {
    SphereSeed seed;
    seed.guard = g;
    spheres.add(seed);
  }
  return spheres;
}

TEST(RemoveGuards, CollapsesAGuardAtAFreeCorner) {
  // Two triangles; the guard 3 hangs on the edge 1 2.
  const DualComplex dual{{0, 1, 2, 3}, {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}}, {{0, 1, 2}, {1, 2, 3}}, {5, 6}, {}};
  const GuardRemoval removal = remove_guards(dual, spheres_with_guards({false, false, false, true}));
  EXPECT_TRUE(removal.forced.empty());
  EXPECT_EQ(removal.dual.vertices, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(removal.dual.edges, (std::vector<Edge>{{0, 1}, {0, 2}, {1, 2}}));
  EXPECT_EQ(removal.dual.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(removal.dual.lengths, (std::vector<double>{5}));
}

TEST(RemoveGuards, KeepsAGuardThatHoldsAComplexTogether) {
  const DualComplex path{{0, 1, 2}, {{0, 1}, {1, 2}}, {}, {}, {}};
  const GuardRemoval removal = remove_guards(path, spheres_with_guards({false, true, false}));
  EXPECT_EQ(removal.forced, (std::vector<Index>{1}));
  EXPECT_TRUE(removal.meeting.empty());
  EXPECT_EQ(removal.dual.vertices, path.vertices);
  EXPECT_EQ(removal.dual.edges, path.edges);
}

TEST(RemoveGuards, KeepsAGuardThatClosesAPocket) {
  // The hollow tetrahedron: the link of 0 is a circle.
  const DualComplex hollow{{0, 1, 2, 3},
                           {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}},
                           {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}},
                           {1, 1, 1, 1},
                           {}};
  const GuardRemoval kept = remove_guards(hollow, spheres_with_guards({true, false, false, false}));
  EXPECT_EQ(kept.forced, (std::vector<Index>{0}));
  EXPECT_EQ(betti_of(kept.dual), (Betti{1, 0, 1}));
  DualComplex full = hollow;
  full.tets = {{0, 1, 2, 3}};
  const GuardRemoval removal = remove_guards(full, spheres_with_guards({true, false, false, false}));
  EXPECT_TRUE(removal.forced.empty());
  EXPECT_EQ(betti_of(removal.dual), (Betti{1, 0, 0}));
}

TEST(RemoveGuards, TakesAGuardWhenItsNeighbourIsGone) {
  // 0 - 1 - 2 with guards 1 and 2: 1 resists until 2 is gone.
  const DualComplex path{{0, 1, 2}, {{0, 1}, {1, 2}}, {}, {}, {}};
  const GuardRemoval removal = remove_guards(path, spheres_with_guards({false, true, true}));
  EXPECT_TRUE(removal.forced.empty());
  EXPECT_EQ(removal.dual.vertices, (std::vector<Index>{0}));
}

TEST(RemoveGuards, NamesGuardsThatMeetAcrossAWall) {
  // A cycle of two guards of different lines and two medial spheres.
  const DualComplex cycle{{0, 1, 2, 3}, {{0, 1}, {0, 3}, {1, 2}, {2, 3}}, {}, {}, {}};
  Spheres spheres = spheres_with_guards({false, true, true, false});
  spheres.seeds[1].line = 0;
  spheres.seeds[2].line = 1;
  const GuardRemoval removal = remove_guards(cycle, spheres);
  EXPECT_EQ(removal.forced, (std::vector<Index>{1, 2}));
  EXPECT_EQ(removal.meeting, (std::vector<Edge>{{1, 2}}));
}

TEST(RemoveGuards, KeepsTheTopologyOfSolidsWithConcaveLines) {
  for (const auto& [mesh, topology] :
       {std::pair{shapes::l_profile(), Betti{1, 0, 0}}, {shapes::plate_with_hole(), Betti{1, 1, 0}}}) {
    const Preserved p = preserved(mesh, coarse());
    const DualComplex guarded = dual_complex(p.rpd);
    const auto is_guard = [&](Index s) { return p.spheres.seeds[uz(s)].guard; };
    ASSERT_TRUE(std::any_of(guarded.vertices.begin(), guarded.vertices.end(), is_guard));
    EXPECT_EQ(betti_of(guarded), topology);

    const GuardRemoval removal = remove_guards(guarded, p.spheres);
    EXPECT_TRUE(removal.forced.empty());
    EXPECT_TRUE(removal.meeting.empty());
    EXPECT_TRUE(std::none_of(removal.dual.vertices.begin(), removal.dual.vertices.end(), is_guard));
    expect_closed(removal.dual);
    EXPECT_EQ(betti_of(removal.dual), topology);
  }
}

// ---- thinning -------------------------------------------------------------------------------------------------------

std::vector<double> importance_of(const Spheres& spheres, const DualComplex& dual) {
  std::vector<double> importance;
  for (std::size_t f = 0; f < dual.triangles.size(); ++f) {
    double sum = 0;
    int n = 0;
    for (const Index s : dual.triangles[f])
      if (const SphereSeed& seed = spheres.seeds[uz(s)]; seed.radius > 0) sum += seed.radius, ++n;
    importance.push_back(n == 0 ? 0 : dual.lengths[f] / (2 * sum / n));
  }
  return importance;
}

// A face of little importance remains only where each of its edges has another face or is a feature.
void expect_nothing_left_to_thin(const Preserved& p, const DualComplex& dual, const MedialMesh& mesh,
                                 double threshold) {
  const std::vector<double> importance = importance_of(p.spheres, dual);
  std::map<Edge, int> faces_at;
  for (const auto& [i, j, k] : mesh.faces)
    for (const Edge& e : {Edge{i, j}, Edge{i, k}, Edge{j, k}}) ++faces_at[e];
  const auto sphere = [&](Index v) { return dual.vertices[uz(v)]; };
  for (const auto& [i, j, k] : mesh.faces) {
    const Triangle in_dual{sphere(i), sphere(j), sphere(k)};
    const auto found = std::lower_bound(dual.triangles.begin(), dual.triangles.end(), in_dual);
    ASSERT_TRUE(found != dual.triangles.end() && *found == in_dual);
    if (importance[static_cast<std::size_t>(found - dual.triangles.begin())] >= threshold) continue;
    for (const Edge& e : {Edge{i, j}, Edge{i, k}, Edge{j, k}}) {
      const Edge spheres{sphere(e[0]), sphere(e[1])};
      const auto& features = p.result.lines.feature_edges;
      EXPECT_TRUE(faces_at[e] > 1 || std::binary_search(features.begin(), features.end(), spheres));
    }
  }
}

void expect_features_survive(const Preserved& p, const DualComplex& dual, const MedialMesh& mesh) {
  for (const Edge& e : p.result.lines.feature_edges) {
    const auto vertex = [&](Index s) {
      return static_cast<Index>(std::lower_bound(dual.vertices.begin(), dual.vertices.end(), s) -
                                dual.vertices.begin());
    };
    EXPECT_TRUE(std::binary_search(mesh.edges.begin(), mesh.edges.end(), Edge{vertex(e[0]), vertex(e[1])}));
  }
}

void expect_thins(const shapes::Shape& shape) {
  SCOPED_TRACE(shape.name);
  const Preserved p = preserved(shape.mesh, coarse());
  ASSERT_EQ(p.result.violations_left, 0);
  EXPECT_EQ(betti_of(dual_complex(p.rpd)), shape.topology);
  const DualComplex dual = remove_guards(dual_complex(p.rpd), p.spheres).dual;
  EXPECT_EQ(betti_of(dual), shape.topology);

  std::size_t faces_before = dual.triangles.size();
  for (const double threshold : {0.0, 0.3, 1.0}) {
    SCOPED_TRACE(threshold);
    const MedialMesh mesh = thinned_by_importance(p, coarse(), dual, threshold);
    EXPECT_EQ(betti_numbers(mesh), shape.topology);
    const Thinness thin_mesh = thinness(mesh);
    EXPECT_EQ(thin_mesh.tetrahedra, 0);
    EXPECT_EQ(thin_mesh.pockets, shape.topology.b2);
    expect_nothing_left_to_thin(p, dual, mesh, threshold);
    expect_features_survive(p, dual, mesh);
    EXPECT_LE(mesh.faces.size(), faces_before);
    faces_before = mesh.faces.size();
  }
}

TEST(Thin, KeepsTopologyAndFeatures) {
  for (const auto& shape : shapes::all())
    if (shape.name == "tetrahedron" || shape.name == "plate with hole") expect_thins(shape);
}

TEST(ModelsThin, KeepsTopologyAndFeaturesOfAllShapes) {
  for (const auto& shape : shapes::all()) expect_thins(shape);
}

}  // namespace
}  // namespace matstruct
