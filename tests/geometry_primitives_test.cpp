// Closed forms of cones and slabs against two brute-force twins: minimisation over the balls of the primitive, and the
// supporting planes of the convex hull.
#include "geometry/primitives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "base/random.h"

namespace matstruct {
namespace {

using Balls = std::array<Ball, 3>;

double minimise(const std::function<double(double)>& convex, double low, double high) {
  for (int step = 0; step < 60; ++step) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (convex(a) <= convex(b))
      high = b;
    else
      low = a;
  }
  return std::min({convex((low + high) / 2), convex(low), convex(high)});
}

/// min over the weights of |x - c| - r, by nested ternary search.
double twin_distance(const Vec3& x, const Balls& s) {
  return minimise(
      [&](double w1) {
        return minimise(
            [&](double w2) {
              return distance_to_ball(x, ball_at(s[0], s[1], s[2], {1 - w1 - w2, w1, w2}));
            },
            0, 1 - w1);
      },
      0, 1);
}

Vec3 random_point(KeyedRandom& random, double size) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return Vec3{2 * x - 1, 2 * y - 1, 2 * z - 1} * size;
}

Balls random_balls(KeyedRandom& random, double greatest_radius) {
  Balls balls;
  for (Ball& ball : balls) {
    ball.center = random_point(random, 1);
    ball.radius = random.uniform() * greatest_radius;
  }
  return balls;
}

/// Slabs of all kinds: flat, steep, with balls inside other balls, collinear or equal centres, zero and equal radii.
std::vector<Balls> slabs() {
  std::vector<Balls> list;
  for (std::uint64_t k = 0; k < 120; ++k) {
    KeyedRandom random(1, 1, k);
    Balls s = random_balls(random, k % 2 == 0 ? 0.3 : 1.5);
    if (k % 10 == 1) s[2].center = lerp(s[0].center, s[1].center, 0.4);
    if (k % 10 == 2) s[1].center = s[0].center;
    if (k % 10 == 3) s[0].radius = s[1].radius = s[2].radius = 0;
    if (k % 10 == 4) s[1].radius = s[0].radius, s[2].radius = s[0].radius;
    if (k % 10 == 5) s[2] = s[1] = s[0];
    if (k % 10 == 6) s[2].center = lerp(s[0].center, s[1].center, 0.4) + random_point(random, 1e-9);
    if (k % 10 == 7) s[2] = ball_at(s[0], s[1], s[1], {0.3, 0.7, 0});
    list.push_back(s);
  }
  return list;
}

std::vector<Vec3> points_around(const Balls& s, std::uint64_t key) {
  KeyedRandom random(2, 2, key);
  std::vector<Vec3> points{s[0].center, s[2].center, (s[0].center + s[1].center + s[2].center) / 3,
                           lerp(s[0].center, s[1].center, 0.5)};
  for (int k = 0; k < 10; ++k) points.push_back(random_point(random, k < 5 ? 1 : 3));
  return points;
}

TEST(Primitives, SlabAgreesWithMinimisationOverItsBalls) {
  std::uint64_t key = 0;
  for (const Balls& s : slabs()) {
    for (const Vec3& x : points_around(s, key++)) {
      const PrimitiveHit hit = closest_on_slab(x, s[0], s[1], s[2]);
      const double twin = twin_distance(x, s);
      EXPECT_NEAR(hit.distance, twin, 1e-7);
      EXPECT_LE(hit.distance, twin + 1e-12) << "the twin found a nearer ball";
    }
  }
}

// Of the sides only those are looked at that separate the triangle from the least point of its plane: also where
// rounding may hide which they are.
TEST(Primitives, NoSideOfASlabIsNearer) {
  for (std::uint64_t k = 0; k < 300; ++k) {
    KeyedRandom random(3, 1, k);
    Balls s = random_balls(random, k % 3 == 0 ? 0 : 0.3);
    const double height = std::pow(10.0, -double(k % 13));
    s[2].center = lerp(s[0].center, s[1].center, 2 * random.uniform() - 0.5) + random_point(random, height);
    if (k % 2 == 0) std::swap(s[0], s[2]);
    for (int p = 0; p < 40; ++p) {
      const Vec3 x = lerp(s[0].center, s[1].center, random.uniform()) + random_point(random, p % 2 == 0 ? 3 : height);
      const double slab = closest_on_slab(x, s[0], s[1], s[2]).distance;
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_LE(slab, closest_on_cone(x, s[i], s[(i + 1) % 3]).distance + 1e-9) << height;
    }
  }
}

