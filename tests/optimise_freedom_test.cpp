// Ranks, free directions and solutions of spherical quadrics.
#include "optimise/freedom.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/index.h"
#include "base/random.h"

namespace matstruct {
namespace {

/// Samples of one cell in clusters, around a sphere at `center` of radius r that they all touch.
struct Cell {
  VolumeSamples samples;
  CellContacts contacts{{0, 0}, {}, {0}, {}, {}};
  Vec3 center{0.3, -0.2, 0.7};
  double radius = 0.05;

  void add_cluster(const std::vector<std::pair<Vec3, Vec3>>& feet_and_normals) {
    for (const auto& [foot, normal] : feet_and_normals) {
      contacts.members.push_back(count(samples.samples));
      samples.samples.push_back({foot - 0.5 * radius * normal, foot, normal, 0, 0, kInvalid, 1});
    }
    contacts.member_start.push_back(count(contacts.members));
    contacts.clusters.push_back({});
    ++contacts.start[1];
  }
  /// Feet scattered over the plane with outward normal n that touches the sphere.
  void add_plane(const Vec3& n, std::uint64_t key = 0) {
    KeyedRandom random(3, key, 0);
    const auto [u, v] = orthonormal_to(normalized(n));
    std::vector<std::pair<Vec3, Vec3>> feet;
    for (int k = 0; k < 10; ++k)
      feet.emplace_back(center + radius * (normalized(n) + u * (random.uniform() - 0.5) + v * (random.uniform() - 0.5)),
                        normalized(n));
    add_cluster(feet);
  }
  SphereFreedom freedom(const Ball& sphere, std::vector<std::int8_t> most = {}) const {
    return sphere_freedoms(samples, contacts, std::vector<Ball>{sphere}, most, {}, {}).front();
  }
  SphereFreedom freedom() const { return freedom({center, radius}); }
};

Vec3 at_angle(double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  return {std::cos(a), std::sin(a), 0};
}

void expect_equal(const Projector& a, const Projector& b, double tolerance) {
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << k;
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_LE(distance(a, b), tolerance);
}

TEST(Freedom, RanksOfPlanesAreExact) {
  Cell cell;
  EXPECT_EQ(cell.freedom().kind, Freedom::kLost);  // no sample
  cell.add_plane(at_angle(0));
  EXPECT_EQ(cell.freedom().kind, Freedom::kLost);
  EXPECT_EQ(cell.freedom().free, kNoDirection);
  cell.add_plane(at_angle(120));
  EXPECT_EQ(cell.freedom().kind, Freedom::kPlane);
  expect_equal(cell.freedom().free, across(normalized(at_angle(0) - at_angle(120))), 1e-14);
  cell.add_plane(at_angle(240));
  EXPECT_EQ(cell.freedom().kind, Freedom::kLine);
  expect_equal(cell.freedom().free, along({0, 0, 1}), 1e-14);
  cell.add_plane({0, 0, 1});
  EXPECT_EQ(cell.freedom().kind, Freedom::kFixed);
  EXPECT_EQ(cell.freedom().free, kNoDirection);
  cell.add_plane({0, 0, -1});  // a junction of higher order
  EXPECT_EQ(cell.freedom().kind, Freedom::kFixed);
}

TEST(Freedom, PlanesThatAreNearlyOneGiveNoRank) {
  for (const double angle : {5.0, 20.0}) {
    Cell cell;
    cell.add_plane(at_angle(0));
    cell.add_plane(at_angle(angle));
    EXPECT_EQ(cell.freedom().kind, angle < 12 ? Freedom::kLost : Freedom::kPlane) << angle;
  }
  // The same three planes again are three planes.
  Cell cell;
  for (int k = 0; k < 6; ++k) cell.add_plane(at_angle(120 * k), static_cast<std::uint64_t>(k));
  EXPECT_EQ(cell.freedom().kind, Freedom::kLine);
}

TEST(Freedom, CurvedContactsFakeNoRank) {
  // Two opposite caps of 40 degrees: the samples alone have rank 4, the sphere is on a sheet.
  Cell cell;
  for (const double side : {1.0, -1.0}) {
    std::vector<std::pair<Vec3, Vec3>> feet;
    for (int k = 0; k < 40; ++k) {
      const double turn = 2 * std::numbers::pi * k / 40, tilt = 20 * std::numbers::pi / 180;
      const Vec3 n = {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), side * std::cos(tilt)};
      feet.emplace_back(cell.center + n * cell.radius, n);
    }
    cell.add_cluster(feet);
  }
  EXPECT_EQ(cell.freedom().kind, Freedom::kPlane);
  expect_equal(cell.freedom().free, across({0, 0, 1}), 1e-14);

