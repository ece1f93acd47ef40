// split_dual() on diagrams of few spheres, where cells, facets and edges fall apart: the Betti numbers must be the
// solid's, which those of the plain dual complex are not.

#include "extract/split_dual.h"

#include <gtest/gtest.h>

#include <matstruct/metrics.h>

#include <map>

#include "base/index.h"
#include "base/random.h"
#include "dual_betti.h"
#include "shapes.h"
#include "spheres/feature_spheres.h"

namespace matstruct {
namespace {

template <class Simplex>
void expect_sorted(const std::vector<Simplex>& simplices) {
  EXPECT_EQ(std::adjacent_find(simplices.begin(), simplices.end(), std::greater_equal<>()), simplices.end());
}

// A solid with spheres of radius 0 at points given in input units.
struct Case {
  Domain domain;
  Spheres spheres;
  RpdEngine engine;

  Case(const TetMesh& mesh, const std::vector<Vec3>& points) : domain(prepared(mesh)), engine(domain) {
    for (const Vec3& p : points) spheres.add({domain.frame.to_internal(p), 0});
    engine.compute(weighted_points(spheres), {});
  }
  static Domain prepared(const TetMesh& mesh) {
    Context context;
    return prepare_domain(mesh, {}, context);
  }

  SplitDual split() const {
    SplitDual result = split_dual(domain, engine, spheres);
    expect_sorted(result.dual.vertices);
    expect_sorted(result.dual.edges);
    expect_sorted(result.dual.triangles);
    expect_sorted(result.dual.tets);
    EXPECT_EQ(result.dual.lengths.size(), result.dual.triangles.size());
    for (const SphereSeed& s : result.added) {
      EXPECT_GE(s.radius, 0);
      EXPECT_NEAR(s.radius, std::sqrt(domain.query.closest(s.center).distance2), 1e-12);
    }
    return result;
  }
  Betti plain() const { return betti_of(dual_complex(engine.diagram())); }

