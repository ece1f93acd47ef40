// The angle between faces, from their facets: prisms with a crease between two faces of known curvature, and cylinders.
#include "query/face_angle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "base/index.h"
#include "geometry/exact.h"
#include "prepare/boundary.h"

namespace matstruct {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSmooth = 30 * kDegree;

/// A closed surface with what the angles need.
struct Faceted {
  explicit Faceted(TriSurface given) : surface(std::move(given)) {
    neighbors = match_triangles(surface.triangles, count(surface.vertices),
                                [](Index v) { return "vertex " + std::to_string(v); });
    for (const Triangle& t : surface.triangles)
      normals.push_back(
          triangle_normal(surface.vertices[uz(t[0])], surface.vertices[uz(t[1])], surface.vertices[uz(t[2])]));
  }
  // Of the edge ab, in degrees.
  double facets(Index a, Index b) const {
    const auto [t, k] = side(a, b);
    return 180 - dihedral_angle(surface, neighbors, normals, t, k) / kDegree;
  }
  double faces(Index a, Index b) const {
    const auto [t, k] = side(a, b);
    return face_turn(surface, neighbors, normals, t, k, kSmooth) / kDegree;
  }
  bool stands_out(Index a, Index b) const {
    const auto [t, k] = side(a, b);
    return matstruct::stands_out(surface, neighbors, normals, t, k, kSmooth);
  }

  double height(Index a, Index b) const {
    const auto [t, k] = side(a, b);
    return edge_height(surface, neighbors, normals, t, k, kSmooth);
  }

  TriSurface surface;
  std::vector<std::array<Index, 3>> neighbors;
  std::vector<Vec3> normals;

 private:
  std::pair<Index, std::size_t> side(Index a, Index b) const {
    for (Index t = 0; t < count(surface.triangles); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (surface.triangles[uz(t)][(k + 1) % 3] == a && surface.triangles[uz(t)][(k + 2) % 3] == b) return {t, k};
    ADD_FAILURE() << "no edge " << a << ' ' << b;
    return {0, 0};
  }
};

// A tube of rings of `n` points each, anticlockwise and upwards, closed by fans; diagonals as `flip` says.
template <class Flip>
Faceted tube(std::vector<Vec3> rings, Index n, const Flip& flip) {
  const Index last = count(rings) - n, bottom = count(rings), top = bottom + 1;
  Vec3 low, high;
  for (Index k = 0; k < n; ++k) low += rings[uz(k)] / n, high += rings[uz(last + k)] / n;
  rings.push_back(low);
  rings.push_back(high);
  TriSurface surface{std::move(rings), {}};
  for (Index r = 0; r < last; r += n)
    for (Index k = 0; k < n; ++k) {
      const Index a = r + k, b = r + (k + 1) % n, c = a + n, d = b + n;
      if (flip())
        surface.triangles.insert(surface.triangles.end(), {{a, b, c}, {b, d, c}});
      else
        surface.triangles.insert(surface.triangles.end(), {{a, b, d}, {a, d, c}});
    }
  for (Index k = 0; k < n; ++k)
    surface.triangles.insert(surface.triangles.end(), {{(k + 1) % n, k, bottom}, {last + k, last + (k + 1) % n, top}});
  return Faceted(std::move(surface));
}

/// One side of a crease: a face that turns by `step` degrees from strip to strip, positive if hollow.
struct Side {
  double step = 0;
  double width = 1;
};
constexpr Index kStrips = 5, kProfile = 2 * kStrips + 2;

// Where the face of a side is at arc length `s` from a crease that turns by `turn` degrees: x outward, y up.
Vec3 on_side(const Side& side, double turn, double s) {
  const double begin = -turn / 2 * kDegree, bend = side.step * kDegree / side.width;
  if (bend == 0) return {s * std::cos(begin), s * std::sin(begin), 0};
  return {(std::sin(begin + bend * s) - std::sin(begin)) / bend, (std::cos(begin) - std::cos(begin + bend * s)) / bend,
          0};
}

// A prism whose vertex 0 of each ring of kProfile is a crease between two faces. Inner points of the faces are moved
// along them by up to `uneven` of a strip, and diagonals are random then.
Faceted creased(double turn, const Side& left, const Side& right, Index rows, double uneven = 0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-uneven, uneven);
  std::vector<Vec3> rings;
  for (Index r = 0; r <= rows; ++r) {
    const Vec3 up{0, 0, static_cast<double>(r)};
    const auto place = [&](const Side& side, Index k) {
      return side.width * (k + (r > 0 && r < rows && k < kStrips ? shift(random) : 0));
    };
    rings.push_back(up);
    for (Index k = 1; k <= kStrips; ++k) {
      const Vec3 p = on_side(left, turn, place(left, k));
      rings.push_back(Vec3{-p.x, p.y, 0} + up);
    }
    rings.push_back(Vec3{0, -20, 0} + up);
    for (Index k = kStrips; k > 0; --k) rings.push_back(on_side(right, turn, place(right, k)) + up);
  }
  return tube(std::move(rings), kProfile, [&] { return uneven > 0 && random() % 2 == 0; });
}

TEST(FaceAngle, CreasesBetweenCurvedFacesHaveTheirTrueAngle) {
  for (const double turn : {20.0, 32.0, 50.0, 90.0})
    for (const Side& left : {Side{0, 2}, Side{12, 1}, Side{-12, 1}, Side{25, 0.3}})
      for (const Side& right : {Side{0, 1}, Side{6, 0.7}, Side{-20, 0.7}}) {
        SCOPED_TRACE(testing::Message() << turn << ' ' << left.step << ' ' << right.step);
        const Faceted f = creased(turn, left, right, 1);
        EXPECT_NEAR(f.facets(0, kProfile), turn - (left.step + right.step) / 2, 1e-9);
        // The estimate may count for the edge by a twentieth of what it adds.
        EXPECT_GE(f.faces(0, kProfile), turn - 1e-9);
        EXPECT_LE(f.faces(0, kProfile), turn + 0.05 * std::abs(left.step + right.step) / 2 + 1e-9);
      }
}

TEST(FaceAngle, SmoothFacesDoNotTurn) {
  for (const double step : {5.0, -5.0, 20.0, -20.0}) {
    const Faceted f = creased(-step, {step}, {step}, 1);
    EXPECT_NEAR(f.facets(0, kProfile), -step * 2, 1e-9);
    EXPECT_LE(std::abs(f.faces(0, kProfile) + step), 0.05 * std::abs(step) + 1e-9);
    const Faceted even = creased(0, {step}, {step}, 1);
    EXPECT_NEAR(even.facets(0, kProfile), -step, 1e-9);
    EXPECT_LE(std::abs(even.faces(0, kProfile)), 0.05 * std::abs(step) + 1e-9);
  }
}

TEST(FaceAngle, UnevenTessellationsComeNearTheTrueAngleOrStayAsTheyAre) {
  Index near = 0, all = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Faceted f = creased(32, {12}, {9}, 12, 0.15, seed);
    for (Index r = 1; r + 1 < 12; ++r) {
      const Index a = r * kProfile, b = a + kProfile;
      const double before = std::abs(f.facets(a, b) - 32), after = std::abs(f.faces(a, b) - 32);
      EXPECT_LE(after, before + 1);
      near += after < 1.5;
      ++all;
    }
  }
  EXPECT_GT(near, all / 2);
}

