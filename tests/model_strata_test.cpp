// trace_strata() on complexes whose strata are known: books of half planes, the medial axis of a box, curves alone.

#include <matstruct/strata.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "base/index.h"

namespace matstruct {
namespace {

MedialMesh mesh_of(Index vertices, std::vector<Triangle> faces, std::vector<Edge> more_edges = {}) {
  MedialMesh mesh;
  mesh.centers.resize(uz(vertices));
  mesh.radii.resize(uz(vertices), 1);
  mesh.types.resize(uz(vertices));
  std::set<Edge> edges(more_edges.begin(), more_edges.end());
  for (Triangle& f : faces) {
    std::sort(f.begin(), f.end());
    for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}}) edges.insert({f[uz(a)], f[uz(b)]});
  }
  std::sort(faces.begin(), faces.end());
  mesh.faces = std::move(faces);
  mesh.edges.assign(edges.begin(), edges.end());
  return mesh;
}

// Polygons of the medial axis, each cut into a fan.
std::vector<Triangle> fans(const std::vector<std::vector<Index>>& polygons) {
  std::vector<Triangle> faces;
  for (const auto& p : polygons)
    for (std::size_t k = 2; k < p.size(); ++k) faces.push_back({p[0], p[k - 1], p[k]});
  return faces;
}

std::size_t closed(const std::vector<Curve>& curves) {
  return static_cast<std::size_t>(
      std::count_if(curves.begin(), curves.end(), [](const Curve& c) { return c.closed(); }));
}

TEST(Strata, NothingAtAll) {
  const Strata s = trace_strata({});
  EXPECT_EQ(s.sheets, 0);
  EXPECT_TRUE(s.seams.empty() && s.boundaries.empty() && s.curves.empty() && s.junctions.empty());
}

TEST(Strata, ThreeLeavesOfABook) {
  // The spine 0 1 2, and a strip of four triangles on each leaf.
  std::vector<Triangle> faces;
  for (Index leaf = 0; leaf < 3; ++leaf) {
    const Index a = 3 + 3 * leaf;
    for (const Triangle& f : {Triangle{0, 1, a}, {1, a, a + 1}, {1, 2, a + 1}, {2, a + 1, a + 2}}) faces.push_back(f);
  }
  const Strata s = trace_strata(mesh_of(12, faces));
  EXPECT_EQ(s.sheets, 3);
  ASSERT_EQ(s.seams.size(), 1u);
  EXPECT_EQ(s.seams[0].vertices, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(s.seams[0].sheets, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(s.boundaries.size(), 3u);
  for (const Curve& b : s.boundaries) {
    EXPECT_EQ(b.vertices.size(), 5u);
    EXPECT_EQ(b.sheets.size(), 1u);
  }
  EXPECT_TRUE(s.curves.empty());
  EXPECT_TRUE(s.junctions.empty());  // a single seam that ends is no junction
}

TEST(Strata, BoxOfThreeDifferentEdges) {
  // Corners 0..7, bit k for the side in direction k; the middle rectangle 8..11 at the heights where four sheets meet.
  // Box 2a < 2b < 2c: junctions at (0, +-(b - a), +-(c - a)).
  const auto corner = [](int x, int y, int z) { return static_cast<Index>(x + 2 * y + 4 * z); };
  const auto middle = [](int y, int z) { return static_cast<Index>(8 + y + 2 * z); };
  std::vector<std::vector<Index>> sheets{{middle(0, 0), middle(1, 0), middle(1, 1), middle(0, 1)}};
  for (int p = 0; p < 2; ++p)
    for (int q = 0; q < 2; ++q) {
      sheets.push_back({corner(0, p, q), corner(1, p, q), middle(p, q)});                // edges along x
      sheets.push_back({corner(p, 0, q), corner(p, 1, q), middle(1, q), middle(0, q)});  // along y
      sheets.push_back({corner(p, q, 0), corner(p, q, 1), middle(q, 1), middle(q, 0)});  // along z
    }
  const Strata s = trace_strata(mesh_of(12, fans(sheets)));
  EXPECT_EQ(s.sheets, 13);
  EXPECT_EQ(s.seams.size(), 12u);
  EXPECT_EQ(s.boundaries.size(), 12u);
  EXPECT_EQ(s.junctions, (std::vector<Index>{8, 9, 10, 11}));
  for (const Curve& seam : s.seams) EXPECT_EQ(seam.sheets.size(), 3u);
}

TEST(Strata, MoebiusStrip) {
  std::vector<Triangle> faces;
  for (Index k = 0; k < 5; ++k) faces.push_back({k, (k + 1) % 5, (k + 2) % 5});
  const Strata s = trace_strata(mesh_of(5, faces));
  EXPECT_EQ(s.sheets, 1);
  ASSERT_EQ(s.boundaries.size(), 1u);
  EXPECT_TRUE(s.boundaries[0].closed());
  EXPECT_EQ(s.boundaries[0].vertices.size(), 6u);
}

TEST(Strata, ClosedSeam) {
  // Three discs that share their rim 0 1 2 3, with middles 4, 5, 6.
  std::vector<Triangle> faces;
  for (Index disc = 4; disc < 7; ++disc)
    for (Index k = 0; k < 4; ++k) faces.push_back({k, (k + 1) % 4, disc});
  const Strata s = trace_strata(mesh_of(7, faces));
  EXPECT_EQ(s.sheets, 3);
  ASSERT_EQ(s.seams.size(), 1u);
  EXPECT_TRUE(s.seams[0].closed());
  EXPECT_EQ(s.seams[0].vertices.size(), 5u);
  EXPECT_TRUE(s.junctions.empty());
}

TEST(Strata, MedialCurvesEndWhereTheyMeetASheet) {
  // A path 0 1 2 that runs into the corner 2 of a triangle, and a ring 5 6 7 elsewhere.
  const Strata s = trace_strata(mesh_of(8, {{2, 3, 4}}, {{0, 1}, {1, 2}, {5, 6}, {6, 7}, {5, 7}}));
  EXPECT_EQ(s.sheets, 1);
  ASSERT_EQ(s.curves.size(), 2u);
  EXPECT_EQ(s.curves[0].vertices, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(closed(s.curves), 1u);
  ASSERT_EQ(s.boundaries.size(), 1u);
  EXPECT_TRUE(s.boundaries[0].closed());  // from the vertex where the curve arrives, around, and back
  EXPECT_EQ(s.boundaries[0].vertices.front(), 2);
}

TEST(Strata, ASeamBreaksWhereItsSheetsChange) {
  // The spine 0 1 2; two leaves along all of it, a third along 0 1 and a fourth along 1 2.
  std::vector<Triangle> faces;
  for (const Index a : {3, 6}) {
    for (const Triangle& f : {Triangle{0, 1, a}, {1, a, a + 1}, {1, 2, a + 1}, {2, a + 1, a + 2}}) faces.push_back(f);
  }
  faces.push_back({0, 1, 9});
  faces.push_back({1, 2, 10});
  const Strata s = trace_strata(mesh_of(11, faces));
  EXPECT_EQ(s.sheets, 4);
  EXPECT_EQ(s.seams.size(), 2u);
  EXPECT_EQ(s.junctions, (std::vector<Index>{1}));
}

}  // namespace
}  // namespace matstruct
