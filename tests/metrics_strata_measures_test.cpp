// Spacing, structure counts and comparison of medial meshes whose numbers are known by hand.
#include <gtest/gtest.h>

#include <cmath>

#include <matstruct/error.h>
#include <matstruct/metrics.h>

#include "convex_oracle.h"
#include "refined.h"

namespace matstruct {
namespace {

MedialMesh box_axis(double a, double b, double c, int rounds) {
  return refined(oracle::medial_mesh_of(oracle::medial_axis(oracle::box(a, b, c))), rounds);
}

TEST(Spacing, PerKindOfEdge) {
  // Three triangles on the edge 0 1 of length 2, a curve 5 6 of length 3 and 6 7 of length 1.
  MedialMesh mesh{{{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {5, 0, 0}, {8, 0, 0}, {8, 1, 0}},
                  std::vector<double>(8, 1),
                  std::vector<SphereType>(8),
                  {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2}, {1, 3}, {1, 4}, {5, 6}, {6, 7}},
                  {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  const Spacing s = spacing(mesh);
  EXPECT_EQ(s.sheets.edges, 0);
  EXPECT_EQ(s.sheets.mean, 0);
  EXPECT_EQ(s.seams.edges, 1);
  EXPECT_EQ(s.seams.mean, 2);
  EXPECT_EQ(s.seams.variation, 0);
  EXPECT_EQ(s.boundaries.edges, 6);
  EXPECT_NEAR(s.boundaries.mean, std::sqrt(2.0), 1e-15);
  EXPECT_EQ(s.curves.edges, 2);
  EXPECT_EQ(s.curves.min, 1);
  EXPECT_EQ(s.curves.max, 3);
  EXPECT_EQ(s.curves.mean, 2);
  EXPECT_EQ(s.curves.variation, 0.5);
}

TEST(StructureCounts, OfABoxWhateverTheTriangulation) {
  for (const int rounds : {0, 1, 2}) {
    const StructureCounts s = structure_counts(box_axis(1, 2, 3, rounds));
    EXPECT_EQ(s, (StructureCounts{.sheets = 13, .seams = 12, .boundaries = 12, .junctions = 4, .corners = 8}));
  }
}

TEST(Comparison, OfAMeshWithItsRefinement) {
  Context context;
  const MeshComparison c = compare_meshes(box_axis(1, 2, 3, 0), box_axis(1, 2, 3, 2), 2000, context);
  EXPECT_LE(c.hausdorff(), 1e-12);
  EXPECT_LE(c.first_to_second.max_radius_difference, 1e-12);
  EXPECT_LE(c.second_to_first.max_radius_difference, 1e-12);
  EXPECT_EQ(c.first, c.second);
}

TEST(Comparison, OfTwoParallelTriangles) {
  MedialMesh first{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {1, 1, 1}, {}, {{0, 1}, {0, 2}, {1, 2}}, {{0, 1, 2}}};
  first.types.resize(3);
  MedialMesh second = first;
  for (Vec3& c : second.centers) c.z = 0.25;
  second.radii = {1, 1, 2};  // the mean over the triangle differs by a third
  Context context;
  const MeshComparison c = compare_meshes(first, second, 5000, context);
  for (const auto& side : {c.first_to_second, c.second_to_first}) {
    EXPECT_NEAR(side.max_distance, 0.25, 1e-12);
    EXPECT_NEAR(side.mean_distance, 0.25, 1e-12);
    EXPECT_NEAR(side.max_radius_difference, 1, 1e-12);
    EXPECT_NEAR(side.mean_radius_difference, 1.0 / 3, 2e-3);
  }
}

TEST(Comparison, IsOneSidedWhereAPartIsMissing) {
  // A curve of length 4, of which the second mesh has the first half only.
  const MedialMesh first{{{0, 0, 0}, {2, 0, 0}, {4, 0, 0}}, {1, 1, 1}, {}, {{0, 1}, {1, 2}}, {}};
  const MedialMesh second{{{0, 0, 0}, {2, 0, 0}}, {1, 1}, {}, {{0, 1}}, {}};
  Context context;
  const MeshComparison c = compare_meshes(first, second, 1000, context);
  EXPECT_EQ(c.first_to_second.max_distance, 2);
  EXPECT_NEAR(c.first_to_second.mean_distance, 0.5, 1e-2);
  EXPECT_EQ(c.second_to_first.max_distance, 0);
  EXPECT_EQ(c.hausdorff(), 2);
}

TEST(Comparison, OfLoneSpheres) {
  const MedialMesh first{{{0, 0, 0}}, {1}, {}, {}, {}}, second{{{3, 4, 0}}, {2}, {}, {}, {}};
  Context context;
  const MeshComparison c = compare_meshes(first, second, 1, context);
  EXPECT_EQ(c.hausdorff(), 5);
  EXPECT_EQ(c.first_to_second.mean_distance, 5);
  EXPECT_EQ(c.first_to_second.mean_radius_difference, 1);
  EXPECT_THROW(compare_meshes(first, {}, 1, context), Error);
  EXPECT_THROW(compare_meshes(first, second, 0, context), Error);
}

}  // namespace
}  // namespace matstruct
