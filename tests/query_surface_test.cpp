// SurfaceQuery against a twin that looks at every triangle, and against solids whose distance is known.
#include "query/surface_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <random>

#include "base/index.h"
#include "shapes.h"

namespace matstruct {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(random);
}
Vec3 random_point(Random& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

/// Quadruple precision, for a twin that rounds far less than what it checks.
using Quad = __float128;
using Quad3 = std::array<Quad, 3>;
Quad3 minus(const Quad3& a, const Quad3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Quad dot(const Quad3& a, const Quad3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Quad3 along(const Quad3& a, const Quad3& d, Quad t) {
  return {a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]};
}
Quad3 extended(const Vec3& p) {
  return {p.x, p.y, p.z};
}

Quad distance2_to_segment(const Quad3& p, const Quad3& a, const Quad3& b) {
  const Quad3 ab = minus(b, a);
  const Quad length2 = dot(ab, ab);
  const Quad t = length2 > 0 ? std::clamp<Quad>(dot(minus(p, a), ab) / length2, 0, 1) : 0;
  const Quad3 d = minus(p, along(a, ab, t));
  return dot(d, d);
}

/// The edges and, if the normal equations of the plane have their solution in the triangle, that one.
Quad distance2_to_triangle(const Quad3& p, const Quad3& a, const Quad3& b, const Quad3& c) {
  const Quad edges =
      std::min({distance2_to_segment(p, a, b), distance2_to_segment(p, b, c), distance2_to_segment(p, c, a)});
  const Quad3 e = minus(b, a), f = minus(c, a), d = minus(p, a);
  const Quad ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), de = dot(d, e), df = dot(d, f);
  const Quad det = ee * ff - ef * ef, v = ff * de - ef * df, w = ee * df - ef * de;
  if (!(det > 0 && v >= 0 && w >= 0 && v + w <= det)) return edges;
  const Quad3 off = minus(d, along(along({}, e, v / det), f, w / det));
  return std::min(edges, dot(off, off));
}

double distance_to_triangle(const TriSurface& surface, Index t, const Vec3& p) {
  const auto corner = [&](std::size_t k) { return extended(surface.vertices[uz(surface.triangles[uz(t)][k])]); };
  return std::sqrt(static_cast<double>(distance2_to_triangle(extended(p), corner(0), corner(1), corner(2))));
}

double brute_force_distance(const TriSurface& surface, const Vec3& p) {
  double best = std::numeric_limits<double>::infinity();
  for (Index t = 0; t < count(surface.triangles); ++t) best = std::min(best, distance_to_triangle(surface, t, p));
  return best;
}

/// Triangles of all sizes and shapes that share no vertices: also needles, caps, points.
TriSurface random_soup(Index triangles, std::uint64_t seed) {
  Random random(seed);
  TriSurface soup;
  for (Index t = 0; t < triangles; ++t) {
    const Vec3 a = random_point(random, 1);
    const double size = std::pow(10.0, uniform(random, -4, 0));
    Vec3 b = a + random_point(random, size), c = a + random_point(random, size);
    if (t % 7 == 1) c = lerp(a, b, uniform(random, -0.5, 1.5));                                 // no area
    if (t % 7 == 2) c = lerp(a, b, uniform(random, 0, 1)) + random_point(random, 1e-9 * size);  // nearly none
    if (t % 7 == 3) c = b;
    if (t % 49 == 4) b = c = a;
    const Index v = count(soup.vertices);
    soup.vertices.insert(soup.vertices.end(), {a, b, c});
    soup.triangles.push_back({v, v + 1, v + 2});
  }
  return soup;
}

std::vector<TriSurface> surfaces() {
  std::vector<TriSurface> result;
  for (const shapes::Shape& shape : shapes::all()) result.push_back(shapes::boundary(shape.mesh));
  for (const Index n : {1, 2, 4, 5, 33, 1000}) result.push_back(random_soup(n, static_cast<std::uint64_t>(n)));
  TriSurface flat = random_soup(300, 5);
  for (Vec3& p : flat.vertices) p.z = 0.25;
  result.push_back(flat);
  return result;
}

double size_of(const TriSurface& surface) {
  double size = 0;
  for (const Vec3& p : surface.vertices) size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return size;
}

/// Points around a surface: anywhere, far away, on it, and next to it.
std::vector<Vec3> points_around(const TriSurface& surface, Random& random) {
  const double size = size_of(surface);
  std::vector<Vec3> points;
  for (int i = 0; i < 60; ++i) points.push_back(random_point(random, 1.2 * size));
  for (int i = 0; i < 10; ++i) points.push_back(random_point(random, 1000 * size));
  for (int i = 0; i < 20; ++i) {
    const auto& t = surface.triangles[random() % surface.triangles.size()];
    const Vec3 on_edge = lerp(surface.vertices[uz(t[0])], surface.vertices[uz(t[1])], uniform(random, 0, 1));
    const Vec3 on_face = lerp(on_edge, surface.vertices[uz(t[2])], uniform(random, 0, 1));
    points.insert(points.end(), {surface.vertices[uz(t[2])], on_edge, on_face});
    points.push_back(on_face + random_point(random, 1e-6 * size));
  }
  return points;
}

TEST(SurfaceQuery, AgreesWithTheBruteForceTwin) {
  Random random(1);
  for (const TriSurface& surface : surfaces()) {
    const SurfaceQuery query(surface);
    for (const Vec3& p : points_around(surface, random)) {
      const SurfaceHit hit = query.closest(p);
      const double exact = brute_force_distance(surface, p);
      // Coordinates are rounded relative to the size of the surface, distances relative to themselves.
      ASSERT_NEAR(std::sqrt(hit.distance2), exact, 1e-14 * (exact + size_of(surface)));
      ASSERT_EQ(hit.distance2, distance2(p, hit.point));
    }
  }
}

TEST(SurfaceQuery, TheHitLiesOnTheTriangleItNames) {
  Random random(2);
  for (const TriSurface& surface : surfaces()) {
    const SurfaceQuery query(surface);
    for (const Vec3& p : points_around(surface, random)) {
      const SurfaceHit hit = query.closest(p);
      ASSERT_GE(hit.triangle, 0);
      ASSERT_LT(distance_to_triangle(surface, hit.triangle, hit.point), 1e-15 * size_of(surface));
    }
  }
}

TEST(SurfaceQuery, AGuessNeverChangesTheAnswer) {
  Random random(3);
  for (const TriSurface& surface : surfaces()) {
    const SurfaceQuery query(surface);
    for (const Vec3& p : points_around(surface, random)) {
      const SurfaceHit hit = query.closest(p);
      const Index any = static_cast<Index>(random() % surface.triangles.size());
      for (const Index guess : {hit.triangle, any, kInvalid, count(surface.triangles)}) {
        const SurfaceHit again = query.closest_near(p, guess);
        ASSERT_EQ(again.triangle, hit.triangle);
        ASSERT_EQ(again.point, hit.point);
      }
    }
  }
}

TEST(SurfaceQuery, NothingIsFoundBeyondTheBound) {
  const SurfaceQuery query(shapes::boundary(shapes::box({1, 1, 1})));
  EXPECT_EQ(query.closest({0.5, 0.5, 3}, 3.99).triangle, kInvalid);
  EXPECT_NE(query.closest({0.5, 0.5, 3}, 4).triangle, kInvalid);
  EXPECT_EQ(query.closest({0.5, 0.5, 3}, 4).distance2, 4);
}

TEST(SurfaceQuery, SharedVerticesAndEdgesNameTheLeastTriangle) {
  const TriSurface box = shapes::boundary(shapes::box({1, 1, 1}, 4, 4, 4));
  const SurfaceQuery query(box);
  for (Index v = 0; v < count(box.vertices); ++v) {
    const auto has = [&](const Triangle& t) { return std::find(t.begin(), t.end(), v) != t.end(); };
    const auto first = std::find_if(box.triangles.begin(), box.triangles.end(), has);
    if (first == box.triangles.end()) continue;  // inside the box
    EXPECT_EQ(query.closest(box.vertices[uz(v)]).triangle, first - box.triangles.begin());
  }
  for (const Triangle& t : box.triangles) {
    const Vec3 middle = (box.vertices[uz(t[0])] + box.vertices[uz(t[1])]) * 0.5;
    const auto has = [&](const Triangle& u) {
      return std::count(u.begin(), u.end(), t[0]) + std::count(u.begin(), u.end(), t[1]) == 2;
    };
    const auto first = std::find_if(box.triangles.begin(), box.triangles.end(), has);
    EXPECT_EQ(query.closest(middle).triangle, first - box.triangles.begin());
  }
}

TEST(SurfaceQuery, EmptySurfaceHasNoClosestPoint) {
  EXPECT_EQ(SurfaceQuery(TriSurface{}).closest({}).triangle, kInvalid);
}

TEST(SurfaceQuery, EqualTrianglesGoToTheLeastId) {
  TriSurface pile{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {}};
  for (int i = 0; i < 500; ++i) pile.triangles.push_back({0, 1, 2});
  EXPECT_EQ(SurfaceQuery(pile).closest({0.2, 0.2, 1}).triangle, 0);
}

/// Distance to the boundary of the box [0, size], negative inside.
double box_distance(const Vec3& p, const Vec3& size) {
  const Vec3 half = size * 0.5;
  const Vec3 q{std::abs(p.x - half.x) - half.x, std::abs(p.y - half.y) - half.y, std::abs(p.z - half.z) - half.z};
  return norm(max(q, {})) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

TEST(SurfaceQuery, SignedDistanceOfABox) {
  const Vec3 size{1, 2, 3};
  const SurfaceQuery query(shapes::boundary(shapes::box(size, 2, 3, 4)));
  Random random(4);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = random_point(random, 4);
    EXPECT_NEAR(query.signed_distance(p), box_distance(p, size), 1e-14);
    EXPECT_EQ(query.inside(p), box_distance(p, size) < 0);
  }
}

/// Winding number of a closed surface around p, by solid angles (van Oosterom & Strackee 1983).
double winding_number(const TriSurface& surface, const Vec3& p) {
  double sum = 0;
  for (const Triangle& t : surface.triangles) {
    const Vec3 a = surface.vertices[uz(t[0])] - p, b = surface.vertices[uz(t[1])] - p,
               c = surface.vertices[uz(t[2])] - p;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    sum += 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

TEST(SurfaceQuery, InsideAgreesWithTheWindingNumber) {
  Random random(5);
  for (const shapes::Shape& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const TriSurface surface = shapes::boundary(shape.mesh);
    const SurfaceQuery query(surface);
    for (int i = 0; i < 500; ++i) {
      const Vec3 p = random_point(random, 1.1 * size_of(surface));
      ASSERT_EQ(query.inside(p), winding_number(surface, p) > 0.5);
    }
  }
}

TEST(SurfaceQuery, SpikesDoNotFoolTheSign) {
  // Seen from beyond its tip, the plain face normals of a skew spike disagree about the side.
  const TetMesh spike =
      shapes::convex({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 3, 9}}, {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  const TriSurface surface = shapes::boundary(spike);
  const SurfaceQuery query(surface);
  Random random(6);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = Vec3{3, 3, 9} + random_point(random, 0.5);
    ASSERT_EQ(query.inside(p), winding_number(surface, p) > 0.5);
  }
}

}  // namespace
}  // namespace matstruct
