// compute() finds the exact medial structure: the numbers of sheets, seams, junctions, corners, boundaries and medial
// curves. The expected ones are tested by themselves in metrics_solids_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include <matstruct/compute.h>
#include <matstruct/solid.h>

#include "solids.h"
#include "structure_counts.h"

namespace matstruct {
namespace {

// Every edge of a convex polyhedron bounds a sheet, however blunt.
Options all_edges_sharp() {
  return {.convex_angle = 0.5, .samples = 1000, .threads = 2};
}

StructureCounts computed(const TetMesh& solid, const Options& options) {
  Context context;
  return structure_counts(compute(solid, options, context).mesh);
}

// How many of a group are right, as a property of the test.
class Share {
 public:
  ~Share() { testing::Test::RecordProperty("right", fmt::format("{} of {}", right_, all_)); }
  void add(bool right) { ++all_, right_ += right; }

 private:
  int right_ = 0, all_ = 0;
};

void expect_exact(const std::vector<oracle::NamedPolyhedron>& solids) {
  Share share;
  for (const auto& [name, solid] : solids) {
    const oracle::ConvexAxis axis = oracle::medial_axis(solid);
    const StructureCounts found = computed(oracle::tet_mesh_of(solid), all_edges_sharp()),
                          exact = oracle::structure_of(axis);
    EXPECT_EQ(found, exact) << name << ", shortest edge of the axis " << oracle::shortest_edge(axis);
    share.add(found == exact);
  }
}

void expect_known(const std::vector<shapes::KnownStructure>& solids) {
  Share share;
  for (const auto& known : solids) {
    const StructureCounts found = computed(known.mesh, {.samples = 1000, .threads = 2});
    EXPECT_EQ(found, known.counts) << known.name;
    share.add(found == known.counts);
  }
}

TEST(ModelsStructureOfConvexSolids, Boxes) {
  expect_exact(oracle::boxes());
}

TEST(ModelsStructureOfConvexSolids, Prisms) {
  expect_exact(oracle::prisms());
}

TEST(ModelsStructureOfConvexSolids, Pyramids) {
  expect_exact(oracle::pyramids());
}

TEST(ModelsStructureOfConvexSolids, Wedges) {
  expect_exact(oracle::wedges());
}

TEST(ModelsStructureOfConvexSolids, RandomPolyhedra) {
  expect_exact(oracle::random_polyhedra(200));
}

TEST(ModelsStructureOfKnownSolids, Profiles) {
  expect_known(shapes::profiles());
}

TEST(ModelsStructureOfKnownSolids, Plates) {
  expect_known(shapes::plates());
}

TEST(ModelsStructureOfKnownSolids, RoundSolids) {
  expect_known(shapes::round_solids(96));
}

// Facets that turn by almost as much as a sharp edge have a flap of the axis each.
TEST(ModelsStructureOfSmoothShapes, CoarseFacetsMakeNoSheets) {
  for (const int n : {13, 14, 16, 20}) {
    const StructureCounts found = computed(shapes::torus(1.5, 1, 3 * n, n), {.samples = 1000, .threads = 2});
    EXPECT_EQ(found.sheets, 0) << n;
    EXPECT_EQ(found.curves, 1) << n;
  }
  std::vector<shapes::KnownStructure> round = shapes::round_solids(24);
  std::erase_if(round, [](const auto& known) { return known.name != "ball" && known.name != "prolate ellipsoid"; });
  ASSERT_EQ(round.size(), 2U);
  expect_known(round);
}

// Edges between facets stand out by more than the allowed deviation: no spheres go there, and no curves to them.
TEST(ModelsStructureOfCoarseCylinders, AxisIsOneCurve) {
  for (const int n : {15, 16, 18, 20, 24}) {
    std::vector<shapes::KnownStructure> high = shapes::round_solids(n);
    std::erase_if(high, [](const auto& known) { return known.name != "high cylinder"; });
    ASSERT_EQ(high.size(), 1U);
    expect_known(high);
  }
}

TEST(ModelsStructureOfSmoothShapes, AKnotOfCoarseFacetsIsMostlyACurve) {
  const std::filesystem::path file = std::filesystem::path(MATSTRUCT_SHARED_DATA) / "tet/quadknot.msh";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the shared models are not here";
  Context context;
  const Result result = compute(read_solids(file, {}, context).front(), {.samples = 10000, .threads = 2}, context);
  EXPECT_LE(result.structure.sheets.size(), 80U) << "hundreds if every edge between facets makes one";
  EXPECT_TRUE(result.report.guarantees_hold);
  EXPECT_LE(result.report.metrics.hausdorff_percent, 1.2);
}

// The noise of its facets makes fins of all sizes along the axis: none of them is the bottle's.
TEST(ModelsStructureOfScans, TheAxisOfABottleIsACurve) {
  const std::filesystem::path file = std::filesystem::path(MATSTRUCT_SHARED_DATA) / "tet/fuze.msh";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the shared models are not here";
  Context context;
  const Result result = compute(read_solids(file, {}, context).front(), {.samples = 1000, .threads = 2}, context);
  double longest = 0;
  for (const CurveStratum& curve : result.structure.curves) longest = std::max(longest, curve.length);
  EXPECT_GT(longest, 0.5 * result.report.input.diagonal);
  EXPECT_TRUE(result.report.guarantees_hold);
}

// Spheres denser than its noise is high can follow it: then its bumps are shape.
TEST(ModelsStructureOfScans, DenseSpheresFollowTheirBumps) {
  const std::filesystem::path file = std::filesystem::path(MATSTRUCT_SHARED_DATA) / "tet/fuze.msh";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the shared models are not here";
  Context context;
  const Result result =
      compute(read_solids(file, {}, context).front(), {.gamma = 120, .samples = 10000, .threads = 2}, context);
  EXPECT_TRUE(result.report.guarantees_hold);
  EXPECT_LE(result.report.metrics.hausdorff_percent, 1.2) << "2.5 if bumps as high as the noise burn";
}

// It touches itself along an edge: two violations are left with seams and without them, and more sets that can be split
// with them. Without seams seven of ten spheres that should be tangent to three contacts are not.
TEST(ModelsStructureOfTouchingSolids, KeepsItsSeams) {
  const std::filesystem::path file = std::filesystem::path(MATSTRUCT_SHARED_DATA) / "tet/not_convex.msh";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the shared models are not here";
  Context context;
  const Result result = compute(read_solids(file, {}, context).front(), {.samples = 1000, .threads = 2}, context);
  EXPECT_TRUE(result.report.guarantees_hold);
  EXPECT_LE(result.report.metrics.mser, 0.05);
}

TEST(ModelsStructureOfCadParts, IsThatOfTheirTriangulatedTwins) {
  const std::filesystem::path folder = MATSTRUCT_SHARED_DATA;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared models are not here";
  const auto structure = [](const std::filesystem::path& file) {
    Context context;
    const Result result = compute(read_solids(file, {}, context).front(), {.samples = 1000, .threads = 2}, context);
    return structure_counts(result.mesh);
  };
  // A fading sharp line may join its sheet to either of two others.
  constexpr int kParts = 10, kLeastSame = 9;
  int same = 0;
  for (int i = 1; i <= kParts; ++i) {
    const std::string name = fmt::format("part-{}", i);
    const StructureCounts cad = structure(folder / "cad" / (name + ".step")),
                          twin = structure(folder / "surface" / (name + ".stl"));
    same += cad.sheets == twin.sheets && cad.seams == twin.seams && cad.junctions == twin.junctions;
  }
  EXPECT_GE(same, kLeastSame);
}

}  // namespace
}  // namespace matstruct
