// Balls tangent to given faces of a box, and the seams that leave one.

#include "spheres/tangency.h"

#include <gtest/gtest.h>

#include "base/index.h"
#include "solid_domain.h"

namespace matstruct {
namespace {

constexpr double kReach = 10;
constexpr double kExact = 1e-12;

class Tangency : public testing::Test {
 protected:
  std::optional<TangentSphere> ball(const Vec3& guess, const std::vector<Vec3>& faces, double reach = kReach) {
    return tangent_sphere(box.finder, box.domain.frame.to_internal(guess), box.contacts_near(faces), reach);
  }
  void expect_ball(const std::optional<TangentSphere>& sphere, const Vec3& center, double radius) {
    ASSERT_TRUE(sphere);
    EXPECT_NEAR(distance(box.domain.frame.to_input(sphere->center), center), 0, kExact);
    EXPECT_NEAR(box.to_input(sphere->radius), radius, kExact);
    for (const Contact& c : sphere->contacts) EXPECT_NEAR(c.distance, sphere->radius, kExact);
  }

  Box box{1, 2, 3};
  const Vec3 left{-0.5, 0.1, 0.1}, right{0.5, 0.1, 0.1}, front{0.1, -1, 0.1}, back{0.1, 1, 0.1}, below{0.1, 0.1, -1.5};
};

TEST_F(Tangency, TwoContactsLeaveTheSheetFree) {
  expect_ball(ball({0.3, 0.2, 0.4}, {left, right}), {0, 0.2, 0.4}, 0.5);
  expect_ball(ball({0.1, -0.8, 0.7}, {left, front}), {-0.1, -0.6, 0.7}, 0.4);
}

TEST_F(Tangency, ThreeContactsLeaveTheSeamFree) {
  expect_ball(ball({0.2, -0.1, 0.3}, {left, right, front}), {0, -0.5, 0.3}, 0.5);
}

TEST_F(Tangency, FourContactsFixTheBall) {
  expect_ball(ball({0.3, 0.2, 0.4}, {left, right, front, below}), {0, -0.5, -1}, 0.5);
}

TEST_F(Tangency, NothingWithoutSuchABallInReach) {
  EXPECT_FALSE(ball({0, 0, 0}, {left, left + Vec3{0, 0.2, 0}}));  // one face
  EXPECT_FALSE(ball({0.3, 0, 0}, {left, right}, box.to_internal(0.2)));
  EXPECT_TRUE(ball({0.3, 0, 0}, {left, right}, box.to_internal(0.4)));
  EXPECT_FALSE(ball({0, 0, 0}, {left, right, front, back}));  // distances 0.5, 0.5, 1, 1
}

TEST_F(Tangency, IntrudersAreWhatABallHolds) {
  const auto good = ball({0, 0, 0}, {left, right}), large = ball({0, 0, 0}, {front, back});
  ASSERT_TRUE(good && large);
  EXPECT_TRUE(inside(box.finder, *good));
  EXPECT_FALSE(intruder(box.finder, *good, 1e-9));
  const auto found = intruder(box.finder, *large, 1e-9);
  ASSERT_TRUE(found);
  EXPECT_NEAR(box.to_input(found->distance), 0.5, kExact);
  EXPECT_FALSE(intruder(box.finder, *large, box.to_internal(0.51)));
}

TEST_F(Tangency, ShrinksToTheSeamWhereItsSheetEnds) {
  // On the plane between left and below, beyond the seam where the face on the right comes near.
  const auto beyond = ball({0.3, 0.1, -0.7}, {left, below});
  expect_ball(beyond, {0.3, 0.1, -0.7}, 0.8);
  const auto seam = shrunk_to_next_contact(box.finder, *beyond, 1e-9, kReach);
  expect_ball(seam, {0, 0.1, -1}, 0.5);
  ASSERT_EQ(seam->contacts.size(), 3u);
  EXPECT_TRUE(box.finder.same(seam->contacts[2], box.finder.follow(box.contact_near(right), seam->center)));
}

TEST_F(Tangency, DoesNotShrinkWhatIsEmptyOrHasNoEmptyBall) {
  const auto good = ball({0, 0, 0}, {left, right}), large = ball({0, 0, 0}, {front, back});
  EXPECT_FALSE(shrunk_to_next_contact(box.finder, *good, 1e-9, kReach));
  EXPECT_FALSE(shrunk_to_next_contact(box.finder, *large, 1e-9, kReach));
}

std::vector<Vec3> directions_of(const PreparedSolid& solid, const TangentSphere& sphere) {
  std::vector<Vec3> directions;
  for (const Contact& c : sphere.contacts) directions.push_back(direction(solid.domain, sphere.center, c));
  return directions;
}

TEST(SeamDirections, EightLeaveTheCentreOfACube) {
  Box cube(1, 1, 1);
  const std::vector<SeamDirection> ways = seam_directions(directions_of(cube, cube.sphere_at({})));
  ASSERT_EQ(ways.size(), 8u);
  for (const SeamDirection& way : ways) {
    EXPECT_EQ(way.contacts.size(), 3u);
    for (const double x : {way.direction.x, way.direction.y, way.direction.z})
      EXPECT_NEAR(std::abs(x), 1 / std::numbers::sqrt3, kExact);
  }
}

TEST(SeamDirections, TwoOppositeOnesAlongASeam) {
  Box box(1, 2, 3);
  const std::vector<SeamDirection> ways = seam_directions(directions_of(box, box.sphere_at({0, 0.5, 0})));
  ASSERT_EQ(ways.size(), 2u);
  EXPECT_EQ(ways[0].contacts, ways[1].contacts);
  EXPECT_NEAR(distance(ways[0].direction, -ways[1].direction), 0, kExact);
  EXPECT_NEAR(std::abs(box.domain.frame.turned_back(ways[0].direction).z), 1, kExact);
}

TEST(SeamDirections, FourLeaveAJunctionAndNoneASheet) {
  Box box(1, 2, 3);
  EXPECT_EQ(seam_directions(directions_of(box, box.sphere_at({0, 0.5, 1}))).size(), 4u);
  EXPECT_TRUE(seam_directions(directions_of(box, box.sphere_at({0, 0, 0}))).empty());
}

TEST(SeamDirections, FourContactsInOnePlaneMakeOneSeam) {
  Box column(1, 1, 3);
  const std::vector<SeamDirection> ways = seam_directions(directions_of(column, column.sphere_at({})));
  ASSERT_EQ(ways.size(), 2u);
  EXPECT_EQ(ways[0].contacts, (std::vector<Index>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace matstruct
