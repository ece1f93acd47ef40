// merge_flat_regions(): the same triangles for every triangulation of a shape, and the shape itself.
#include "prepare/flat_regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <vector>

#include "base/index.h"
#include "prepare/domain.h"
#include "prepare/tetrahedralise.h"
#include "shapes.h"

namespace matstruct {
namespace {

TriSurface used(const TriSurface& surface) {
  TriSurface result;
  std::map<Index, Index> id;
  for (Triangle t : surface.triangles) {
    for (Index& v : t) {
      const auto [at, fresh] = id.try_emplace(v, count(result.vertices));
      if (fresh) result.vertices.push_back(surface.vertices[uz(v)]);
      v = at->second;
    }
    result.triangles.push_back(t);
  }
  return result;
}

// Every triangle cut in four at the middles of its edges.
TriSurface cut_in_four(const TriSurface& surface) {
  TriSurface result{.vertices = surface.vertices, .triangles = {}};
  std::map<Edge, Index> middles;
  const auto middle = [&](Index a, Index b) {
    const auto [at, fresh] = middles.try_emplace(ordered_edge(a, b), count(result.vertices));
    if (fresh) result.vertices.push_back((surface.vertices[uz(a)] + surface.vertices[uz(b)]) / 2);
    return at->second;
  };
  for (const auto& [a, b, c] : surface.triangles) {
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& t : {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})
      result.triangles.push_back(t);
  }
  return result;
}

// Some triangles cut in three at a point inside.
TriSurface cut_in_three(const TriSurface& surface, std::mt19937& random) {
  std::uniform_real_distribution<double> weight(0.1, 1);
  TriSurface result = surface;
  result.triangles.clear();
  for (const auto& [a, b, c] : surface.triangles) {
    if (weight(random) < 0.5) {
      result.triangles.push_back({a, b, c});
      continue;
    }
    const double u = weight(random), v = weight(random), w = weight(random);
    const Vec3 p = (surface.vertices[uz(a)] * u + surface.vertices[uz(b)] * v + surface.vertices[uz(c)] * w);
    const Index inside = count(result.vertices);
    result.vertices.push_back(p / (u + v + w));
    for (const Triangle& t : {Triangle{a, b, inside}, {b, c, inside}, {c, a, inside}}) result.triangles.push_back(t);
  }
  return result;
}

using Corners = std::array<std::array<double, 3>, 3>;

std::vector<Corners> merged(const TriSurface& surface, const std::vector<Edge>& kept = {}) {
  const auto flat = merge_flat_regions(surface, surface.vertices, kept);
  std::vector<Corners> result;
  if (!flat) return result;
  for (const Triangle& t : flat->triangles) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = surface.vertices[uz(flat->vertices[uz(t[k])])];
      corners[k] = {p.x, p.y, p.z};
    }
    result.push_back(corners);
  }
  return result;
}

double six_volumes(const std::vector<Corners>& triangles) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles)
    sum += dot(Vec3{a[0], a[1], a[2]}, cross(Vec3{b[0], b[1], b[2]}, Vec3{c[0], c[1], c[2]}));
  return sum;
}

