// The exact numbers of strata against Euler's formula, against trace_strata(), and against numbers known by hand.
#include <gtest/gtest.h>

#include <set>

#include <matstruct/metrics.h>

#include "refined.h"
#include "solids.h"
#include "structure_counts.h"

namespace matstruct {
namespace {

using oracle::NamedPolyhedron;

std::vector<NamedPolyhedron> convex_solids(int random) {
  std::vector<NamedPolyhedron> all = oracle::boxes();
  for (const auto& list : {oracle::prisms(), oracle::pyramids(), oracle::wedges(), oracle::random_polyhedra(random)})
    all.insert(all.end(), list.begin(), list.end());
  all.push_back({"tetrahedron", oracle::tetrahedron()});
  for (std::uint64_t seed = 0; seed < 5; ++seed)
    all.push_back(
        {"solid around one sphere", oracle::random_convex_polyhedron(seed, 8 + 2 * static_cast<int>(seed), 0)});
  return all;
}

std::vector<shapes::KnownStructure> known_solids() {
  std::vector<shapes::KnownStructure> all = shapes::profiles();
  for (const auto& list : {shapes::plates(), shapes::round_solids(48)}) all.insert(all.end(), list.begin(), list.end());
  return all;
}

StructureCounts structure_of(const oracle::ConvexPolyhedron& solid) {
  return oracle::structure_of(oracle::medial_axis(solid));
}

TEST(StructureOracle, KnowsDegenerateConvexSolids) {
  using Counts = StructureCounts;
  // Cube: all twelve sheets meet in the middle. Square section: the four long sheets meet along a seam.
  EXPECT_EQ(structure_of(oracle::box(1, 1, 1)),
            (Counts{.sheets = 12, .seams = 8, .boundaries = 12, .junctions = 1, .corners = 8}));
  EXPECT_EQ(structure_of(oracle::box(1, 1, 3)),
            (Counts{.sheets = 12, .seams = 9, .boundaries = 12, .junctions = 2, .corners = 8}));
  EXPECT_EQ(structure_of(oracle::box(1, 3, 3)),
            (Counts{.sheets = 13, .seams = 12, .boundaries = 12, .junctions = 4, .corners = 8}));
  EXPECT_EQ(oracle::medial_axis(oracle::box(1, 1, 3)).seams.size(), 9u);
  int of_four_sheets = 0;
  for (const auto& [edge, sheets] : oracle::medial_axis(oracle::box(1, 1, 3)).seams) of_four_sheets += sheets == 4;
  EXPECT_EQ(of_four_sheets, 1);
  // A prism as high as its inscribed circle is wide: one junction, sheets to all edges, seams to all corners.
  EXPECT_EQ(structure_of(oracle::prism(6, 1, 2)),
            (Counts{.sheets = 18, .seams = 12, .boundaries = 18, .junctions = 1, .corners = 12}));
  // A pyramid has one inscribed sphere that touches all faces.
  EXPECT_EQ(structure_of(oracle::pyramid(4, 1, 2)),
            (Counts{.sheets = 8, .seams = 5, .boundaries = 8, .junctions = 1, .corners = 5}));
}

TEST(StructureOracle, EulerOfConvexSolids) {
  for (const auto& [name, solid] : convex_solids(200)) {
    SCOPED_TRACE(name);
    const StructureCounts s = structure_of(solid);
    EXPECT_EQ(s.corners + s.junctions - s.seams - s.boundaries + s.sheets, 1);
    EXPECT_EQ(s.boundaries, count(oracle::edges_of(solid)));
    EXPECT_EQ(s.corners, count(solid.vertices));
  }
}

TEST(StructureOracle, TracedStrataOfTheExactAxisAgree) {
  for (const auto& [name, solid] : convex_solids(60)) {
    SCOPED_TRACE(name);
    const oracle::ConvexAxis axis = oracle::medial_axis(solid);
    EXPECT_EQ(structure_counts(refined(oracle::medial_mesh_of(axis), 1)), oracle::structure_of(axis));
  }
}

TEST(StructureOracle, RandomSolidsAreSharedByAllFaceNumbers) {
  std::set<std::size_t> faces;
  for (const auto& [name, solid] : oracle::random_polyhedra(30)) {
    EXPECT_TRUE(solid.bounded() && solid.every_face_present());
    faces.insert(solid.faces.size());
  }
  EXPECT_EQ(faces.size(), 15u);
  EXPECT_EQ(*faces.begin(), 6u);
  EXPECT_EQ(*faces.rbegin(), 20u);
}

// Open cells count as usual: a sheet 1 less its holes, an open curve -1, a closed one 0.
TEST(StructureOracle, EulerOfTheTables) {
  for (const auto& known : known_solids()) {
    SCOPED_TRACE(known.name);
    const StructureCounts& s = known.counts;
    const Index open_curves =
        s.seams - s.closed_seams + s.boundaries - s.closed_boundaries + s.curves - s.closed_curves;
    const Betti betti = betti_numbers(known.mesh);
    EXPECT_EQ(s.corners + s.junctions + known.free_ends - open_curves + s.sheets - known.holes,
              betti.b0 - betti.b1 + betti.b2);
  }
}

TEST(StructureOracle, SolidsOfTheTablesAreSolids) {
  for (const auto& known : known_solids()) {
    SCOPED_TRACE(known.name);
    for (const Tetrahedron& t : known.mesh.tets) EXPECT_GT(shapes::signed_volume(known.mesh, t), 0);
    std::map<Edge, int> balance;  // every edge of a closed oriented surface is used once in either direction
    for (const auto& [a, b, c] : shapes::boundary(known.mesh).triangles)
      for (const auto& [p, q] : {Edge{a, b}, Edge{b, c}, Edge{c, a}}) ++balance[{p, q}], --balance[{q, p}];
    for (const auto& [edge, n] : balance) EXPECT_EQ(n, 0);
  }
}

TEST(StructureOracle, FormulasOfExtrusionsHoldForConvexProfiles) {
  // A rectangle 1 x 2 has two nodes and five arcs, a triangle one node and three.
  const shapes::Profile rectangle{4, 2, 5, 4}, triangle{3, 1, 3, 3};
  EXPECT_EQ(shapes::tall(rectangle), structure_of(oracle::box(1, 2, 3)));
  EXPECT_EQ(shapes::flat(rectangle), structure_of(oracle::box(1, 2, 0.3)));
  EXPECT_EQ(shapes::tall(triangle), structure_of(oracle::prism(3, 1, 3)));
  EXPECT_EQ(shapes::flat(triangle), structure_of(oracle::prism(3, 1, 0.3)));
}

}  // namespace
}  // namespace matstruct
