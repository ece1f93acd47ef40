// Contacts of balls in boxes and in a cylinder, where they are known.

#include "spheres/contacts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/index.h"
#include "base/random.h"
#include "shapes.h"
#include "solid_domain.h"

namespace matstruct {
namespace {

TEST(Contacts, OfBallsInABox) {
  Box box(1, 2, 3);
  EXPECT_EQ(box.sphere_at({0, 0, 0}).contacts.size(), 2u);
  EXPECT_EQ(box.sphere_at({0, 0.5, 0}).contacts.size(), 3u);
  EXPECT_EQ(box.sphere_at({0, 0.5, 1}).contacts.size(), 4u);
  EXPECT_EQ(box.sphere_at({0.3, 0, 0}).contacts.size(), 1u);
  Box cube(1, 1, 1);
  const Contacts contacts = cube.sphere_at({0, 0, 0}).contacts;
  ASSERT_EQ(contacts.size(), 6u);
  for (const Contact& c : contacts) {
    EXPECT_NEAR(cube.to_input(c.distance), 0.5, 1e-12);
    EXPECT_NEAR(distance(c.point, cube.domain.frame.to_internal({})), c.distance, 1e-15);
  }
}

TEST(Contacts, AreFoundWithinTheTouchNearestFirst) {
  Box box(1, 2, 3);
  const Vec3 center = box.domain.frame.to_internal({0.1, 0, 0});
  const double radius = box.to_internal(0.4);
  EXPECT_EQ(box.finder.find(center, radius, 0).size(), 1u);
  EXPECT_EQ(box.finder.find(center, radius, box.to_internal(0.19)).size(), 1u);
  const Contacts two = box.finder.find(center, radius, box.to_internal(0.21));
  ASSERT_EQ(two.size(), 2u);
  EXPECT_NEAR(box.to_input(two[0].distance), 0.4, 1e-12);
  EXPECT_NEAR(box.to_input(two[1].distance), 0.6, 1e-12);
}

TEST(Contacts, FollowTheCentreOnTheirFace) {
  Box box(1, 2, 3);
  const Contact from = box.contact_near({0.5, 0.2, 0.3});
  const Vec3 center = box.domain.frame.to_internal({-0.3, -0.7, 1.1});  // nearer to other faces
  const Contact there = box.finder.follow(from, center);
  EXPECT_NEAR(distance(there.point, box.domain.frame.to_internal({0.5, -0.7, 1.1})), 0, 1e-15);
  EXPECT_NEAR(box.to_input(there.distance), 0.8, 1e-12);
  EXPECT_TRUE(box.finder.same(there, box.finder.follow(there, center)));
  EXPECT_FALSE(box.finder.same(there, box.finder.follow(box.contact_near({-0.5, 0, 0}), center)));
}

TEST(Contacts, OneGoesRoundTheAxisOfACylinder) {
  PreparedSolid cylinder(oracle::tet_mesh_of(oracle::prism(32, 1, 6)));
  const TangentSphere on_axis = cylinder.sphere_at({0, 0, 0});
  ASSERT_EQ(on_axis.contacts.size(), 1u);
  EXPECT_GT(cylinder.finder.spread(on_axis.contacts[0], on_axis.center), 0.9 * std::numbers::pi);
  const TangentSphere beside = cylinder.sphere_at({0.5, 0, 0});
  ASSERT_EQ(beside.contacts.size(), 1u);
  EXPECT_LT(cylinder.finder.spread(beside.contacts[0], beside.center), 0.5 * std::numbers::pi);
}

TEST(Contacts, AreTheBasinsOfTheTrianglesInReach) {
  // A body with bulges, which a ball inside sees as basins with passes between them; walks begin high above them.
  TetMesh bulged = shapes::prism(1, 3, 40, 24);
  bulged = shapes::transformed(std::move(bulged), [](Vec3 p) {
    const double swell = 1 + 0.15 * std::sin(5 * std::atan2(p.y, p.x)) * std::cos(4 * p.z);
    return Vec3{swell * p.x, swell * p.y, p.z};
  });
  PreparedSolid solid(bulged);
  KeyedRandom random(7, 0, 0);
  const auto between = [&](double least, double greatest) { return least + (greatest - least) * random.uniform(); };
  std::vector<Index> triangles;
  std::size_t most = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 center = solid.domain.frame.to_internal({between(-0.4, 0.4), between(-0.4, 0.4), between(0.5, 2.5)});
    const double radius = std::sqrt(solid.domain.query.closest(center).distance2);
    const Contacts contacts = solid.finder.find(center, radius, 0.5 * radius);
    most = std::max(most, contacts.size());
    std::vector<bool> reached(contacts.size(), false);
    solid.domain.query.within(center, 1.5 * radius, triangles);
    for (const Index t : triangles) {
      const Contact lowest = solid.finder.follow({{}, t, 0}, center);
      const auto at = std::find_if(contacts.begin(), contacts.end(),
                                   [&](const Contact& c) { return solid.finder.same(c, lowest); });
      ASSERT_NE(at, contacts.end());
      EXPECT_EQ(at->distance, lowest.distance);
      reached[static_cast<std::size_t>(at - contacts.begin())] = true;
    }
    EXPECT_EQ(std::count(reached.begin(), reached.end(), false), 0);
  }
  EXPECT_GE(most, 4u);
}

TEST(Contacts, DirectionAtRadiusZeroIsTheNormal) {
  Box box(1, 2, 3);
  const Vec3 corner = box.domain.frame.to_internal({0.5, 1, 1.5});
  const Contacts contacts = box.finder.find(corner, 0, 0);
  ASSERT_EQ(contacts.size(), 3u);
  Vec3 sum;
  for (const Contact& c : contacts) sum += direction(box.domain, corner, c);
  EXPECT_NEAR(distance(box.domain.frame.turned_back(sum), {1, 1, 1}), 0, 1e-12);
}

TEST(Patches, EndAtConvexSharpEdgesOnly) {
  const auto number = [](const TetMesh& mesh) {
    Context context;
    const Domain domain = prepare_domain(mesh, {}, context);
    const std::vector<Index> patch = patches(domain);
    EXPECT_EQ(patch.size(), domain.surface.triangles.size());
    for (Index t = 0; t < count(patch); ++t)  // numbered by their first triangles
      EXPECT_LE(patch[uz(t)], t == 0 ? 0 : *std::max_element(patch.begin(), patch.begin() + t) + 1);
    return *std::max_element(patch.begin(), patch.end()) + 1;
  };
  EXPECT_EQ(number(shapes::box({1, 2, 3}, 2, 2, 2)), 6);
  EXPECT_EQ(number(shapes::l_profile()), 7);  // eight faces, of which two meet in the concave edge
  EXPECT_EQ(number(oracle::tet_mesh_of(oracle::prism(32, 1, 2))), 3);
}

}  // namespace
}  // namespace matstruct
