// Pins: spacing, coverage, fans on concave lines, and that threads do not matter.
#include "spheres/pins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "base/index.h"
#include "shapes.h"

namespace matstruct {
namespace {

Domain prepare(const TetMesh& mesh) {
  Context context;
  return prepare_domain(mesh, {}, context);
}

bool same(const std::vector<Pin>& a, const std::vector<Pin>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Pin& p, const Pin& q) {
    return p.point == q.point && p.normal == q.normal && p.triangle == q.triangle;
  });
}

double nearest_pin(const std::vector<Pin>& pins, const Vec3& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const Pin& pin : pins) best = std::min(best, distance(pin.point, p));
  return best;
}

TEST(SampleSurface, PinsKeepTheirDistanceAndCoverTheSurface) {
  std::mt19937_64 random(1);
  const auto uniform = [&] { return std::uniform_real_distribution<double>()(random); };
  for (const shapes::Shape& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const Domain domain = prepare(shape.mesh);
    const double spacing = domain.diagonal / 15;
    const std::vector<Pin> pins = sample_surface(domain, spacing, 1, {});
    for (std::size_t i = 0; i < pins.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) ASSERT_GE(distance(pins[i].point, pins[j].point), spacing);
    }
    for (int i = 0; i < 500; ++i) {
      const Triangle& t = domain.surface.triangles[random() % domain.surface.triangles.size()];
      const auto corner = [&](std::size_t k) { return domain.surface.vertices[uz(t[k])]; };
      const Vec3 p = lerp(lerp(corner(0), corner(1), uniform()), corner(2), uniform());
      // Every candidate lies within the spacing of a pin; a third of it is the gap between candidates.
      ASSERT_LT(nearest_pin(pins, p), 1.33 * spacing);
    }
  }
}

TEST(SampleSurface, PinsLieOnTheirTrianglesWithTheirNormals) {
  const Domain domain = prepare(shapes::torus(3, 1, 24, 16));
  for (const Pin& pin : sample_surface(domain, domain.diagonal / 30, 2, {})) {
    EXPECT_LT(domain.query.closest(pin.point).distance2, 1e-30);
    EXPECT_EQ(pin.normal, domain.triangle_normals[uz(pin.triangle)]);
    const Vec3& corner = domain.surface.vertices[uz(domain.surface.triangles[uz(pin.triangle)][0])];
    EXPECT_NEAR(dot(pin.normal, pin.point - corner), 0, 1e-15);
  }
}

TEST(SampleSurface, DensityIsThatOfDartThrowingWhateverTheTriangles) {
  // Random sequential packing of disks of radius s / 2 covers 0.547 of the plane, 0.70 pins in a square of side s; with
  // the finite number of candidates it ends somewhat earlier.
  for (const int cells : {1, 7, 40}) {
    const Domain domain = prepare(shapes::box({1, 1, 1}, cells, cells, 1));
    const double side = domain.frame.scale, spacing = side / 40;
    const double pins = static_cast<double>(sample_surface(domain, spacing, 3, {}).size());
    EXPECT_NEAR(pins * spacing * spacing / (6 * side * side), 0.58, 0.03);
  }
}

TEST(SampleSurface, DependsOnTheSeedAndNotOnTheThreads) {
  const Domain domain = prepare(shapes::l_profile());
  Context one, four;
  one.threads = 1, four.threads = 4;
  const double spacing = domain.diagonal / 40;
  const std::vector<Pin> pins = sample_surface(domain, spacing, 7, one);
  EXPECT_TRUE(same(pins, sample_surface(domain, spacing, 7, four)));
  EXPECT_FALSE(same(pins, sample_surface(domain, spacing, 8, one)));
}

TEST(SampleConcaveLines, EveryStretchHasAFanBetweenTheFaceNormals) {
  const double length = 3, spacing = 0.11, step = 0.3;
  const Domain domain = prepare(shapes::l_profile(length));
  std::vector<Pin> pins = sample_concave_lines(domain, spacing * domain.frame.scale, step);
  const int fan = 1 + static_cast<int>(std::ceil(0.5 * std::numbers::pi / step));
  const int total = fan * static_cast<int>(std::ceil(length / spacing));
  ASSERT_EQ(count(pins), total);
  for (Pin& pin : pins) {
    EXPECT_LT(domain.query.closest_on(pin.triangle, pin.point).distance2, 1e-30);
    pin = {domain.frame.to_input(pin.point), domain.frame.turned_back(pin.normal), pin.triangle};
  }
  std::sort(pins.begin(), pins.end(), [](const Pin& a, const Pin& b) { return a.point.z < b.point.z; });
  for (int k = 0; k < total; ++k) {
    const Pin& pin = pins[uz(k)];
    EXPECT_NEAR(distance(pin.point, {1, 1, length * (k + 0.5) / total}), 0, 1e-13);  // at equal arc lengths
    EXPECT_NEAR(norm(pin.normal), 1, 1e-15);
    EXPECT_NEAR(pin.normal.z, 0, 1e-15);
    EXPECT_GE(std::min(pin.normal.x, pin.normal.y), -1e-15);
  }
  for (int first = 0; first + fan <= total; ++first) {
    std::vector<double> angles{0, 0.5 * std::numbers::pi};
    for (int k = first; k < first + fan; ++k) angles.push_back(std::atan2(pins[uz(k)].normal.y, pins[uz(k)].normal.x));
    std::sort(angles.begin(), angles.end());
    for (std::size_t k = 1; k < angles.size(); ++k) EXPECT_LT(angles[k] - angles[k - 1], 2 * step);
  }
}

TEST(SampleConcaveLines, AreNoneOnConvexSolids) {
  EXPECT_TRUE(sample_concave_lines(prepare(shapes::box({1, 2, 3})), 0.01, 0.1).empty());
}

TEST(SampleConcaveLines, EveryLineHasItsFanHoweverShort) {
  const Domain domain = prepare(shapes::plate_with_hole());  // four concave lines: the upright edges of the hole
  EXPECT_EQ(sample_concave_lines(domain, 10, 10).size(), 4u * 2u);
}

}  // namespace
}  // namespace matstruct
