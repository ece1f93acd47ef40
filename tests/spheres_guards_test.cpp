// Spheres on sharp lines: feature spheres on the convex ones, guards on the concave ones.

#include "spheres/guards.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "base/index.h"
#include "base/tolerances.h"
#include "shapes.h"
#include "spheres/feature_spheres.h"
#include "spheres/initial_spheres.h"

namespace matstruct {
namespace {

Domain domain_of(const TetMesh& mesh) {
  Context context;
  return prepare_domain(mesh, {}, context);
}

double line_length(const Domain& domain, const FeatureLine& line) {
  double length = 0;
  for (const Index e : line.edges) {
    const auto& [a, b] = domain.features.edges[uz(e)].vertices;
    length += distance(domain.surface.vertices[uz(a)], domain.surface.vertices[uz(b)]);
  }
  return length;
}

// Spheres of each line in order along it.
std::map<Index, std::vector<SphereSeed>> by_line(const std::vector<SphereSeed>& seeds) {
  std::map<Index, std::vector<SphereSeed>> lines;
  for (const SphereSeed& s : seeds)
    if (s.line != kInvalid) lines[s.line].push_back(s);
  for (auto& [line, list] : lines)
    std::sort(list.begin(), list.end(), [](auto& a, auto& b) { return a.position < b.position; });
  return lines;
}

// ---- feature spheres ------------------------------------------------------------------------------------------------

TEST(FeatureSpheres, HaveTheirPlacesOnEveryShape) {
  for (const auto& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const Domain domain = domain_of(shape.mesh);
    for (const SphereSeed& s : feature_spheres(domain, 0.1)) {
      EXPECT_EQ(s.radius, 0);
      EXPECT_EQ(s.reach, tolerance::kFeatureReach * domain.diagonal);
      EXPECT_FALSE(s.guard);
      if (s.type == SphereType::kCorner) {
        EXPECT_EQ(s.center, domain.surface.vertices[uz(s.corner)]);
        EXPECT_TRUE(std::binary_search(domain.features.corners.begin(), domain.features.corners.end(), s.corner));
      } else {
        ASSERT_EQ(s.type, SphereType::kSharpEdge);
        const FeatureLine& line = domain.features.lines[uz(s.line)];
        EXPECT_EQ(line.kind, EdgeKind::kConvex);
        EXPECT_EQ(s.center, point_on_line(domain, line, s.position));
      }
    }
  }
}

TEST(FeatureSpheres, AreEquallySpacedOnABox) {
  const Domain domain = domain_of(shapes::box({1, 2, 3}, 2, 3, 4));
  const double unit = domain.frame.scale, spacing = 0.3 * unit;
  const auto seeds = feature_spheres(domain, spacing);
  EXPECT_EQ(std::count_if(seeds.begin(), seeds.end(), [](auto& s) { return s.type == SphereType::kCorner; }), 8);
  const auto lines = by_line(seeds);
  ASSERT_EQ(lines.size(), 12u);
  for (const auto& [l, list] : lines) {
    // 4, 7 and 10 pieces on the edges of length 1, 2 and 3.
    const double length = line_length(domain, domain.features.lines[uz(l)]);
    const auto pieces = static_cast<std::size_t>(std::ceil(length / spacing));
    ASSERT_EQ(list.size() + 1, pieces);
    for (std::size_t k = 1; k < list.size(); ++k)
      EXPECT_NEAR(distance(list[k - 1].center, list[k].center), length / static_cast<double>(pieces), 1e-12);
  }
}

TEST(FeatureSpheres, AreAtLeastOneBetweenCornersAndThreeOnAClosedLine) {
  const Domain cube = domain_of(shapes::box({1, 1, 1}));
  EXPECT_EQ(feature_spheres(cube, 10).size(), 8u + 12u);
  const Domain cylinder = domain_of(shapes::prism(1, 3, 24, 4));
  const auto seeds = feature_spheres(cylinder, 10);
  EXPECT_EQ(seeds.size(), 6u);
  for (const auto& [l, list] : by_line(seeds)) {
    const double side = distance(list[0].center, list[1].center);
    EXPECT_NEAR(distance(list[1].center, list[2].center), side, 1e-12);
    EXPECT_NEAR(distance(list[2].center, list[0].center), side, 1e-12);
  }
}

TEST(FeatureSpheres, MiddleOfALine) {
  const Domain domain = domain_of(shapes::prism(1, 3, 24, 4));
  const FeatureLine& circle = domain.features.lines.front();
  ASSERT_TRUE(circle.closed);
  EXPECT_NEAR(middle_of_line(domain, circle, 2, 5), 3.5, 1e-12);
  EXPECT_NEAR(middle_of_line(domain, circle, 20, 26), 23, 1e-12);
  EXPECT_NEAR(middle_of_line(domain, circle, 22, 28), 1, 1e-12);  // past the start

  // By arc length, not by position: edges of different lengths.
  const Domain uneven = domain_of(shapes::grid({0, 1, 4}, {0, 1}, {0, 1}, [](int, int, int) { return true; }));
  for (const FeatureLine& line : uneven.features.lines) {
    if (line.edges.size() != 2) continue;
    const double middle = middle_of_line(uneven, line, 0, 2);
    EXPECT_NEAR(uneven.frame.to_input(point_on_line(uneven, line, middle)).x, 2, 1e-12);
  }
}

// ---- guards ---------------------------------------------------------------------------------------------------------

std::vector<SphereSeed> guards_of(const Domain& domain, double spacing) {
  return guard_spheres(domain, spacing, {});
}

bool is_convex_corner(const Domain& domain, Index v) {
  return std::any_of(domain.features.lines.begin(), domain.features.lines.end(), [&](const FeatureLine& line) {
    return line.kind == EdgeKind::kConvex &&
           std::find(line.vertices.begin(), line.vertices.end(), v) != line.vertices.end();
  });
}

TEST(Guards, SitOnConcaveLinesOnly) {
  constexpr double kSpacing = 0.05;
  for (const auto& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const Domain domain = domain_of(shape.mesh);
    std::set<Index> guarded;
    for (const SphereSeed& s : guards_of(domain, kSpacing)) {
      EXPECT_TRUE(s.guard);
      EXPECT_EQ(s.radius, 0);
      EXPECT_GT(s.reach, 0);
      EXPECT_LE(s.reach, 0.15 * kSpacing);
      const FeatureLine& line = domain.features.lines[uz(s.line)];
      EXPECT_EQ(line.kind, EdgeKind::kConcave);
      EXPECT_EQ(s.center, point_on_line(domain, line, s.position));
      guarded.insert(s.line);
    }
    EXPECT_EQ(count(guarded), shape.concave_lines);
  }
}

// Guards of a line and those that other lines hold for its ends.
std::vector<SphereSeed> guards_along(const Domain& domain, Index l, const std::vector<SphereSeed>& guards) {
  const FeatureLine& line = domain.features.lines[uz(l)];
  const Vec3 start = domain.surface.vertices[uz(line.vertices.front())];
  const Vec3 end = domain.surface.vertices[uz(line.vertices.back())];
  std::vector<SphereSeed> result;
  for (const SphereSeed& g : guards)
    if (g.line == l || g.center == start || g.center == end) result.push_back(g);
  std::sort(result.begin(), result.end(),
            [&](auto& a, auto& b) { return distance2(a.center, start) < distance2(b.center, start); });
  return result;
}

TEST(Guards, OverlapAlongTheLineAndStayClearOfConvexCorners) {
  for (const TetMesh& mesh :
       {shapes::l_profile(), shapes::plate_with_hole(0.3), shapes::hollow_box(), shapes::notched_box()})
    for (const double spacing : {0.2, 0.05, 0.01}) {
      SCOPED_TRACE(spacing);
      const Domain domain = domain_of(mesh);
      const auto guards = guards_of(domain, spacing);
      for (Index l = 0; l < count(domain.features.lines); ++l) {
        const FeatureLine& line = domain.features.lines[uz(l)];
        if (line.kind != EdgeKind::kConcave) continue;
        const auto along = guards_along(domain, l, guards);
        ASSERT_GE(along.size(), 2u);
        for (std::size_t k = 1; k < along.size(); ++k)
          EXPECT_LT(distance(along[k - 1].center, along[k].center), along[k - 1].reach + along[k].reach);
        // At an end with a corner sphere there is a gap that no guard's ball crosses; at others a guard.
        const double gap = 0.1 * std::min(spacing, line_length(domain, line));
        for (const auto& [v, guard, next] : {std::tuple{line.vertices.front(), along.front(), along[1]},
                                             {line.vertices.back(), along.back(), along[along.size() - 2]}}) {
          const double from_end = distance(guard.center, domain.surface.vertices[uz(v)]);
          if (is_convex_corner(domain, v)) {
            EXPECT_GT(from_end, guard.reach);
            EXPECT_LT(from_end, 4 * gap);
          } else {
            EXPECT_EQ(from_end, 0);
            // The bisector with the next guard is well inside the line: the other walls at the end are not reached.
            const double step2 = distance2(guard.center, next.center);
            EXPECT_GT(step2 + guard.reach * guard.reach - next.reach * next.reach, 0.5 * step2);
          }
        }
      }
    }
}

TEST(Guards, StayClearOfTheCornersOfLinesFarShorterThanTheSpacing) {
  const Domain domain = domain_of(shapes::l_profile());
  for (const SphereSeed& g : guards_of(domain, 100)) {
    const FeatureLine& line = domain.features.lines[uz(g.line)];
    for (const Index v : {line.vertices.front(), line.vertices.back()})
      EXPECT_LT(g.reach, distance(g.center, domain.surface.vertices[uz(v)]));
  }
}

TEST(Guards, LeaveAPlaceToFeatureSpheresInsideThem) {
  const Domain domain = domain_of(shapes::l_profile());
  const auto guards = guards_of(domain, 0.05);
  const FeatureReach reach(domain, guards);
  for (const SphereSeed& g : guards) {
    const Vec3 x = g.center + Vec3{0.5 * g.reach, 0, 0};  // inside, off the line
    const double power = -std::pow(reach.at(x), 2);
    for (const SphereSeed& other : guards) EXPECT_LT(power, distance2(x, other.center) - other.reach * other.reach);
  }
  EXPECT_EQ(reach.at(domain.surface.vertices.front()), tolerance::kFeatureReach * domain.diagonal);
}

TEST(Guards, ThatHaveToStayBecomeTheBallHalfWayBetweenTheFaces) {
  const Domain domain = domain_of(shapes::l_profile());
  const auto guards = guards_of(domain, 0.05);
  ASSERT_FALSE(guards.empty());
  const SphereSeed& guard = guards[guards.size() / 2];
  const SphereSeed seed = medial_sphere_at(domain, guard);
  EXPECT_FALSE(seed.guard);
  EXPECT_GT(seed.radius, 0);
  EXPECT_NEAR(seed.radius, distance(seed.center, guard.center), 1e-9);
  EXPECT_NEAR(seed.radius, std::sqrt(domain.query.closest(seed.center).distance2), 1e-9);
}

TEST(Guards, AreNoneOnConvexSolids) {
  EXPECT_TRUE(guards_of(domain_of(shapes::pyramid()), 0.05).empty());
}

TEST(InitialSpheres, BeginWithFeaturesThenGuardsThenSheets) {
  const Domain domain = domain_of(shapes::plate_with_hole());
  const Options options{.gamma = 10};
  const Spheres spheres = initial_spheres(domain, options, {});
  const std::size_t features = feature_spheres(domain, target_spacing(domain, options)).size();
  const std::size_t guards = guards_of(domain, target_spacing(domain, options)).size();
  ASSERT_GT(spheres.seeds.size(), features + guards);
  for (std::size_t s = 0; s < spheres.seeds.size(); ++s) {
    const SphereSeed& seed = spheres.seeds[s];
    EXPECT_TRUE(spheres.alive[s]);
    EXPECT_EQ(seed.type == SphereType::kSharpEdge || seed.type == SphereType::kCorner, s < features);
    EXPECT_EQ(seed.guard, s >= features && s < features + guards);
    if (s < features + guards) continue;
    // A medial sphere: inside, empty and tangent.
    EXPECT_TRUE(domain.query.inside(seed.center));
    EXPECT_NEAR(std::sqrt(domain.query.closest(seed.center).distance2), seed.radius, 1e-9);
  }
}

}  // namespace
}  // namespace matstruct
