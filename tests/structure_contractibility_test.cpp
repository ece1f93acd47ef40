// check_contractible() where it is plain to see what is wrong: few spheres in solids with tunnels, cavities and arms.

#include "structure/contractibility.h"

#include <gtest/gtest.h>

#include "base/index.h"
#include "rpd/pinch_contacts.h"
#include "shapes.h"

namespace matstruct {
namespace {

Domain domain_of(const TetMesh& mesh) {
  Context context;
  return prepare_domain(mesh, {}, context);
}

// Diagram of points of weight 0, given in input units.
Rpd diagram(const Domain& domain, const std::vector<Vec3>& points) {
  std::vector<WeightedPoint> spheres;
  for (const Vec3& p : points) spheres.push_back({domain.frame.to_internal(p), 0});
  RpdEngine engine(domain);
  engine.compute(spheres, {});
  return engine.diagram();
}

struct Finding {
  ViolationKind kind;
  Triangle spheres;
  friend bool operator==(const Finding&, const Finding&) = default;
  friend void PrintTo(const Finding& f, std::ostream* out) {
    *out << "kind " << static_cast<int>(f.kind) << " of " << f.spheres[0] << " " << f.spheres[1] << " " << f.spheres[2];
  }
};
using Findings = std::vector<Finding>;

Findings findings(const TetMesh& mesh, const std::vector<Vec3>& points) {
  const Domain domain = domain_of(mesh);
  const Contractibility check = check_contractible(domain, diagram(domain, points));
  EXPECT_EQ(check.mismatches, 0);
  Findings result;
  for (const Violation& v : check.violations) {
    EXPECT_FALSE(v.records.empty());
    result.push_back({v.kind, v.spheres});
  }
  return result;
}

Finding cell(ViolationKind kind, Index s = 0) {
  return {kind, {s, kInvalid, kInvalid}};
}
Finding facet(ViolationKind kind, Index s, Index t) {
  return {kind, {s, t, kInvalid}};
}

// A U of depth 1: legs [0, 1] and [2, 4] of height 3 on a base of height 1.
TetMesh u_shape() {
  return shapes::grid({0, 1, 2, 4}, {0, 1, 2, 3}, {0, 1}, [](int i, int j, int) { return i != 1 || j == 0; });
}

// A block 5 x 3 x 3 with a tunnel along z and, beside it, a cavity.
TetMesh tunnel_and_cavity() {
  return shapes::grid({0, 1, 2, 3, 4, 5}, {0, 1, 2, 3}, {0, 1, 2, 3},
                      [](int i, int j, int k) { return !(j == 1 && (i == 1 || (i == 3 && k == 1))); });
}

TEST(Contractible, OneSphereInAConvexSolid) {
  EXPECT_EQ(findings(shapes::box({1, 2, 3}, 2, 2, 2), {{0.5, 1, 1}}), Findings{});
  EXPECT_EQ(findings(shapes::l_profile(), {{0.5, 0.5, 1}}), Findings{});
}

TEST(Contractible, OneSphereInASolidWithATunnel) {
  EXPECT_EQ(findings(shapes::plate_with_hole(), {{0.5, 0.5, 0.5}}), Findings{cell(ViolationKind::kCellEuler)});
  EXPECT_EQ(findings(shapes::torus(3, 1, 12, 8), {{3, 0, 0}}), Findings{cell(ViolationKind::kCellEuler)});
}

TEST(Contractible, OneSphereInAHollowSolid) {
  EXPECT_EQ(findings(shapes::hollow_box(), {{0.5, 0.5, 0.5}}),
            (Findings{cell(ViolationKind::kCellEuler), cell(ViolationKind::kCellCavity)}));
}

TEST(Contractible, TunnelAndCavityCancelInTheEulerCharacteristic) {
  EXPECT_EQ(findings(tunnel_and_cavity(), {{0.5, 0.5, 0.5}}), Findings{cell(ViolationKind::kCellCavity)});
  // Another sphere, which takes a corner off, changes nothing for the first one.
  EXPECT_EQ(findings(tunnel_and_cavity(), {{4.2, 2.2, 2.2}, {4.9, 2.9, 2.9}}),
            Findings{cell(ViolationKind::kCellCavity)});
}

TEST(Contractible, OneSphereForTwoComponents) {
  EXPECT_EQ(findings(shapes::together(shapes::box({1, 1, 1}), shapes::transformed(shapes::box({1, 1, 1}),
                                                                                  [](Vec3 p) {
                                                                                    return p + Vec3{2, 0, 0};
                                                                                  })),
                     {{0.1, 0.1, 0.1}}),
            Findings{cell(ViolationKind::kCellDisconnected)});
  EXPECT_EQ(findings(shapes::box_in_box(), {{2.5, 2.4, 2.3}}),
            (Findings{cell(ViolationKind::kCellDisconnected), cell(ViolationKind::kCellCavity)}));
}

TEST(Contractible, CellInBothLegsOfAU) {
  const Domain domain = domain_of(u_shape());
  const Rpd rpd = diagram(domain, {{1.5, 0.5, 0.5}, {1.5, 3.5, 0.5}});  // separated by y = 2
  const auto violations = check_contractible(domain, rpd).violations;
  ASSERT_EQ(violations.size(), 2u);
  EXPECT_EQ(violations[0].kind, ViolationKind::kCellDisconnected);
  EXPECT_EQ(violations[0].spheres[0], 1);
  EXPECT_EQ(violations[1].kind, ViolationKind::kFacetDisconnected);

  // The offending parts are those in the thin leg.
  double volume = 0, area = 0;
  for (const Index r : violations[0].records) volume += rpd.cells[uz(r)].volume;
  for (const Index r : violations[1].records) area += rpd.facets[uz(r)].area;
  EXPECT_NEAR(volume, std::pow(domain.frame.scale, 3), 1e-12);
  EXPECT_NEAR(area, std::pow(domain.frame.scale, 2), 1e-12);
}

// Two floors that two columns connect; the columns touch along an edge from floor to floor, of which only the middle
// has two copies. Slabs across the columns: the lower one reaches the edge between its end and its middle.
TEST(Contractible, SlabsOfColumnsThatTouchAlongAnEdge) {
  const Domain domain =
      domain_of(shapes::grid({0, 1, 2}, {0, 1, 2}, {0, 1, 2, 3}, [](int i, int j, int k) { return k != 1 || i == j; }));
  std::vector<WeightedPoint> spheres;
  for (const double z : {0.9, 1.3, 1.45, 1.7, 1.95}) spheres.push_back({domain.frame.to_internal({1, 1, z}), 0});
  RpdEngine engine(domain);
  engine.compute(spheres, {});
  EXPECT_TRUE(check_contractible(domain, engine.diagram(), pinch_contacts(domain, engine)).violations.empty());
  // Seen without the edge, every slab and every facet between slabs is in two parts.
  const auto apart = check_contractible(domain, engine.diagram()).violations;
  Findings found;
  for (const Violation& v : apart) found.push_back({v.kind, v.spheres});
  EXPECT_EQ(found,
            (Findings{cell(ViolationKind::kCellDisconnected, 1), cell(ViolationKind::kCellDisconnected, 2),
                      cell(ViolationKind::kCellDisconnected, 3), facet(ViolationKind::kFacetDisconnected, 0, 1),
                      facet(ViolationKind::kFacetDisconnected, 1, 2), facet(ViolationKind::kFacetDisconnected, 2, 3),
                      facet(ViolationKind::kFacetDisconnected, 3, 4)}));
}

TEST(Contractible, TwoSpheresOnEitherSideOfATunnel) {
  EXPECT_EQ(findings(shapes::plate_with_hole(), {{0.5, 1.5, 0.5}, {2.5, 1.5, 0.5}}),
            Findings{facet(ViolationKind::kFacetDisconnected, 0, 1)});
}

TEST(Contractible, TwoSpheresOneAboveTheOtherAroundATunnel) {
  EXPECT_EQ(findings(shapes::plate_with_hole(), {{0.5, 1.5, 0.2}, {0.5, 1.5, 0.7}}),
            (Findings{cell(ViolationKind::kCellEuler, 0), cell(ViolationKind::kCellEuler, 1),
                      facet(ViolationKind::kFacetEuler, 0, 1)}));
}

TEST(Contractible, ThreeSpheresAroundATunnel) {
  EXPECT_EQ(findings(shapes::plate_with_hole(), {{0.5, 0.6, 0.5}, {2.5, 0.5, 0.5}, {1.4, 2.5, 0.5}}), Findings{});
}

TEST(Contractible, ThreeSpheresAroundACavity) {
  EXPECT_EQ(findings(shapes::hollow_box(), {{0.5, 0.6, 1.5}, {2.5, 0.5, 1.4}, {1.4, 2.5, 1.6}}),
            (Findings{{ViolationKind::kEdgeDisconnected, {0, 1, 2}}}));
}

TEST(Contractible, FourSpheresAroundACavity) {
  EXPECT_EQ(findings(shapes::hollow_box(), {{0.4, 0.6, 0.5}, {2.5, 2.6, 0.5}, {0.5, 2.6, 2.5}, {2.5, 0.4, 2.6}}),
            Findings{});
}

TEST(Contractible, WholeSetsHoldAllRecords) {
  const Domain domain = domain_of(u_shape());
  const Rpd rpd = diagram(domain, {{1.5, 0.5, 0.5}, {1.5, 3.5, 0.5}});
  const auto cells = whole_cells(rpd, {1, 1}, ViolationKind::kGuard);
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_EQ(cells[0].kind, ViolationKind::kGuard);
  EXPECT_EQ(count(cells[0].records),
            std::count_if(rpd.cells.begin(), rpd.cells.end(), [](const RpdCell& c) { return c.sphere == 1; }));
  const auto facets = whole_facets(rpd, {{0, 1}}, ViolationKind::kGuard);
  ASSERT_EQ(facets.size(), 1u);
  EXPECT_EQ(facets[0].records.size(), rpd.facets.size());
  EXPECT_TRUE(whole_cells(rpd, {}, ViolationKind::kGuard).empty());
}

}  // namespace
}  // namespace matstruct