TEST(Primitives, ConeAgreesWithMinimisationOverItsBalls) {
  std::uint64_t key = 0;
  for (const Balls& s : slabs()) {
    for (const Vec3& x : points_around(s, key++)) {
      const double twin = minimise(
          [&](double w) {
            return distance_to_ball(x, ball_at(s[0], s[1], s[1], {1 - w, w, 0}));
          },
          0, 1);
      EXPECT_NEAR(closest_on_cone(x, s[0], s[1]).distance, twin, 1e-9);
    }
  }
}

TEST(Primitives, WeightsBelongToTheDistance) {
  std::uint64_t key = 0;
  for (const Balls& s : slabs()) {
    for (const Vec3& x : points_around(s, key++)) {
      const PrimitiveHit hit = closest_on_slab(x, s[0], s[1], s[2]);
      EXPECT_NEAR(hit.weights[0] + hit.weights[1] + hit.weights[2], 1, 1e-12);
      EXPECT_GE(*std::min_element(hit.weights.begin(), hit.weights.end()), 0);
      EXPECT_NEAR(distance_to_ball(x, ball_at(s[0], s[1], s[2], hit.weights)), hit.distance, 1e-12);
    }
  }
}

/// The hull is the intersection of the half-spaces u . y <= max (u . c_i + r_i); the signed distance is the greatest
/// excess of x over one of them. Found on a lattice of directions, then by random search around the best one.
double twin_hull_distance(const Vec3& x, const Balls& s) {
  const auto excess = [&](const Vec3& u) {
    double least = std::numeric_limits<double>::infinity();
    for (const Ball& ball : s) least = std::min(least, dot(u, x - ball.center) - ball.radius);
    return least;
  };
  constexpr int kDirections = 2000, kTrials = 6000;
  Vec3 best{0, 0, 1};
  for (int k = 0; k < kDirections; ++k) {  // Fibonacci lattice
    const double z = 1 - (2 * k + 1.0) / kDirections, angle = 2 * std::numbers::pi * std::numbers::phi * k;
    const double circle = std::sqrt(1 - z * z);
    const Vec3 u{circle * std::cos(angle), circle * std::sin(angle), z};
    if (excess(u) > excess(best)) best = u;
  }
  KeyedRandom random(4, 4, 0);
  for (int trial = 0; trial < kTrials; ++trial) {
    const Vec3 u = normalized(best + random_point(random, 0.1 * std::pow(0.998, trial)));
    if (excess(u) > excess(best)) best = u;
  }
  return excess(best);
}

// Inside too: so that it is the true depth and not only the room in the ball found.
TEST(Primitives, DistanceIsThatOfTheConvexHull) {
  std::uint64_t key = 0;
  for (const Balls& s : slabs()) {
    for (const Vec3& x : points_around(s, key++)) {
      const double exact = closest_on_slab(x, s[0], s[1], s[2]).distance;
      const double twin = twin_hull_distance(x, s);
      EXPECT_LE(twin, exact + 1e-12);
      EXPECT_NEAR(twin, exact, 1e-3);
    }
  }
}

TEST(Primitives, ABallInsideTheHullOfTheOthersDoesNotMatter) {
  for (std::uint64_t k = 0; k < 50; ++k) {
    KeyedRandom random(3, 3, k);
    Balls s = random_balls(random, 0.5);
    s[2] = ball_at(s[0], s[1], s[1], {0.5, 0.5, 0});
    s[2].center += random_point(random, 0.2 * s[2].radius);
    s[2].radius *= 0.5;
    for (int p = 0; p < 20; ++p) {
      const Vec3 x = random_point(random, 2);
      const double cone = closest_on_cone(x, s[0], s[1]).distance;
      EXPECT_NEAR(closest_on_slab(x, s[0], s[1], s[2]).distance, cone, 1e-12);
      EXPECT_NEAR(closest_on_slab(x, s[2], s[0], s[1]).distance, cone, 1e-12);
    }
  }
}

TEST(Primitives, CapsuleInClosedForm) {
  const Ball a{{0, 0, 0}, 1}, b{{4, 0, 0}, 1};
  EXPECT_DOUBLE_EQ(closest_on_cone({2, 3, 0}, a, b).distance, 2);
  EXPECT_DOUBLE_EQ(closest_on_cone({7, 4, 0}, a, b).distance, 4);
  EXPECT_DOUBLE_EQ(closest_on_cone({1, 0, 0.25}, a, b).distance, -0.75);
  EXPECT_DOUBLE_EQ(closest_on_cone({-0.5, 0, 0}, a, b).distance, -0.5);
}