TEST(FlatRegions, OfAGridBoxAreTheSixFaces) {
  const std::vector<Corners> triangles = merged(used(shapes::boundary(shapes::box({1, 2, 3}, 3, 4, 5))));
  EXPECT_EQ(triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(six_volumes(triangles), 36);
}

TEST(FlatRegions, DoNotDependOnTheTriangulation) {
  std::mt19937 random(7);
  for (const shapes::Shape& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const TriSurface surface = used(shapes::boundary(shape.mesh));
    const std::vector<Corners> once = merged(surface);
    ASSERT_FALSE(once.empty());
    EXPECT_LE(once.size(), surface.triangles.size());
    EXPECT_NEAR(six_volumes(once), 6 * shapes::volume(shape.mesh), 1e-12 * shapes::volume(shape.mesh));
    EXPECT_EQ(merged(cut_in_four(surface)), once);
    EXPECT_EQ(merged(cut_in_three(cut_in_three(surface, random), random)), once);
  }
}

TEST(FlatRegions, KeepWhatIsNotFlat) {
  TriSurface surface = used(shapes::boundary(shapes::box({1, 1, 1}, 2, 2, 2)));
  const auto middle = std::find_if(surface.vertices.begin(), surface.vertices.end(),
                                   [](const Vec3& p) { return p.x == 0.5 && p.y == 0.5 && p.z == 1; });
  ASSERT_NE(middle, surface.vertices.end());
  for (const double height : {1e-5, 1e-7}) {
    middle->z = 1 + height;
    EXPECT_GT(merged(surface).size(), 12u) << height;
  }
  middle->z = 1 + 1e-10;
  EXPECT_EQ(merged(surface).size(), 12u);
}

// Its corner lies on its longest side but for rounding, and its plane is that of neither face.
TEST(FlatRegions, LeaveOutANeedleBetweenTwoFaces) {
  TriSurface surface = used(shapes::boundary(shapes::box({1, 1, 1}, 1, 1, 1)));
  const auto point = [&](Index v) { return surface.vertices[uz(v)]; };
  // A triangle of the face z = 1 with a side on y = 1.
  const auto found = std::find_if(surface.triangles.begin(), surface.triangles.end(), [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](Index v) { return point(v).z == 1; }) &&
           std::count_if(t.begin(), t.end(), [&](Index v) { return point(v).y == 1; }) == 2;
  });
  ASSERT_NE(found, surface.triangles.end());
  while (point((*found)[2]).y == 1) std::rotate(found->begin(), found->begin() + 1, found->end());
  const auto [a, c, apex] = *found;
  const Index b = count(surface.vertices);
  surface.vertices.push_back((point(a) + point(c)) / 2 + Vec3{0, 1e-10, 1e-10});
  *found = {a, b, apex};
  surface.triangles.push_back({b, c, apex});
  surface.triangles.push_back({a, c, b});
  const std::vector<Corners> triangles = merged(surface);
  EXPECT_EQ(triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(six_volumes(triangles), 6);
}

TEST(FlatRegions, KeepKnownEdges) {
  const TriSurface surface = used(shapes::boundary(shapes::box({1, 1, 1}, 2, 2, 2)));
  // An edge from the middle of a face to the middle of a side of it.
  const auto at = [&](const Vec3& p) {
    return static_cast<Index>(std::find_if(surface.vertices.begin(), surface.vertices.end(),
                                           [&](const Vec3& q) { return distance(p, q) == 0; }) -
                              surface.vertices.begin());
  };
  const Index a = at({0.5, 0.5, 1}), b = at({0.5, 1, 1});
  ASSERT_LT(std::max(a, b), count(surface.vertices));
  const auto flat = merge_flat_regions(surface, surface.vertices, {ordered_edge(a, b)});
  ASSERT_TRUE(flat);
  EXPECT_EQ(flat->vertices.size(), 10u);
  const bool there = std::any_of(flat->triangles.begin(), flat->triangles.end(), [&](const Triangle& t) {
    const auto uses = [&](Index v) {
      return std::any_of(t.begin(), t.end(), [&](Index w) { return flat->vertices[uz(w)] == v; });
    };
    return uses(a) && uses(b);
  });
  EXPECT_TRUE(there);
}

TEST(FlatRegions, AreFilledAnew) {
  const TetMesh fine = shapes::box({1, 2, 3}, 3, 4, 5);
  Context context;
  const auto coarse = refill_merged(fine, context);
  ASSERT_TRUE(coarse);
  EXPECT_EQ(shapes::boundary(*coarse).triangles.size(), 12u);
  EXPECT_NEAR(volume_of(*coarse), 6, 1e-12);
}

TEST(FlatRegions, OfASolidThatTouchesItselfAreLeft) {
  const TetMesh apart = shapes::box({1, 1, 1}, 1, 1, 1);
  const TetMesh two = shapes::together(apart, shapes::transformed(apart, [](Vec3 p) { return p + Vec3{1, 1, 0}; }));
  Context context;
  EXPECT_FALSE(refill_merged(two, context));
  EXPECT_TRUE(context.warnings.empty());
}

}  // namespace
}  // namespace matstruct