  // Whether every component of a cell or facet has Euler characteristic 1 and no cell encloses a cavity.
  bool components_contractible() const {
    const Rpd& rpd = engine.diagram();
    const RpdComponents parts = rpd_components(domain, rpd);
    std::map<Index, Index> cells, facets;
    for (Index r = 0; r < count(rpd.cells); ++r) cells[parts.cells[uz(r)]] += rpd.cells[uz(r)].euler;
    for (Index r = 0; r < count(rpd.facets); ++r) facets[parts.facets[uz(r)]] += rpd.facets[uz(r)].euler;
    for (const auto* eulers : {&cells, &facets})
      for (const auto& [root, euler] : *eulers)
        if (euler != 1) return false;
    const auto violations = check_contractible(domain, rpd).violations;
    return std::none_of(violations.begin(), violations.end(),
                        [](const Violation& v) { return v.kind == ViolationKind::kCellCavity; });
  }
};

TEST(SplitDual, IsTheDualWhereEverythingIsConnected) {
  const Case c(shapes::plate_with_hole(), {{0.5, 0.6, 0.5}, {2.5, 0.5, 0.5}, {1.4, 2.5, 0.5}});
  const SplitDual split = c.split();
  EXPECT_TRUE(split.added.empty());
  EXPECT_EQ(split.dual.edges, dual_complex(c.engine.diagram()).edges);
  EXPECT_EQ(betti_of(split.dual), (Betti{1, 1, 0}));
}

TEST(SplitDual, CellInBothLegsOfAU) {
  const TetMesh u =
      shapes::grid({0, 1, 2, 4}, {0, 1, 2, 3}, {0, 1}, [](int i, int j, int) { return i != 1 || j == 0; });
  const Case c(u, {{1.5, 0.5, 0.5}, {1.5, 3.5, 0.5}});
  const SplitDual split = c.split();
  ASSERT_EQ(split.added.size(), 1u);  // the part in the thin leg; that in the other keeps the name
  EXPECT_LT(c.domain.frame.to_input(split.added[0].center).x, 1);
  EXPECT_EQ(split.dual.vertices, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(split.dual.edges, (std::vector<Edge>{{0, 1}, {0, 2}}));
}

// The greater part reaches sharp lines, too, but not the one on which the sphere stands.
TEST(SplitDual, CellInBothLegsOfASphereOnASharpLine) {
  const TetMesh u =
      shapes::grid({0, 1, 2, 4}, {0, 1, 2, 3}, {0, 1}, [](int i, int j, int) { return i != 1 || j == 0; });
  Case c(u, {{1.5, 0.5, 0.5}});
  const Vec3 on_line{1, 3, 0.5};
  SphereSeed seed{c.domain.frame.to_internal(on_line), 0, SphereType::kSharpEdge};
  const std::vector<FeatureLine>& lines = c.domain.features.lines;
  for (Index l = 0; l < count(lines); ++l)
    if (lines[uz(l)].edges.size() == 1 &&
        distance(c.domain.frame.to_input(point_on_line(c.domain, lines[uz(l)], 0.5)), on_line) < 1e-6)
      seed.line = l;
  ASSERT_NE(seed.line, kInvalid);
  c.spheres.add(seed);
  c.engine.compute(weighted_points(c.spheres), {});
  const SplitDual split = c.split();
  ASSERT_EQ(split.added.size(), 1u);
  EXPECT_GT(c.domain.frame.to_input(split.added[0].center).x, 2);
}

TEST(SplitDual, FacetOnEitherSideOfATunnel) {
  const Case c(shapes::plate_with_hole(), {{0.5, 1.5, 0.5}, {2.5, 1.5, 0.5}});
  EXPECT_EQ(c.plain(), (Betti{1, 0, 0}));
  EXPECT_EQ(betti_of(c.split().dual), (Betti{1, 1, 0}));
}

TEST(SplitDual, EdgeOnEitherSideOfACavity) {
  const Case c(shapes::hollow_box(), {{0.5, 0.6, 1.5}, {2.5, 0.5, 1.4}, {1.4, 2.5, 1.6}});
  EXPECT_EQ(c.plain(), (Betti{1, 0, 0}));
  EXPECT_EQ(betti_of(c.split().dual), (Betti{1, 0, 1}));
}

TEST(SplitDual, OneSphereForTwoComponents) {
  const TetMesh other = shapes::transformed(shapes::box({1, 1, 1}), [](Vec3 p) { return p + Vec3{2, 0, 0}; });
  const Case c(shapes::together(shapes::box({1, 1, 1}), other), {{0.1, 0.1, 0.1}});
  EXPECT_EQ(c.plain(), (Betti{1, 0, 0}));
  EXPECT_EQ(betti_of(c.split().dual), (Betti{2, 0, 0}));
}

TEST(SplitDual, HasTheTopologyOfTheSolidForRandomSpheres) {
  struct Solid {
    TetMesh mesh;
    Vec3 size;
    Betti betti;
  };
  const TetMesh comb = shapes::grid({0, 1, 2, 3, 4, 5}, {0, 1, 2, 3}, {0, 1, 2},
                                    [](int i, int j, int k) { return j == 0 || i % 2 == 0 || (j == 2 && k == 0); });
  int used = 0, mended = 0;
  for (const Solid& solid : {Solid{shapes::plate_with_hole(), {3, 3, 1}, {1, 1, 0}},
                             {shapes::hollow_box(), {3, 3, 3}, {1, 0, 1}},
                             {comb, {5, 3, 2}, {1, 2, 0}}})
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      KeyedRandom random(seed, 1, 0);
      std::vector<Vec3> points;
      for (std::uint64_t k = 0; k < 3 + seed % 12; ++k)
        points.push_back(
            {solid.size.x * random.uniform(), solid.size.y * random.uniform(), solid.size.z * random.uniform()});
      const Case c(solid.mesh, points);
      if (!c.components_contractible()) continue;
      ++used;
      mended += c.plain() != solid.betti;
      EXPECT_EQ(betti_of(c.split().dual), solid.betti) << "seed " << seed;
    }
  EXPECT_GT(used, 60);
  EXPECT_GT(mended, 10);
}

TEST(SplitDual, GuardsStayGuards) {
  const TetMesh u =
      shapes::grid({0, 1, 2, 4}, {0, 1, 2, 3}, {0, 1}, [](int i, int j, int) { return i != 1 || j == 0; });
  Case c(u, {{1.5, 0.5, 0.5}, {1.5, 3.5, 0.5}});
  c.spheres.seeds[1].guard = true;
  const SplitDual split = c.split();
  ASSERT_EQ(split.added.size(), 1u);
  EXPECT_TRUE(split.added[0].guard);
}

}  // namespace
}  // namespace matstruct
