// Small strata: complexes small enough to know what must be left, and what never changes.
#include "extract/small_strata.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include <matstruct/metrics.h>
#include <matstruct/strata.h>

#include "base/index.h"

namespace matstruct {
namespace {

/// Spheres of radius 1 unless said otherwise, and faces between them.
MedialMesh mesh_of(const std::vector<Vec3>& places, std::vector<Triangle> faces) {
  MedialMesh mesh{places, std::vector<double>(places.size(), 1), std::vector<SphereType>(places.size()), {}, {}};
  std::set<Edge> edges;
  for (Triangle& t : faces) {
    std::sort(t.begin(), t.end());
    edges.insert({{t[0], t[1]}, {t[0], t[2]}, {t[1], t[2]}});
  }
  std::sort(faces.begin(), faces.end());
  mesh.edges.assign(edges.begin(), edges.end());
  mesh.faces = std::move(faces);
  return mesh;
}

constexpr Index kSide = 6;

Index grid(Index x, Index y) {
  return kSide * y + x;
}

/// A flat sheet of unit squares, cut into triangles, with more vertices and faces.
MedialMesh sheet_with(const std::vector<Vec3>& more, const std::vector<Triangle>& faces) {
  std::vector<Vec3> places;
  for (Index y = 0; y < kSide; ++y)
    for (Index x = 0; x < kSide; ++x) places.push_back({1.0 * x, 1.0 * y, 0});
  std::vector<Triangle> all;
  for (Index y = 0; y + 1 < kSide; ++y)
    for (Index x = 0; x + 1 < kSide; ++x) {
      all.push_back({grid(x, y), grid(x + 1, y), grid(x + 1, y + 1)});
      all.push_back({grid(x, y), grid(x + 1, y + 1), grid(x, y + 1)});
    }
  places.insert(places.end(), more.begin(), more.end());
  all.insert(all.end(), faces.begin(), faces.end());
  return mesh_of(places, all);
}

constexpr Index kMore = kSide * kSide;
constexpr SmallStrataOptions kOptions{.spacing = 1, .cover = 0.1};

TEST(SmallStrata, ASheetThatTheRestCoversGoes) {
  // Two triangles that stand on two edges of the sheet.
  MedialMesh mesh = sheet_with({{2.5, 2, 0.5}}, {{grid(1, 2), grid(2, 2), kMore}, {grid(2, 2), grid(3, 2), kMore}});
  mesh.radii.back() = 0.5;
  const MedialMesh before = mesh;
  const Betti betti = betti_numbers(mesh);
  const std::vector<Index> left = drop_small_strata(mesh, {}, kOptions);
  EXPECT_EQ(count(left), kMore);
  EXPECT_EQ(betti_numbers(mesh), betti);
  const Strata strata = trace_strata(mesh);
  EXPECT_EQ(strata.sheets, 1);
  EXPECT_TRUE(strata.seams.empty());
  EXPECT_EQ(count(mesh.faces), count(before.faces) - 2);
}

TEST(SmallStrata, WhatSticksOutIsLargeOrFixedStays) {
  const auto unchanged = [](MedialMesh mesh, const std::vector<Edge>& fixed, const SmallStrataOptions& options) {
    const MedialMesh before = mesh;
    const std::vector<Index> left = drop_small_strata(mesh, fixed, options);
    return mesh.edges == before.edges && mesh.faces == before.faces && count(left) == count(before.centers);
  };
  MedialMesh mesh = sheet_with({{2.5, 2, 0.5}}, {{grid(2, 2), grid(3, 2), kMore}});
  EXPECT_TRUE(unchanged(mesh, {}, kOptions)) << "it sticks out by 0.5";
  mesh.radii.back() = 0.5;
  EXPECT_FALSE(unchanged(mesh, {}, kOptions));
  EXPECT_TRUE(unchanged(mesh, {}, {.spacing = 0.1, .cover = 0.1})) << "it is large";
  EXPECT_TRUE(unchanged(mesh, {{grid(2, 2), kMore}, {grid(3, 2), kMore}}, kOptions)) << "its borders are fixed";
  mesh.types.back() = SphereType::kSharpEdge;
  EXPECT_TRUE(unchanged(mesh, {}, kOptions)) << "its end is on a sharp line";
}

/// A wall of height `height` that stands on the middle line of the sheet up to x = `end`, and reaches on to x = 5 above
/// it without touching. Between, one triangle joins it to the sheet.
MedialMesh wall_that_lets_go() {
  std::vector<Vec3> more;
  std::vector<Triangle> faces;
  for (Index x = 0; x < kSide; ++x) more.push_back({1.0 * x, 2, 2});
  for (Index x = 0; x < 2; ++x) {
    faces.push_back({grid(x, 2), grid(x + 1, 2), kMore + x});
    faces.push_back({grid(x + 1, 2), kMore + x, kMore + x + 1});
  }
  // Beyond x = 2 the wall's foot leaves the sheet; its first foot is at (3.5, 2, 1).
  const Index foot = kMore + kSide;
  more.push_back({2.9, 2, 0.3});
  faces.push_back({grid(2, 2), grid(3, 2), foot});
  faces.push_back({grid(2, 2), foot, kMore + 2});
  faces.push_back({foot, kMore + 2, kMore + 3});
  MedialMesh mesh = sheet_with(more, faces);
  mesh.radii.back() = 0.7;
  return mesh;
}

TEST(SmallStrata, ASheetLetsGoOfAnotherWhereItJustTouchesIt) {
  MedialMesh mesh = wall_that_lets_go();
  // Another sheet below makes a junction at (2, 2).
  mesh.centers.push_back({2, 2, -4});
  mesh.radii.push_back(1);
  mesh.types.push_back(SphereType::kSheet);
  std::vector<Triangle> faces = mesh.faces;
  faces.push_back({grid(2, 2), grid(2, 1), count(mesh.centers) - 1});
  faces.push_back({grid(2, 1), grid(2, 0), count(mesh.centers) - 1});
  std::vector<double> radii = mesh.radii;
  mesh = mesh_of(mesh.centers, faces);
  mesh.radii = radii;
  const Betti betti = betti_numbers(mesh);
  const std::size_t seams = trace_strata(mesh).seams.size();
  drop_small_strata(mesh, {}, kOptions);
  EXPECT_EQ(trace_strata(mesh).seams.size(), seams - 1);
  EXPECT_EQ(betti_numbers(mesh), betti);
  const Edge last{grid(2, 2), grid(3, 2)};
  EXPECT_EQ(
      std::count_if(mesh.faces.begin(), mesh.faces.end(),
                    [&](const Triangle& t) { return std::includes(t.begin(), t.end(), last.begin(), last.end()); }),
      2);
}

TEST(SmallStrata, APinchedTipIsOpened) {
  // A cone whose walls touch along the edge 0 1 below its tip: four faces of one sheet at that edge.
  MedialMesh mesh = mesh_of({{0, 0, 0},
                             {0.3, 0, 0.3},
                             {1, 1, 1},
                             {-1, 1, 1},
                             {-1, -1, 1},
                             {1, -1, 1},
                             {0, 1.5, 1.2},
                             {0, -1.5, 1.2},
                             {1.5, 0, 1.2},
                             {-1.5, 0, 1.2}},
                            {{0, 1, 2},
                             {0, 1, 3},
                             {0, 1, 4},
                             {0, 1, 5},
                             {0, 2, 6},
                             {0, 3, 6},
                             {0, 4, 7},
                             {0, 5, 7},
                             {1, 2, 8},
                             {1, 5, 8},
                             {1, 3, 9},
                             {1, 4, 9}});
  ASSERT_EQ(trace_strata(mesh).seams.size(), 1u);
  const Betti betti = betti_numbers(mesh);
  const std::vector<Index> left = drop_small_strata(mesh, {}, {.spacing = 1, .cover = 0.5});
  EXPECT_EQ(left.size(), 9u);
  EXPECT_EQ(betti_numbers(mesh), betti);
  const Strata strata = trace_strata(mesh);
  EXPECT_EQ(strata.sheets, 1);
  EXPECT_TRUE(strata.seams.empty());
  EXPECT_EQ(strata.boundaries.size(), 1u);
}

// Two flat halves left and right, and a wall on either of two seams that run side by side between them.
TEST(SmallStrata, SeamsSideBySideBecomeOne) {
  constexpr double kWidth = 0.02;
  const std::vector<Vec3> places = {{0, 0, 0},  {0, 1, 0}, {0, 2, 0},   {kWidth, 1, 0},
                                    {-1, 1, 0}, {1, 1, 0}, {0, 1, 1.5}, {kWidth, 1, -1.5}};
  // The bigon 0 1 2 3 has a wall with the apex 6 on its side 0 1 2 and one with the apex 7 on its side 0 3 2.
  MedialMesh mesh = mesh_of(
      places,
      {{0, 1, 3}, {1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {0, 3, 5}, {2, 3, 5}, {0, 1, 6}, {1, 2, 6}, {0, 3, 7}, {2, 3, 7}});
  ASSERT_EQ(trace_strata(mesh).sheets, 5);
  const MedialMesh before = mesh;
  drop_small_strata(mesh, {}, kOptions);
  EXPECT_EQ(trace_strata(mesh).sheets, 4);
  EXPECT_EQ(trace_strata(mesh).seams.size(), 1u);
  EXPECT_EQ(betti_numbers(mesh), betti_numbers(before));
  MedialMesh wide = before;
  wide.centers[3].x = 0.5;
  drop_small_strata(wide, {}, kOptions);
  EXPECT_EQ(trace_strata(wide).sheets, 5);
}

TEST(SmallStrata, SeamsOfSpheresThatAreOfNoneGo) {
  // A fold of the sheet onto a sphere of a sharp line: its face cannot be collapsed, but its seam is of sheet spheres.
  MedialMesh mesh = sheet_with({{2.5, 2.2, 0.05}}, {{grid(2, 2), grid(3, 2), kMore}});
  mesh.types.back() = SphereType::kSharpEdge;
  SmallStrataOptions options = kOptions;
  options.spacing = 3;
  const MedialMesh before = mesh;
  drop_small_strata(mesh, {}, options);
  EXPECT_EQ(mesh.faces, before.faces);
  options.contacts.assign(before.centers.size(), 3);
  drop_small_strata(mesh, {}, options);
  EXPECT_EQ(mesh.faces, before.faces) << "their contacts say that it is a seam";
  options.contacts.assign(before.centers.size(), 2);
  const std::vector<Index> left = drop_small_strata(mesh, {}, options);
  EXPECT_EQ(count(left), kMore);
  EXPECT_EQ(betti_numbers(mesh), betti_numbers(before));
  EXPECT_TRUE(trace_strata(mesh).seams.empty());
  EXPECT_EQ(left.back(), kMore);  // the sphere of the sharp line
}

TEST(SmallStrata, AJunctionWithTooFewContactsIsMerged) {
  // Two seams, 0 1 2 and 0 3 2, between two junctions, with a sheet between them and four more sheets beside them.
  const std::vector<Vec3> places = {{0, 0, 0},  {0, 1, 0}, {0, 2, 0}, {1.2, 1, 0},
                                    {-3, 1, 0}, {3, 1, 0}, {0, 1, 3}, {1.2, 1, -3}};
  const MedialMesh before = mesh_of(
      places,
      {{0, 1, 3}, {1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {0, 3, 5}, {2, 3, 5}, {0, 1, 6}, {1, 2, 6}, {0, 3, 7}, {2, 3, 7}});
  ASSERT_EQ(trace_strata(before).junctions, (std::vector<Index>{0, 2}));
  SmallStrataOptions options{.spacing = 3, .cover = 1.1, .contacts = std::vector<Index>(places.size(), 4)};
  MedialMesh mesh = before;
  drop_small_strata(mesh, {}, options);
  EXPECT_EQ(mesh.faces, before.faces);
  options.contacts[0] = 3;
  const std::vector<Index> left = drop_small_strata(mesh, {}, options);
  EXPECT_EQ(left, (std::vector<Index>{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(betti_numbers(mesh), betti_numbers(before));
  EXPECT_EQ(trace_strata(mesh).sheets, 5);
}

/// Four walls around an axis, a floor between two of them, and one between the others at almost the same height: these
/// make junctions of the vertices 1 and 2 of the axis.
struct Walls {
  static constexpr double kApart = 0.005, kSize = 10;
  static constexpr Index kLevels = 4;
  std::vector<Vec3> places;
  std::vector<Triangle> faces;

  Walls() {
    const std::array<double, kLevels> heights{-kSize, 0, kApart, kSize};
    for (const Vec3& foot : std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}})
      for (const double height : heights) places.push_back(foot * kSize + Vec3{0, 0, height});
    for (Index wall = kLevels; wall <= 4 * kLevels; wall += kLevels)
      for (Index level = 0; level + 1 < kLevels; ++level) {
        faces.push_back({level, level + 1, wall + level});
        faces.push_back({level + 1, wall + level, wall + level + 1});
      }
    faces.push_back({1, kLevels + 1, 2 * kLevels + 1});
    faces.push_back({2, 3 * kLevels + 2, 4 * kLevels + 2});
  }
};

// How many junctions go; no sheet and no handle may.
std::size_t junctions_gone(const MedialMesh& before, const SmallStrataOptions& options) {
  MedialMesh mesh = before;
  drop_small_strata(mesh, {}, options);
  EXPECT_EQ(trace_strata(mesh).sheets, trace_strata(before).sheets);
  EXPECT_EQ(betti_numbers(mesh), betti_numbers(before));
  return trace_strata(before).junctions.size() - trace_strata(mesh).junctions.size();
}

TEST(SmallStrata, JunctionsThatTheSurfaceDoesNotTellApartBecomeOne) {
  const Walls walls;
  const MedialMesh mesh = mesh_of(walls.places, walls.faces);
  ASSERT_EQ(trace_strata(mesh).junctions, (std::vector<Index>{1, 2}));
  SmallStrataOptions options = kOptions;
  const auto junctions = [&](double resolution) {
    options.resolution = resolution;
    return junctions_gone(mesh, options);
  };
  EXPECT_EQ(junctions(0), 0u);
  EXPECT_EQ(junctions(0.004), 0u);
  EXPECT_EQ(junctions(0.006), 1u);
  options.spacing = 0.2;
  EXPECT_EQ(junctions(0.006), 0u) << "they are farther apart than a fiftieth of the spacing";
}

TEST(SmallStrata, TheEndOfASeamBesideThemDoesNotKeepJunctionsApart) {
  // The floor of the first wall's end, {1, 2, end}, is three faces at `middle` and five in all; a sheet meets the wall
  // from `middle` over `third` to its end. No face joins both junctions to `third`.
  Walls walls;
  constexpr Index kEnd = Walls::kLevels + 1, kMiddle = 5 * Walls::kLevels, kThird = kMiddle + 1, kTip = kThird + 1;
  walls.places.insert(walls.places.end(), {{0.01, 0, 0.0025}, {0.02, 0, 0.0025}, {5, 5, 0.0025}});
  std::erase(walls.faces, Triangle{1, 2, kEnd});
  std::erase(walls.faces, Triangle{2, kEnd, kEnd + 1});
  for (const Triangle& t : {Triangle{1, 2, kMiddle},
                            {1, kMiddle, kThird},
                            {2, kMiddle, kThird},
                            {1, kEnd, kThird},
                            {2, kEnd + 1, kThird},
                            {kEnd, kEnd + 1, kThird},
                            {kMiddle, kThird, kTip},
                            {kEnd, kThird, kTip}})
    walls.faces.push_back(t);
  SmallStrataOptions options = kOptions;
  options.resolution = 0.006;
  EXPECT_EQ(junctions_gone(mesh_of(walls.places, walls.faces), options), 1u);
}

TEST(SmallStrata, AVertexOfThreeFacesDoesNotKeepAFalseSeam) {
  // A disc whose faces 0 to 7 of the border meet four at the edge 8 9: its link condition fails for the edges 8 3 and
  // 9 3, between which the faces at 10 lie instead of one.
  std::vector<Vec3> places;
  for (int k = 0; k < 8; ++k) {
    const double angle = (112.5 + 45 * k) / 180 * std::numbers::pi;
    places.push_back({1.5 * std::cos(angle), 1.5 * std::sin(angle), 0});
  }
  places.insert(places.end(), {{-0.3, 0, 0}, {0.3, 0, 0}, {-0.1, -0.3, 0}});
  MedialMesh mesh = mesh_of(places, {{0, 1, 8},
                                     {0, 8, 9},
                                     {7, 8, 6},
                                     {7, 8, 9},
                                     {1, 8, 2},
                                     {8, 6, 9},
                                     {8, 10, 9},
                                     {8, 10, 3},
                                     {8, 2, 3},
                                     {0, 7, 9},
                                     {6, 9, 5},
                                     {10, 9, 3},
                                     {9, 3, 4},
                                     {9, 5, 4}});
  const MedialMesh before = mesh;
  ASSERT_EQ(trace_strata(mesh).seams.size(), 1u);
  drop_small_strata(mesh, {}, kOptions);
  EXPECT_TRUE(trace_strata(mesh).seams.empty());
  EXPECT_EQ(trace_strata(mesh).sheets, 1);
  EXPECT_EQ(betti_numbers(mesh), betti_numbers(before));
}

TEST(SmallStrata, ASphereIsCoveredByAllFacesAroundTheOneThatStays) {
  // Four sheets meet along 0 1, two and two also along 0 2, beside the middle of that seam. 11 makes 0 a junction.
  const std::vector<Vec3> places = {{0, 0, 0},    {2, 0, 0}, {1, 0, 0.05}, {-1, 2, 2}, {-1, -2, 2}, {-1, 2, -2},
                                    {-1, -2, -2}, {3, 2, 2}, {3, -2, 2},   {3, 2, -2}, {3, -2, -2}, {-2, 0, 0}};
  const MedialMesh before = mesh_of(places, {{0, 1, 3},
                                             {0, 1, 4},
                                             {0, 1, 5},
                                             {0, 1, 6},
                                             {1, 3, 7},
                                             {1, 4, 8},
                                             {1, 5, 9},
                                             {1, 6, 10},
                                             {0, 2, 3},
                                             {0, 2, 4},
                                             {2, 3, 4},
                                             {0, 2, 5},
                                             {0, 2, 6},
                                             {2, 5, 6},
                                             {0, 3, 11},
                                             {0, 4, 11},
                                             {0, 5, 11}});
  MedialMesh mesh = before;
  const std::vector<Index> left = drop_small_strata(mesh, {}, {.spacing = 1.5, .cover = 0.1});
  EXPECT_FALSE(std::binary_search(left.begin(), left.end(), 2));
  EXPECT_EQ(betti_numbers(mesh), betti_numbers(before));
}

TEST(SmallStrata, WhiskersGoUnlessTheyStickOutOrAreFixed) {
  const auto with_whisker = [](double radius, double length) {
    MedialMesh mesh = sheet_with({{5 + length, 2, 0}}, {});
    mesh.edges.push_back({grid(5, 2), kMore});
    std::sort(mesh.edges.begin(), mesh.edges.end());
    mesh.radii.back() = radius;
    return mesh;
  };
  const auto curves_left = [](MedialMesh mesh, const std::vector<Edge>& fixed, bool faint = false) {
    SmallStrataOptions options = kOptions;
    if (faint) options.faint.assign(mesh.centers.size(), 1);
    drop_small_strata(mesh, fixed, options);
    return trace_strata(mesh).curves.size();
  };
  EXPECT_EQ(curves_left(with_whisker(0.5, 0.7), {}), 0u);
  EXPECT_EQ(curves_left(with_whisker(0.9, 0.7), {}), 1u) << "it sticks out by 0.6";
  EXPECT_EQ(curves_left(with_whisker(0.9, 0.7), {}, true), 0u) << "but stands between facets of one face";
  EXPECT_EQ(curves_left(with_whisker(0.01, 1.6), {}), 1u) << "it is long";
  EXPECT_EQ(curves_left(with_whisker(0.9, 4.5), {}, true), 0u) << "however long it is";
  EXPECT_EQ(curves_left(with_whisker(0.35, 0.7), {{grid(5, 2), kMore}}, true), 1u);
  EXPECT_EQ(curves_left(with_whisker(0.35, 0.7), {{grid(5, 2), kMore}}), 1u);
}

// A medial curve of three edges with a branch at its second vertex, as between facets of a turned part.
TEST(SmallStrata, FaintBranchesOfAMedialCurveGo) {
  MedialMesh mesh;
  for (const Vec3& c : std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 1, 0}, {1, 2, 0}, {2, 2, 0}}) {
    mesh.centers.push_back(c);
    mesh.radii.push_back(2);
    mesh.types.push_back(SphereType::kSheet);
  }
  mesh.edges = {{0, 1}, {1, 2}, {1, 4}, {2, 3}, {4, 5}, {4, 6}};
  SmallStrataOptions options = kOptions;
  options.faint = {0, 0, 0, 0, 1, 1, 1};
  MedialMesh pruned = mesh;
  drop_small_strata(pruned, {}, options);
  EXPECT_EQ(pruned.edges, (std::vector<Edge>{{0, 1}, {1, 2}, {2, 3}}));
  options.faint.assign(7, 1);
  pruned = mesh;
  drop_small_strata(pruned, {}, options);
  EXPECT_FALSE(pruned.edges.empty()) << "a curve of nothing but faint spheres is all that there is";
  options.faint.assign(7, 0);
  pruned = mesh;
  drop_small_strata(pruned, {}, options);
  EXPECT_EQ(pruned.edges, mesh.edges);
}

TEST(SmallStrata, BettiNumbersAndFixedEdgesStay) {
  std::mt19937 random(1);
  Index dropped = 0;
  for (int round = 0; round < 200; ++round) {
    std::uniform_real_distribution<double> place(0, 2);
    std::uniform_int_distribution<Index> vertex(0, 11);
    std::vector<Vec3> places;
    for (int k = 0; k < 12; ++k) places.push_back({place(random), place(random), place(random)});
    std::set<Triangle> faces;
    while (faces.size() < 18) {
      Triangle t{vertex(random), vertex(random), vertex(random)};
      std::sort(t.begin(), t.end());
      if (t[0] < t[1] && t[1] < t[2]) faces.insert(t);
    }
    MedialMesh mesh = mesh_of(places, {faces.begin(), faces.end()});
    const std::vector<Edge> fixed(mesh.edges.begin(), mesh.edges.begin() + 4);
    const MedialMesh before = mesh;
    const std::vector<Index> left = drop_small_strata(mesh, fixed, {.spacing = 1.5, .cover = 1});
    EXPECT_EQ(betti_numbers(mesh), betti_numbers(before)) << round;
    dropped += mesh.faces.size() < before.faces.size();
    std::vector<Index> number(before.centers.size(), kInvalid);
    for (Index v = 0; v < count(left); ++v) number[uz(left[uz(v)])] = v;
    for (const Edge& e : fixed) {
      const Edge now{number[uz(e[0])], number[uz(e[1])]};
      EXPECT_TRUE(std::binary_search(mesh.edges.begin(), mesh.edges.end(), now)) << round;
    }
    EXPECT_TRUE(std::is_sorted(mesh.edges.begin(), mesh.edges.end()));
    EXPECT_TRUE(std::is_sorted(mesh.faces.begin(), mesh.faces.end()));
    MedialMesh again = mesh;
    std::vector<Edge> fixed_now;
    for (const Edge& e : fixed) fixed_now.push_back({number[uz(e[0])], number[uz(e[1])]});
    drop_small_strata(again, fixed_now, {.spacing = 1.5, .cover = 1});
    EXPECT_EQ(again.faces, mesh.faces) << "nothing is left to do";
  }
  EXPECT_GT(dropped, 20);
}

}  // namespace
}  // namespace matstruct