TEST(FaceAngle, FlatAndSharpStripsAddNothing) {
  // The strips behind are a plane, or are faces of their own.
  for (const double step : {0.0, 31.0}) {
    const Faceted f = creased(28, {step}, {step}, 1);
    EXPECT_NEAR(f.faces(0, kProfile), f.facets(0, kProfile), 1e-9);
  }
}

TEST(FaceAngle, EdgesOfARoundingDoNotStandOut) {
  for (const double other : {0.0, 12.0, -12.0, 31.0}) {
    // Facets turn by 32 - (12 + other) / 2 at the crease.
    EXPECT_TRUE(creased(32, {12}, {other}, 1).stands_out(0, kProfile)) << other;
    EXPECT_TRUE(creased(-32, {-12}, {other}, 1).stands_out(0, kProfile)) << other;
    EXPECT_FALSE(creased(0, {-28}, {-28}, 1).stands_out(0, kProfile));
    EXPECT_FALSE(creased(10, {-20}, {other}, 1).stands_out(0, kProfile)) << other;
  }
}

TEST(FaceAngle, TheHeightOfAnEdgeDoesNotDependOnTheTriangles) {
  for (const double turn : {4.0, 20.0, -25.0}) {
    const double whole = kStrips * std::sin(std::abs(turn) / 2 * kDegree);
    for (const Index rows : {1, 3, 8})
      EXPECT_NEAR(creased(turn, {0, 1}, {0, 1}, rows).height(0, kProfile), whole, 1e-9) << turn << ' ' << rows;
  }
  // Facets that turn by 17 degrees at the crease and by 4 behind: the third ones are turned by 8.
  EXPECT_NEAR(creased(21, {4, 1}, {4, 1}, 2).height(0, kProfile), 3 * std::sin(8.5 * kDegree), 0.01);
}

TEST(FaceAngle, CylindersCutByAPlane) {
  for (const Index n : {24, 37, 90})
    for (const double slope : {0.0, 30.0, 70.0}) {
      std::vector<Vec3> rings;
      for (const bool upper : {false, true})
        for (Index k = 0; k < n; ++k) {
          const double angle = 2 * std::numbers::pi * k / n;
          rings.push_back(
              {std::cos(angle), std::sin(angle), upper ? 5 - std::tan(slope * kDegree) * std::cos(angle) : -5});
        }
      const Faceted f = tube(std::move(rings), n, [] { return false; });
      for (Index k = 0; k < n; ++k) {
        const double angle = 2 * std::numbers::pi * (k + 0.5) / n;
        const double turn = std::acos(std::sin(slope * kDegree) * std::cos(angle)) / kDegree;
        EXPECT_NEAR(f.faces(n + k, n + (k + 1) % n), turn, 0.5) << n << ' ' << slope << ' ' << k;
      }
    }
}

}  // namespace
}  // namespace matstruct
