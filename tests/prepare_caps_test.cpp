// remove_caps(): random triangulated squares with vertices on grid lines lose their caps and keep their area and
// border.
#include "prepare/caps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "base/index.h"
#include "geometry/exact.h"

namespace matstruct {
namespace {

double area(const TriSurface& s) {
  double sum = 0;
  for (const Triangle& t : s.triangles) {
    const Vec3& a = s.vertices[uz(t[0])];
    sum += norm(cross(s.vertices[uz(t[1])] - a, s.vertices[uz(t[2])] - a)) / 2;
  }
  return sum;
}

std::vector<Edge> border(const TriSurface& s) {
  std::map<Edge, int> uses;
  for (const Triangle& t : s.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      ++uses[ordered_edge(a, b)];
    }
  std::vector<Edge> result;
  for (const auto& [edge, n] : uses)
    if (n == 1) result.push_back(edge);
  return result;
}

Index caps(const TriSurface& s) {
  return static_cast<Index>(std::count_if(s.triangles.begin(), s.triangles.end(), [&](const Triangle& t) {
    return collinear(s.vertices[uz(t[0])], s.vertices[uz(t[1])], s.vertices[uz(t[2])]);
  }));
}

// Two triangles over and under the x axis from 0 to n, with the points 1..n-1 of the axis between them: the upper one
// sees all of them, the lower one none, and random caps fill the polygon 0, 1, ..., n in between.
TriSurface with_random_caps(Index n, unsigned seed) {
  TriSurface s;
  for (Index i = 0; i <= n; ++i) s.vertices.push_back({static_cast<double>(i), 0, 0});
  s.vertices.push_back({n / 2.0, 3, 0});
  s.vertices.push_back({n / 2.0, -3, 0});
  for (Index i = 0; i < n; ++i) s.triangles.push_back({i, i + 1, n + 1});
  s.triangles.push_back({n, 0, n + 2});
  std::mt19937 random(seed);
  std::vector<Index> polygon(uz(n) + 1);
  for (Index i = 0; i <= n; ++i) polygon[uz(i)] = i;
  while (polygon.size() > 2) {
    const std::size_t ear = random() % polygon.size(), m = polygon.size();
    s.triangles.push_back({polygon[(ear + 1) % m], polygon[ear], polygon[(ear + m - 1) % m]});
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  std::shuffle(s.triangles.begin(), s.triangles.end(), random);
  return s;
}

TEST(Caps, RandomFillingsOfALineVanish) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const Index n = 2 + static_cast<Index>(seed % 9);
    TriSurface surface = with_random_caps(n, seed);
    const TriSurface before = surface;
    ASSERT_EQ(caps(surface), n - 1);
    EXPECT_GE(remove_caps(surface, 0), n - 1);
    EXPECT_EQ(caps(surface), 0);
    EXPECT_EQ(border(surface), border(before));
    EXPECT_NEAR(area(surface), area(before), 1e-12);
    EXPECT_EQ(count(surface.triangles), 2 * n);
  }
}

// The points of the line stand off it by rounding, as a remesher leaves them.
TEST(Caps, FillingsOfALineThatIsNotQuiteStraightVanish) {
  constexpr double kHeight = 1e-6;
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    const Index n = 2 + static_cast<Index>(seed % 9);
    TriSurface surface = with_random_caps(n, seed);
    std::mt19937 random(seed);
    for (Index i = 1; i < n; ++i) surface.vertices[uz(i)].z = std::uniform_real_distribution<>(-1e-8, 1e-8)(random);
    const TriSurface before = surface;
    remove_caps(surface, kHeight);
    EXPECT_EQ(border(surface), border(before));
    EXPECT_EQ(count(surface.triangles), 2 * n);
    EXPECT_NEAR(area(surface), area(before), 1e-6);
  }
}

TEST(Caps, OthersStayAsTheyAre) {
  TriSurface needle{.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-300, 0}}, .triangles = {{0, 1, 2}}};
  EXPECT_EQ(remove_caps(needle, 0), 0);
  EXPECT_EQ(count(needle.triangles), 1);
  // Two corners near each other make no cap.
  TriSurface pin{.vertices = {{0, 0, 0}, {1, 0, 0}, {1e-8, 1e-9, 0}}, .triangles = {{0, 1, 2}}};
  EXPECT_EQ(remove_caps(pin, 1e-6), 0);
}

}  // namespace
}  // namespace matstruct
