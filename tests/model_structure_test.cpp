// structure_of() on the exact medial axis of a box and on small complexes: strata, measures, what bounds what, types.

#include <matstruct/structure.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/index.h"
#include "convex_oracle.h"

namespace matstruct {
namespace {

bool touches(const Structure& s, Index lower, Index higher) {
  return std::binary_search(s.adjacency.begin(), s.adjacency.end(), std::array{lower, higher});
}

MedialMesh triangle(std::vector<SphereType> types) {
  return {.centers = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}},
          .radii = {0, 1, 2},
          .types = std::move(types),
          .edges = {{0, 1}, {0, 2}, {1, 2}},
          .faces = {{0, 1, 2}}};
}

TEST(Structure, NothingAtAll) {
  const Structure s = structure_of({});
  EXPECT_EQ(s.strata(), 0);
  EXPECT_TRUE(s.adjacency.empty());
}

TEST(Structure, BoxOfThreeDifferentEdges) {
  const oracle::ConvexAxis axis = oracle::medial_axis(oracle::box(1, 2, 3));
  const MedialMesh mesh = oracle::medial_mesh_of(axis);
  const Structure s = structure_of(mesh);
  ASSERT_EQ(s.sheets.size(), 13u);
  EXPECT_EQ(s.seams.size(), 12u);
  EXPECT_EQ(s.boundaries.size(), 12u);
  EXPECT_EQ(s.junctions.size(), 4u);
  EXPECT_EQ(s.corners.size(), 8u);
  EXPECT_EQ(s.strata(), 49);
  // Every curve has two ends, every seam three sheets, every boundary one.
  EXPECT_EQ(s.adjacency.size(), 2u * 24 + 3 * 12 + 12);
  for (const PointStratum& j : s.junctions) EXPECT_EQ(j.seams.size(), 4u);
  for (const PointStratum& c : s.corners) {
    EXPECT_EQ(c.seams.size(), 1u);
    EXPECT_EQ(c.boundaries.size(), 3u);
  }
  for (const CurveStratum& b : s.boundaries) EXPECT_TRUE(b.sharp);
}

TEST(Structure, MeasuresOfABox) {
  const oracle::ConvexAxis axis = oracle::medial_axis(oracle::box(1, 2, 3));
  const Structure s = structure_of(oracle::medial_mesh_of(axis));
  std::multiset<long> areas, exact;  // in millionths
  for (const SheetStratum& sheet : s.sheets) areas.insert(std::lround(1e6 * sheet.area));
  for (const oracle::AxisSheet& sheet : axis.sheets) exact.insert(std::lround(1e6 * oracle::area(axis.polygon(sheet))));
  EXPECT_EQ(areas, exact);
  const auto middle = std::find_if(s.sheets.begin(), s.sheets.end(),
                                   [](const SheetStratum& sheet) { return sheet.boundaries.empty(); });
  ASSERT_NE(middle, s.sheets.end());
  EXPECT_NEAR(middle->area, 2, 1e-12);  // 1 x 2
  EXPECT_NEAR(middle->mean_radius, 0.5, 1e-12);
  EXPECT_NEAR(middle->min_radius, 0.5, 1e-12);
  EXPECT_NEAR(middle->max_radius, 0.5, 1e-12);
  EXPECT_EQ(middle->seams.size(), 4u);
  EXPECT_EQ(middle->junctions.size(), 4u);
  std::multiset<long> lengths;
  for (const CurveStratum& seam : s.seams) lengths.insert(std::lround(1e6 * seam.length));
  EXPECT_EQ(lengths.count(1000000), 2u);
  EXPECT_EQ(lengths.count(2000000), 2u);
  EXPECT_EQ(lengths.count(std::lround(1e6 * std::sqrt(0.75))), 8u);
}

