// Seams traced on convex polyhedra against the exact medial axis.
#include <gtest/gtest.h>

#include "convex_oracle.h"
#include "spheres/seams.h"

namespace matstruct {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Counts {
  Index junctions = 0, seams = 0;
  friend bool operator==(const Counts&, const Counts&) = default;
};

Counts traced(const oracle::ConvexPolyhedron& solid, double spacing) {
  Context context;
  const Domain domain = prepare_domain(oracle::tet_mesh_of(solid), {.convex_angle = 0.1}, context);
  ContactFinder finder(domain, 0.1 * kDegree);
  SeamNetwork network;
  trace_seams(finder, {}, {spacing}, network, context);
  Counts counts;
  counts.seams = count(network.curves);
  for (const SeamNode& node : network.nodes) {
    counts.junctions += node.corner == kInvalid;
    if (node.corner == kInvalid) {
      EXPECT_NEAR(solid.depth(domain.frame.to_input(node.sphere.center)), node.sphere.radius / domain.frame.scale,
                  1e-8);
    }
  }
  for (const SeamCurve& curve : network.curves) {
    EXPECT_NE(curve.begin, kInvalid);
    EXPECT_NE(curve.end, kInvalid);
    for (const TangentSphere& s : curve.spheres)
      EXPECT_NEAR(solid.depth(domain.frame.to_input(s.center)), s.radius / domain.frame.scale, 1e-8);
  }
  return counts;
}

Counts exact(const oracle::ConvexPolyhedron& solid) {
  const oracle::ConvexAxis axis = oracle::medial_axis(solid);
  return {axis.junctions(), static_cast<Index>(axis.seams.size())};
}

void expect_exact(const oracle::ConvexPolyhedron& solid, const std::string& name) {
  for (const double spacing : {0.03, 0.3}) {
    const Counts found = traced(solid, spacing), wanted = exact(solid);
    EXPECT_EQ(found.junctions, wanted.junctions) << name << " at spacing " << spacing;
    EXPECT_EQ(found.seams, wanted.seams) << name << " at spacing " << spacing;
  }
}

TEST(Seams, Boxes) {
  expect_exact(oracle::box(1, 1, 1), "cube");
  expect_exact(oracle::box(1, 1, 2), "square column");
  expect_exact(oracle::box(1, 2, 2), "square slab");
  expect_exact(oracle::box(1, 2, 3), "box");
  expect_exact(oracle::box(1, 1.001, 1.01), "nearly a cube");
}

TEST(Seams, PrismsAndPyramids) {
  for (int n = 3; n <= 8; ++n) {
    expect_exact(oracle::prism(n, 1, 1), "prism " + std::to_string(n));
    expect_exact(oracle::prism(n, 1, 3), "tall prism " + std::to_string(n));
    expect_exact(oracle::pyramid(n, 1, 1.3), "pyramid " + std::to_string(n));
  }
}

TEST(Seams, RandomConvexPolyhedra) {
  for (std::uint64_t seed = 0; seed < 300; ++seed)
    expect_exact(oracle::random_convex_polyhedron(seed, 6 + static_cast<int>(seed % 15)),
                 "random " + std::to_string(seed));
}

}  // namespace
}  // namespace matstruct