TEST(Primitives, ConeFromAPointInClosedForm) {
  // Half opening angle asin(3/5): the tangent from the apex touches the ball at distance 4.
  const Ball apex{{0, 0, 0}, 0}, base{{5, 0, 0}, 3};
  EXPECT_NEAR(closest_on_cone({0, 5, 0}, apex, base).distance, 4, 1e-12);
  EXPECT_NEAR(closest_on_cone({2, 0, 0}, apex, base).distance, -1.2, 1e-12);
  const auto side = cone_side(apex, base);
  ASSERT_TRUE(side);
  EXPECT_NEAR(side->along, -0.6, 1e-15);
  EXPECT_NEAR(side->across, 0.8, 1e-15);
  EXPECT_NEAR(side->area, std::numbers::pi * 2.4 * 4, 1e-12);  // cone of radius 2.4, slant 4
}

TEST(Primitives, ConeSideTouchesTheBoundaryOfTheCone) {
  for (const Balls& s : slabs()) {
    const auto side = cone_side(s[0], s[1]);
    const double length = distance(s[0].center, s[1].center);
    ASSERT_EQ(side.has_value(), length > std::abs(s[0].radius - s[1].radius));
    if (!side) continue;
    EXPECT_NEAR(side->along * side->along + side->across * side->across, 1, 1e-12);
    const Vec3 across = normalized(cross(side->axis, std::abs(side->axis.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    for (const double w : {0.0, 0.3, 1.0}) {
      const Ball ball = ball_at(s[0], s[1], s[1], {1 - w, w, 0});
      const Vec3 x = ball.center + (side->axis * side->along + across * side->across) * ball.radius;
      EXPECT_NEAR(closest_on_cone(x, s[0], s[1]).distance, 0, 1e-12);
    }
  }
}

TEST(Primitives, SlabPlanesAreTangentToAllThreeBalls) {
  int found = 0;
  for (const Balls& s : slabs()) {
    const auto normals = slab_normals(s[0], s[1], s[2]);
    if (!normals) continue;
    ++found;
    const double shape = triangle_area(s[0].center, s[1].center, s[2].center);
    const double slack = 1e-12 / std::max(shape, 1e-12);
    for (const Vec3& n : *normals) {
      EXPECT_NEAR(norm(n), 1, slack);
      for (const Ball& ball : s) EXPECT_NEAR(dot(n, ball.center - s[0].center) + ball.radius, s[0].radius, slack);
    }
    EXPECT_GE(dot((*normals)[0], cross(s[1].center - s[0].center, s[2].center - s[0].center)), 0);
  }
  EXPECT_GT(found, 30);
}

TEST(Primitives, SlabPlanesAreMissingExactlyWhereNoneExist) {
  EXPECT_TRUE(slab_normals({{0, 0, 0}, 0.5}, {{1, 0, 0}, 0.5}, {{0, 1, 0}, 0.5}));
  EXPECT_FALSE(slab_normals({{0, 0, 0}, 2}, {{1, 0, 0}, 0.5}, {{0, 1, 0}, 0.5}));
  EXPECT_FALSE(slab_normals({{0, 0, 0}, 1}, {{1, 0, 0}, 1}, {{2, 0, 0}, 1}));
}

TEST(Primitives, TriangleDistanceInClosedForm) {
  const Vec3 a{0, 0, 0}, b{4, 0, 0}, c{0, 3, 0};
  EXPECT_DOUBLE_EQ(closest_on_triangle({1, 1, 2}, a, b, c).distance, 2);
  EXPECT_DOUBLE_EQ(closest_on_triangle({2, -3, 4}, a, b, c).distance, 5);
  EXPECT_DOUBLE_EQ(closest_on_triangle({-3, -4, 0}, a, b, c).distance, 5);
  EXPECT_NEAR(closest_on_triangle({2 + 3, 1.5 + 4, 0}, a, b, c).distance, 5, 1e-12);  // from the hypotenuse
  EXPECT_DOUBLE_EQ(closest_on_triangle({2, 1, 0}, a, b, {2, 0, 0}).distance, 1);      // a segment
  EXPECT_DOUBLE_EQ(closest_on_triangle({3, 4, 0}, a, a, a).distance, 5);              // a point
}

}  // namespace
}  // namespace matstruct
