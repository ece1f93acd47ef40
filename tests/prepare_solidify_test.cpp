// solidify(): the least repair that gives a solid, its effect measured against volumes known in closed form.
#include "prepare/solidify.h"

#include <gtest/gtest.h>

#include <cmath>

#include <matstruct/error.h>

#include "base/index.h"
#include "prepare/domain.h"
#include "prepare/orient_soup.h"
#include "prepare/radial_pairs.h"
#include "shapes.h"

namespace matstruct {
namespace {

TriSurface box(const Vec3& low, const Vec3& high) {
  return shapes::boundary(shapes::transformed(shapes::box({1, 1, 1}), [=](Vec3 p) {
    return Vec3{low.x + p.x * (high.x - low.x), low.y + p.y * (high.y - low.y), low.z + p.z * (high.z - low.z)};
  }));
}

TriSurface together(TriSurface a, const TriSurface& b) {
  const Index shift = count(a.vertices);
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

TriSurface inside_out(TriSurface surface) {
  for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
  return surface;
}

std::string refusal(const TriSurface& surface) {
  Context context;
  try {
    solidify(surface, {}, context);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// Repairs, and checks volume and topology of what comes out.
Repair expect_solid(const TriSurface& surface, double volume, const Betti& topology, const ReadOptions& options = {}) {
  Context context;
  const Solidified made = solidify(surface, options, context);
  EXPECT_NEAR(shapes::volume(made.mesh), volume, 1e-12 * volume);
  EXPECT_EQ(prepare_domain(made.mesh, {}, context).topology, topology);
  EXPECT_EQ(made.repair.steps.empty(), context.warnings.empty()) << "repairs and only they are warned of";
  return made.repair;
}

TEST(Solidify, TakesAGoodSurfaceAsItIs) {
  EXPECT_TRUE(expect_solid(box({0, 0, 0}, {1, 1, 1}), 1, {1, 0, 0}).steps.empty());
}

TEST(Solidify, UnitesBodiesThatOverlap) {
  const Repair repair = expect_solid(together(box({0, 0, 0}, {1, 1, 1}), box({0.5, 0.4, 0.3}, {1.5, 1.4, 1.3})),
                                     2 - 0.5 * 0.6 * 0.7, {1, 0, 0});
  ASSERT_EQ(repair.steps.size(), 1u);
  EXPECT_NEAR(repair.volume_change_percent, -10.5, 1e-9);
  EXPECT_NEAR(repair.distance_percent, 0, 1e-12);
  EXPECT_GT(repair.sharp_edges_kept_percent, 80);
  EXPECT_LT(repair.sharp_edges_kept_percent, 90) << "those inside the other box are gone";
}

TEST(Solidify, UnitesBodiesThatOverlapWithFacesInOnePlane) {
  expect_solid(together(box({0, 0, 0}, {1, 1, 1}), box({0.5, 0, 0}, {1.5, 1, 1})), 1.5, {1, 0, 0});
}

TEST(Solidify, UnitesBodiesThatShareAFace) {
  const Repair repair = expect_solid(together(box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1})), 2, {1, 0, 0});
  EXPECT_NEAR(repair.volume_change_percent, 0, 1e-12);
}

TEST(Solidify, BodiesThatShareAnEdgeStayTwo) {
  expect_solid(together(box({0, 0, 0}, {1, 1, 1}), box({1, 1, 0}, {2, 2, 1})), 2, {2, 0, 0});
}

TEST(Solidify, ACavityThatReachesOutIsTakenAway) {
  expect_solid(together(box({0, 0, 0}, {1, 1, 1}), inside_out(box({0.5, 0.25, 0.25}, {1.5, 0.75, 0.75}))), 1 - 0.125,
               {1, 0, 0});
}

TEST(Solidify, UnitsDoNotMatter) {
  for (const double unit : {1e-6, 1e6}) {
    TriSurface surface = together(box({0, 0, 0}, {1, 1, 1}), box({0.5, 0.4, 0.3}, {1.5, 1.4, 1.3}));
    for (Vec3& p : surface.vertices) p = p * unit;
    expect_solid(surface, (2 - 0.5 * 0.6 * 0.7) * std::pow(unit, 3), {1, 0, 0});
  }
}

TEST(Solidify, FillsSmallHolesOnly) {
  TriSurface surface = shapes::boundary(shapes::box({4, 4, 4}, 16, 16, 16));
  const double volume = 64;
  surface.triangles.erase(surface.triangles.begin());
  const Repair repair = expect_solid(surface, volume, {1, 0, 0}, {.hole_size = 0.1});
  ASSERT_EQ(repair.steps.size(), 1u);
  EXPECT_NE(repair.steps[0].find("1 hole"), std::string::npos);
  EXPECT_TRUE(std::isnan(repair.volume_change_percent)) << "an open surface encloses nothing";
  TriSurface open = box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  const std::string text = refusal(open);
  for (const char* word : {"open", "3 edges", "larger than the hole size", "--allow-wrap"})
    EXPECT_NE(text.find(word), std::string::npos) << text;
}

TEST(Solidify, WrapsOnlyIfAllowed) {
  TriSurface open = box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  Context context;
  // The size of the opening: a side of the cube, so that the wrap does not go in.
  const Solidified made = solidify(open, {.allow_wrap = true, .wrap_size = 0.5}, context);
  ASSERT_EQ(context.warnings.size(), 1u);
  EXPECT_NE(context.warnings[0].find("WRAPPED"), std::string::npos);
  EXPECT_GT(shapes::volume(made.mesh), 0.9);
  EXPECT_GT(made.repair.distance_percent, 0.1);
}

TEST(Solidify, RefusesWhatHasNoInside) {
  EXPECT_NE(refusal({.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}}), "");
  const TriSurface projective_plane{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 2, 3}, {3, 1, 2}},
                                    .triangles = {{0, 1, 2},
                                                  {0, 2, 3},
                                                  {0, 3, 4},
                                                  {0, 4, 5},
                                                  {0, 5, 1},
                                                  {1, 2, 4},
                                                  {2, 3, 5},
                                                  {3, 4, 1},
                                                  {4, 5, 2},
                                                  {5, 1, 3}}};
  EXPECT_NE(refusal(projective_plane).find("one-sided"), std::string::npos);
}

