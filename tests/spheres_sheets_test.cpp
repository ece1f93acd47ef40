// Which spheres of a box lie in one stratum.

#include "spheres/sheets.h"

#include <gtest/gtest.h>

#include <array>

#include "base/index.h"
#include "shapes.h"
#include "solid_domain.h"

namespace matstruct {
namespace {

constexpr double kDepth = 1e-6;

class Sheets : public testing::Test {
 protected:
  Index stratum(const std::vector<Vec3>& centers) {
    std::vector<TangentSphere> spheres;
    for (const Vec3& c : centers) spheres.push_back(box.sphere_at(c));
    std::vector<const TangentSphere*> corners;
    for (const TangentSphere& s : spheres) corners.push_back(&s);
    return common_stratum(box.finder, corners, kDepth);
  }

  Box box{1, 2, 3};
};

TEST_F(Sheets, TwoContactsWithinASheet) {
  EXPECT_EQ(stratum({{0, 0, 0}, {0, 0.3, 0.5}}), 2);
  EXPECT_EQ(stratum({{0, 0, 0}, {0, 0.3, 0.5}, {0, 0.5, 0}}), 2);                   // with a sphere of the seam
  EXPECT_EQ(stratum({{0, 0.5, 1}, {0, -0.5, 1}}), 2 + 1);                           // two junctions: along the seam
  EXPECT_EQ(stratum({{0, 0.5, 1}, {0, -0.5, -1}}), 2);                              // and across the sheet
  EXPECT_EQ(stratum({{-0.3, -0.8, 0}, {-0.2, -0.7, 0.5}, {-0.1, -0.6, -0.5}}), 2);  // between left and front
}

TEST_F(Sheets, ThreeContactsAlongASeam) {
  EXPECT_EQ(stratum({{0, 0.5, 0}, {0, 0.5, 0.5}}), 3);
  EXPECT_EQ(stratum({{0, 0.5, 1}, {0.25, 0.75, 1.25}}), 3);  // from a junction to a corner
}

TEST_F(Sheets, NoneAcrossASeam) {
  EXPECT_EQ(stratum({{0, 0, 0}, {-0.3, -0.8, 0}}), 0);      // one face in common
  EXPECT_EQ(stratum({{0.3, 0.8, 0}, {-0.3, -0.8, 0}}), 0);  // no face in common
  EXPECT_EQ(stratum({{0, 0, 0}, {0, 0.3, 0}, {0.3, 0.8, 0}}), 0);
}

TEST_F(Sheets, TheBallOfAStratumIsExact) {
  const TangentSphere a = box.sphere_at({-0.3, -0.8, 0}), b = box.sphere_at({-0.1, -0.6, 0.4});
  const auto ball = common_ball(box.finder, std::array{&a, &b}, kDepth);
  ASSERT_TRUE(ball);
  EXPECT_NEAR(distance(box.domain.frame.to_input(ball->center), {-0.2, -0.7, 0.2}), 0, 1e-12);
  EXPECT_NEAR(box.to_input(ball->radius), 0.3, 1e-12);
}

TEST(MedialCurve, RunsAlongTheAxisOfACylinder) {
  PreparedSolid cylinder(oracle::tet_mesh_of(oracle::prism(32, 1, 8)));
  const TangentSphere a = cylinder.sphere_at({0, 0, -1}), b = cylinder.sphere_at({0, 0, 1}),
                      beside = cylinder.sphere_at({0.4, 0, 0});
  EXPECT_TRUE(on_medial_curve(a));
  EXPECT_FALSE(on_medial_curve(beside));
  EXPECT_EQ(common_stratum(cylinder.finder, std::array{&a, &b}, kDepth), 1);
  EXPECT_EQ(common_stratum(cylinder.finder, std::array{&beside, &beside}, kDepth), 0);
}

// A bar with round ends: its middle sheet ends on the axes of these.
TEST(SheetInFillet, ReachesToTheSpheresThatEndIt) {
  constexpr int kFacets = 32;
  std::vector<oracle::HalfSpace> walls{{{0, 0, 1}, 4}, {{0, 0, -1}, 4}};
  for (int k = 0; k < kFacets; ++k) {
    const Vec3 normal = oracle::on_circle(k, kFacets);
    walls.push_back({normal, 2 * std::abs(normal.x) + 1});
  }
  PreparedSolid bar(oracle::tet_mesh_of(oracle::convex_polyhedron(walls)));
  const auto stratum = [&](const std::vector<Vec3>& centers) {
    std::vector<TangentSphere> spheres;
    for (const Vec3& c : centers) spheres.push_back(bar.sphere_at(c));
    std::vector<const TangentSphere*> corners;
    for (const TangentSphere& s : spheres) corners.push_back(&s);
    return common_stratum(bar.finder, corners, kDepth);
  };
  EXPECT_EQ(stratum({{1.5, 0, 0}, {2, 0, 0.2}}), 2);
  EXPECT_EQ(stratum({{2, 0, 0}, {2, 0, 0.5}}), 2);
  EXPECT_EQ(stratum({{1.5, 0, 0}, {1.5, 0, 0.5}, {2, 0, 0.2}}), 2);
  EXPECT_EQ(stratum({{1.5, 0, 0}, {2, 0, 0}, {2, 0, 0.5}}), 2);
  EXPECT_EQ(stratum({{2, 0, -0.5}, {2, 0, 0}, {2, 0, 0.5}}), 0);   // no sheet beyond its end
  EXPECT_EQ(stratum({{2, 0, 0}, {1.5, 0, 0}, {1.5, 0, 3.5}}), 0);  // the last touches the lid alone
}

// A boss on a plate: its upright sharp edges end on the plate, where their walls and the plate are one smooth patch.
TEST(SheetAtASharpLine, ReachesToTheEndOfTheLine) {
  PreparedSolid boss(shapes::grid({0, 1, 2, 3}, {0, 1, 2, 3}, {0, 1, 2},
                                  [](int i, int j, int k) { return k == 0 || (i == 1 && j == 1); }));
  const auto stratum = [&](const std::vector<Vec3>& centers) {
    std::vector<TangentSphere> spheres;
    for (const Vec3& c : centers) spheres.push_back(boss.sphere_at(c));
    // Spheres on lines have no spread (see with_contacts()).
    spheres[0].radius = spheres[0].spread = 0;
    std::vector<const TangentSphere*> corners;
    for (const TangentSphere& s : spheres) corners.push_back(&s);
    return common_stratum(boss.finder, corners, kDepth);
  };
  const Vec3 end{1, 1, 1}, on_line{1, 1, 1.5}, between_walls{1.2, 1.2, 1.3}, in_plate{0.8, 0.8, 0.5};
  ASSERT_EQ(boss.sphere_at(end).contacts.size(), 1u);
  EXPECT_EQ(stratum({end, between_walls}), 2);
  EXPECT_EQ(stratum({end, on_line, between_walls}), 2);
  EXPECT_EQ(stratum({end, on_line, in_plate}), 0);
  EXPECT_EQ(stratum({end, between_walls, in_plate}), 0);
}

// A bar whose legs spread from a narrow top: the sheets from the top's two edges meet at 60 degrees, so that the ball
// of each next to one of the other is above the seam.
TEST(SeamSeeds, LieWhereSheetsMeetAtLessThanARightAngle) {
  const double slope = 1 / std::numbers::sqrt3;
  const Vec3 leg = normalized(Vec3{1, 0, slope});
  const auto wall = [](const Vec3& normal, const Vec3& through) {
    return oracle::HalfSpace{normal, dot(normal, through)};
  };
  PreparedSolid bar(oracle::tet_mesh_of(oracle::convex_polyhedron({wall(leg, {0.5, 0, 0}),
                                                                   wall({-leg.x, 0, leg.z}, {-0.5, 0, 0}),
                                                                   {{0, 0, 1}, 0},
                                                                   {{0, 0, -1}, 5},
                                                                   {{0, 1, 0}, 5},
                                                                   {{0, -1, 0}, 5}})));
  // The ball tangent to the top and both legs: as far below the top as from a leg.
  const double radius = 0.5 * leg.x / (1 - leg.z);
  const auto beside_seam = [&](double side) {
    const double r = 0.9 * radius;  // tangent to the top and a leg
    return bar.sphere_at({side * (0.5 - r * (1 - leg.z) / leg.x), 0, -r});
  };
  std::vector<TangentSphere> spheres{beside_seam(1), beside_seam(-1)};
  for (const TangentSphere& s : spheres) ASSERT_EQ(s.contacts.size(), 2u);
  FinderPool finders(bar.domain, kSmoothAngle);
  Context context;
  const std::vector<TangentSphere> seeds = seam_seeds(finders, spheres, {{0, 1}}, context);
  ASSERT_EQ(seeds.size(), 1u);
  EXPECT_EQ(seeds[0].contacts.size(), 3u);
  EXPECT_NEAR(bar.to_input(seeds[0].radius), radius, 1e-9);
  EXPECT_NEAR(distance(bar.domain.frame.to_input(seeds[0].center), {0, 0, -radius}), 0, 1e-9);
}

}  // namespace
}  // namespace matstruct