TEST(Structure, EndsOfCurvesAreTheStrataThere) {
  const MedialMesh mesh = oracle::medial_mesh_of(oracle::medial_axis(oracle::box(1, 2, 3)));
  const Structure s = structure_of(mesh);
  for (Index k = 0; k < count(s.seams); ++k)
    for (const std::size_t end : {0u, 1u}) {
      const CurveStratum& seam = s.seams[uz(k)];
      const Index v = end == 0 ? seam.vertices.front() : seam.vertices.back(), id = seam.ends[end];
      ASSERT_GE(id, s.first_junction());
      const bool corner = id >= s.first_corner();
      EXPECT_EQ(corner, mesh.types[uz(v)] == SphereType::kCorner);
      const PointStratum& point =
          corner ? s.corners[uz(id - s.first_corner())] : s.junctions[uz(id - s.first_junction())];
      EXPECT_EQ(point.vertex, v);
      EXPECT_TRUE(touches(s, id, s.first_seam() + k));
    }
}

TEST(Structure, MeanRadiusIsTakenOverTheArea) {
  MedialMesh mesh = triangle({SphereType::kSheet, SphereType::kSheet, SphereType::kSheet});
  const SheetStratum sheet = structure_of(mesh).sheets.at(0);
  EXPECT_DOUBLE_EQ(sheet.area, 6);
  EXPECT_DOUBLE_EQ(sheet.mean_radius, 1);
  EXPECT_DOUBLE_EQ(sheet.min_radius, 0);
  EXPECT_DOUBLE_EQ(sheet.max_radius, 2);
  mesh.centers.assign(3, Vec3{});
  EXPECT_DOUBLE_EQ(structure_of(mesh).sheets.at(0).mean_radius, 1);
}

TEST(Structure, ABoundaryIsSharpOnlyIfAllOfItIs) {
  constexpr SphereType kSharp = SphereType::kSharpEdge;
  const Structure free = structure_of(triangle({kSharp, kSharp, SphereType::kSheet}));
  ASSERT_EQ(free.boundaries.size(), 1u);
  EXPECT_FALSE(free.boundaries[0].sharp);
  EXPECT_TRUE(free.boundaries[0].closed);
  EXPECT_DOUBLE_EQ(free.boundaries[0].length, 12);
  EXPECT_EQ(free.boundaries[0].ends, (std::array{kInvalid, kInvalid}));
  EXPECT_TRUE(structure_of(triangle({kSharp, kSharp, kSharp})).boundaries[0].sharp);
}

TEST(Structure, AMedialCurveThatEndsInASheetTouchesIt) {
  MedialMesh mesh = triangle({SphereType::kSheet, SphereType::kSheet, SphereType::kSheet});
  mesh.centers.push_back({8, 0, 0});
  mesh.radii.push_back(1);
  mesh.types.push_back(SphereType::kSheet);
  mesh.edges.push_back({1, 3});
  const Structure s = structure_of(mesh);
  ASSERT_EQ(s.curves.size(), 1u);
  EXPECT_DOUBLE_EQ(s.curves[0].length, 4);
  EXPECT_TRUE(touches(s, s.first_curve(), 0));
  EXPECT_TRUE(touches(s, s.first_boundary(), 0));
}

TEST(Structure, TypesFollowTheConnectivityButOnSharpLines) {
  // Three leaves on the spine 0 1 2; types are wrong but for the corner.
  MedialMesh mesh;
  mesh.centers.resize(6);
  mesh.radii.assign(6, 1);
  mesh.types = {SphereType::kCorner, SphereType::kJunction, SphereType::kSheet,
                SphereType::kSeam,   SphereType::kSheet,    SphereType::kSharpEdge};
  std::set<Edge> edges;
  for (const Index leaf : {3, 4, 5})
    for (const Triangle& f : {Triangle{0, 1, leaf}, {1, 2, leaf}}) {
      mesh.faces.push_back(f);
      edges.insert({{f[0], f[1]}, {f[0], f[2]}, {f[1], f[2]}});
    }
  std::sort(mesh.faces.begin(), mesh.faces.end());
  mesh.edges.assign(edges.begin(), edges.end());
  EXPECT_EQ(types_by_structure(mesh, structure_of(mesh)),
            (std::vector{SphereType::kCorner, SphereType::kSeam, SphereType::kSeam, SphereType::kSheet,
                         SphereType::kSheet, SphereType::kSharpEdge}));
  const MedialMesh box = oracle::medial_mesh_of(oracle::medial_axis(oracle::box(1, 2, 3)));
  EXPECT_EQ(types_by_structure(box, structure_of(box)), box.types);
}

}  // namespace
}  // namespace matstruct