  Cell one;  // negative control: as one cluster, which counts as bent, the samples' rank shows
  std::vector<std::pair<Vec3, Vec3>> all;
  for (const VolumeSample& s : cell.samples.samples) all.emplace_back(s.foot, s.normal);
  one.add_cluster(all);
  EXPECT_EQ(one.freedom().kind, Freedom::kFixed);
}

TEST(Freedom, RingAroundACylinderLeavesItsAxis) {
  Cell cell;
  std::vector<std::pair<Vec3, Vec3>> ring;
  KeyedRandom random(1, 1, 1);
  for (int k = 0; k < 60; ++k) {
    const Vec3 n = at_angle(360 * random.uniform());
    ring.emplace_back(cell.center + n * cell.radius + Vec3{0, 0, 0.1 * random.uniform()}, n);
  }
  cell.add_cluster(ring);
  EXPECT_EQ(cell.freedom().kind, Freedom::kLine);
  expect_equal(cell.freedom().free, along({0, 0, 1}), 1e-14);
  // Off the axis the solution comes back to it, at the same height.
  const SphereFreedom off = cell.freedom({cell.center + Vec3{0.01, -0.004, 0.02}, 0.04});
  expect_near(off.solution.center, cell.center + Vec3{0, 0, 0.02}, 1e-14);
  EXPECT_NEAR(off.solution.radius, cell.radius, 1e-14);
}

TEST(Freedom, EndOfASheetSlidesAlongTheEnd) {
  // At the rounded end of a plate the contacts are one cluster: an arc in the plane y = 0, along the boundary y.
  Cell cell;
  std::vector<std::pair<Vec3, Vec3>> arc;
  for (int k = -10; k <= 10; ++k) {
    const double angle = 0.04 * k;
    const Vec3 n{std::cos(angle), 0, std::sin(angle)};
    arc.emplace_back(cell.center + n * cell.radius + Vec3{0, 0.01 * (k % 3), 0}, n);
  }
  cell.add_cluster(arc);
  const SphereFreedom f = cell.freedom({cell.center, cell.radius}, {2});
  EXPECT_EQ(f.kind, Freedom::kLine);
  expect_equal(f.free, along({0, 1, 0}), 1e-12);
}

TEST(Freedom, RankIsBoundedByTheSpheresType) {
  Cell cell;
  for (const double angle : {0.0, 120.0, 240.0}) cell.add_plane(at_angle(angle));
  cell.add_plane({0, 0, 1});
  const Ball sphere{cell.center, cell.radius};
  EXPECT_EQ(cell.freedom(sphere, {4}).kind, Freedom::kFixed);
  EXPECT_EQ(cell.freedom(sphere, {3}).kind, Freedom::kLine);
  EXPECT_EQ(cell.freedom(sphere, {2}).kind, Freedom::kPlane);
}

TEST(Freedom, SolutionTouchesThePlanesByTheLeastMove) {
  Cell cell;
  const Ball off{cell.center + Vec3{0.01, 0.02, -0.015}, 0.03};
  cell.add_plane({0, 0, 1});
  cell.add_plane({0, 0, -1});
  SphereFreedom f = cell.freedom(off);  // half-way between the planes, straight above or below
  expect_near(f.solution.center, {off.center.x, off.center.y, cell.center.z}, 1e-14);
  EXPECT_NEAR(f.solution.radius, cell.radius, 1e-14);
  EXPECT_NEAR(f.error, 0, 1e-9);
  cell.add_plane({1, 0, 0});
  f = cell.freedom(off);
  expect_near(f.solution.center, {cell.center.x, off.center.y, cell.center.z}, 1e-14);
  cell.add_plane({0.6, 0.8, 0});
  f = cell.freedom(off);
  expect_near(f.solution.center, cell.center, 1e-13);
  EXPECT_NEAR(f.solution.radius, cell.radius, 1e-13);
  EXPECT_NEAR(f.error, 0, 1e-9);
}

TEST(Freedom, ConcaveLinesAreSeenFromTheSphere) {
  // The normals stored with samples on a concave line fan out; the sphere touches the line at one point.
  Cell cell;
  const Vec3 touch = cell.center + Vec3{0, 0, cell.radius};
  std::vector<std::pair<Vec3, Vec3>> fan;
  for (int k = -5; k <= 5; ++k) fan.emplace_back(touch, Vec3{std::sin(0.1 * k), 0, std::cos(0.1 * k)});
  cell.add_cluster(fan);
  for (VolumeSample& s : cell.samples.samples) s.line = 0;
  cell.add_plane({0, 0, -1});
  EXPECT_EQ(cell.freedom().kind, Freedom::kPlane);
  expect_equal(cell.freedom().free, across({0, 0, 1}), 1e-14);
  expect_near(cell.freedom().solution.center, cell.center, 1e-14);
}

TEST(Freedom, DoesNotDependOnPlaceOrScale) {
  Cell cell;
  cell.add_plane({0.3, 0.1, 0.9});
  cell.add_plane({-0.5, 0.2, -0.7});
  cell.add_plane({0.1, -0.9, 0.1});
  const SphereFreedom here = cell.freedom();
  for (const double scale : {1e-3, 1e3}) {
    Cell moved = cell;
    const Vec3 shift = scale * Vec3{10, -20, 30};
    for (VolumeSample& s : moved.samples.samples) s.foot = s.foot * scale + shift, s.point = s.point * scale + shift;
    const SphereFreedom there = moved.freedom({cell.center * scale + shift, cell.radius * scale});
    EXPECT_EQ(there.kind, here.kind);
    expect_equal(there.free, here.free, 1e-12);
    EXPECT_NEAR(there.solution.radius / scale, here.solution.radius, 1e-12);
  }
}

}  // namespace
}  // namespace matstruct