TEST(OrientSoup, TurnsWhatIsMixedAndLeavesCavities) {
  TriSurface mixed = box({0, 0, 0}, {1, 1, 1});
  std::swap(mixed.triangles[3][0], mixed.triangles[3][1]);
  EXPECT_NEAR(signed_volume(orient_soup(mixed)), 1, 1e-15);
  EXPECT_NEAR(signed_volume(orient_soup(inside_out(mixed))), 1, 1e-15);
  const TriSurface hollow =
      together(box({0, 0, 0}, {1, 1, 1}), inside_out(box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75})));
  EXPECT_NEAR(signed_volume(orient_soup(hollow)), 1 - 0.125, 1e-15);
}

TEST(RadialPairs, PairsTrianglesOfOneBodyAtACommonEdge) {
  const auto diagonal = [](int i, int j, int) { return i == j; };
  const TriSurface two = shapes::boundary(shapes::grid({0, 1, 2}, {0, 1, 2}, {0, 1}, diagonal));
  const auto neighbors = pair_across_material(two, [](Index) { return std::string(); });
  const auto body = [&](Index t) {
    double sum = 0;
    for (const Index v : two.triangles[uz(t)]) sum += two.vertices[uz(v)].x + two.vertices[uz(v)].y;
    return sum > 6;
  };
  for (Index t = 0; t < count(two.triangles); ++t)
    for (const Index other : neighbors[uz(t)]) EXPECT_EQ(body(t), body(other));
}

}  // namespace
}  // namespace matstruct
