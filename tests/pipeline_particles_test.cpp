// Whole computations in which the spheres spread as particles: structure and guarantees stay, the spheres become even.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <matstruct/compute.h>

#include "convex_oracle.h"
#include "solids.h"
#include "structure_counts.h"

namespace matstruct {
namespace {

constexpr double kTangent = 1e-6;  // in diagonals

Result computed(const TetMesh& solid, const Options& options) {
  Context context;
  return compute(solid, options, context);
}

Options spreading(double gamma, int rounds) {
  Options options{.gamma = gamma, .samples = 1000, .threads = 2};
  options.particle_rounds = rounds;
  options.particle_change = 0;
  return options;
}

void expect_exact(const Result& result, const StructureCounts& counts) {
  EXPECT_TRUE(result.report.guarantees_hold);
  EXPECT_EQ(structure_counts(result.mesh), counts);
  EXPECT_LE(result.report.structure.worst_tangency, kTangent);
}

// Standard deviation over mean of the distance to the nearest other vertex, over those inside sheets.
double variation(const MedialMesh& mesh) {
  double n = 0, sum = 0, sum2 = 0;
  for (std::size_t a = 0; a < mesh.centers.size(); ++a) {
    if (mesh.types[a] != SphereType::kSheet) continue;
    double least2 = std::numeric_limits<double>::max();
    for (std::size_t b = 0; b < mesh.centers.size(); ++b)
      if (a != b) least2 = std::min(least2, distance2(mesh.centers[a], mesh.centers[b]));
    n += 1, sum += std::sqrt(least2), sum2 += least2;
  }
  return std::sqrt(n * sum2 - sum * sum) / sum;
}

TEST(Particles, KeepTheStructureOfABox) {
  const oracle::ConvexPolyhedron box = oracle::box(2, 3, 5);
  const StructureCounts counts = oracle::structure_of(oracle::medial_axis(box));
  for (const bool remesh : {false, true}) {
    Options options = spreading(16, 3);
    options.remesh = remesh;
    const Result result = computed(oracle::tet_mesh_of(box), options);
    EXPECT_EQ(result.report.particles.rounds, 3);
    expect_exact(result, counts);
  }
}

TEST(Particles, KeepTheStructureOfSolidsWithConcaveEdges) {
  for (const auto& shape : shapes::profiles()) {
    SCOPED_TRACE(shape.name);
    expect_exact(computed(shape.mesh, spreading(20, 2)), shape.counts);
  }
}

TEST(Particles, WithoutProjectionOfTheGradientAllIsKeptToo) {
  const oracle::ConvexPolyhedron box = oracle::box(2, 3, 5);
  Options options = spreading(16, 2);
  options.gradient_projection = false;
  expect_exact(computed(oracle::tet_mesh_of(box), options), oracle::structure_of(oracle::medial_axis(box)));
}

TEST(Particles, BecomeEven) {
  const TetMesh plate = oracle::tet_mesh_of(oracle::box(5, 6, 0.5));
  Options options = spreading(30, 0);
  options.refinements = 0;
  options.remesh = false;
  const double before = variation(computed(plate, options).mesh);
  options.particle_rounds = 3;
  EXPECT_LT(variation(computed(plate, options).mesh), 0.6 * before);
}

TEST(Particles, SettleBeforeTheCap) {
  Options options = spreading(16, 30);
  options.particle_change = Options{}.particle_change;
  const Report report = computed(oracle::tet_mesh_of(oracle::box(2, 3, 5)), options).report;
  EXPECT_TRUE(report.particles.converged);
  EXPECT_GE(report.particles.rounds, 1);
  EXPECT_LT(report.particles.rounds, 30);
}

TEST(Particles, NoRoundsAreNoStage) {
  const Report report = computed(oracle::tet_mesh_of(oracle::box(2, 3, 5)), spreading(8, 0)).report;
  EXPECT_EQ(report.particles.rounds, 0);
  EXPECT_FALSE(report.particles.converged);
  for (const StageCost& stage : report.stages) EXPECT_NE(stage.name, "spreading particles");
}

TEST(Particles, SameForOneAndTwoThreads) {
  for (const TetMesh& solid : {oracle::tet_mesh_of(oracle::box(2, 3, 5)), shapes::l_profile()}) {
    Options options = spreading(16, 2);
    options.threads = 1;
    const MedialMesh one = computed(solid, options).mesh;
    options.threads = 2;
    const MedialMesh two = computed(solid, options).mesh;
    EXPECT_EQ(one.centers, two.centers);
    EXPECT_EQ(one.radii, two.radii);
    EXPECT_EQ(one.faces, two.faces);
  }
}

}  // namespace
}  // namespace matstruct
