// The oracle of convex solids against counts known by hand, its own equations and Euler's formula.
#include "convex_oracle.h"

#include <gtest/gtest.h>

#include <matstruct/metrics.h>

namespace matstruct::oracle {
namespace {

struct Counts {
  std::size_t sheets = 0, seams = 0;
  Index junctions = 0, corners = 0;
  friend bool operator==(const Counts&, const Counts&) = default;
  friend void PrintTo(const Counts& c, std::ostream* out) {
    *out << c.sheets << " sheets, " << c.seams << " seams, " << c.junctions << " junctions, " << c.corners
         << " corners";
  }
};

Counts counts(const ConvexPolyhedron& solid) {
  const ConvexAxis axis = medial_axis(solid);
  return {axis.sheets.size(), axis.seams.size(), axis.junctions(), axis.corners()};
}

double signed_volume(const TriSurface& surface) {
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles)
    sum += dot(surface.vertices[uz(a)], cross(surface.vertices[uz(b)], surface.vertices[uz(c)])) / 6;
  return sum;
}

std::vector<ConvexPolyhedron> solids() {
  std::vector<ConvexPolyhedron> list{box(1, 1, 1),       box(1, 1, 2),       box(1, 2, 3),     tetrahedron(),
                                     prism(3, 0.5, 2),   prism(5, 0.4, 0.5), prism(6, 0.5, 1), prism(12, 1, 1),
                                     pyramid(4, 0.5, 1), pyramid(7, 1, 0.4)};
  for (int faces = 6; faces <= 20; faces += 2)
    list.push_back(random_convex_polyhedron(static_cast<std::uint64_t>(100 + faces), faces));
  list.push_back(random_convex_polyhedron(7, 10, 0));
  return list;
}

TEST(ConvexOracle, KnowsTheAxisOfABox) {
  EXPECT_EQ(counts(box(1, 2, 3)), (Counts{13, 12, 4, 8}));
  EXPECT_EQ(counts(box(1, 1, 2)), (Counts{12, 9, 2, 8}));
  EXPECT_EQ(counts(box(1, 2, 2)), (Counts{13, 12, 4, 8}));
  EXPECT_EQ(counts(box(1, 1, 1)), (Counts{12, 8, 1, 8}));
}

TEST(ConvexOracle, KnowsTheAxisOfSolidsThatTouchOneSphere) {
  EXPECT_EQ(counts(tetrahedron()), (Counts{6, 4, 1, 4}));
  EXPECT_EQ(counts(pyramid(5, 0.5, 1)), (Counts{10, 6, 1, 6}));
  const ConvexPolyhedron random = random_convex_polyhedron(7, 10, 0);
  EXPECT_EQ(counts(random), (Counts{edges_of(random).size(), random.vertices.size(), 1, count(random.vertices)}));
}

TEST(ConvexOracle, KnowsTheAxisOfPrisms) {
  // High: the side faces meet in a segment. Flat: top and bottom meet in an n-gon.
  EXPECT_EQ(counts(prism(6, 0.5, 2)), (Counts{18, 13, 2, 12}));
  EXPECT_EQ(counts(prism(6, 1, 0.5)), (Counts{19, 18, 6, 12}));
}

TEST(ConvexOracle, SolidsAreClosedAndMeshesFillThem) {
  for (const ConvexPolyhedron& solid : solids()) {
    ASSERT_TRUE(solid.bounded() && solid.every_face_present());
    const auto edges = edges_of(solid);
    for (const auto& [edge, faces] : edges) EXPECT_EQ(faces.size(), 2u);
    EXPECT_EQ(count(solid.vertices) - count(edges) + count(solid.faces), 2);
    for (const Vec3& v : solid.vertices) EXPECT_NEAR(solid.depth(v), 0, 1e-9);

    const TetMesh tets = tet_mesh_of(solid);
    double volume = 0;
    for (const auto& [a, b, c, d] : tets.tets) {
      const auto& v = tets.vertices;
      const double six = dot(cross(v[uz(b)] - v[uz(a)], v[uz(c)] - v[uz(a)]), v[uz(d)] - v[uz(a)]);
      EXPECT_GT(six, 0);
      volume += six / 6;
    }
    EXPECT_NEAR(volume, signed_volume(surface_of(solid)), 1e-12 * volume);
    EXPECT_EQ(betti_numbers(tets), (Betti{1, 0, 0}));
  }
}

TEST(ConvexOracle, BoxHasItsMeasures) {
  const ConvexPolyhedron solid = box(1, 2, 3);
  EXPECT_NEAR(signed_volume(surface_of(solid)), 6, 1e-12);
  EXPECT_NEAR(least_turn(solid), 90, 1e-12);
  EXPECT_NEAR(shortest_edge(solid), 1, 1e-12);
  double sheet_area = 0;
  const ConvexAxis axis = medial_axis(solid);
  for (const AxisSheet& sheet : axis.sheets) sheet_area += area(axis.polygon(sheet));
  // Middle 1 x 2; 12 trapezoids of height sqrt(1/2): 4 each between parallel sides of 3 and 2, 2 and 1, 1 and 0.
  EXPECT_NEAR(sheet_area, 2 + 4 * std::sqrt(0.5) * (2.5 + 1.5 + 0.5), 1e-12);
}

TEST(ConvexOracle, SidesOfSheetsAreSeamsOrEdgesOfTheSolid) {
  for (const ConvexPolyhedron& solid : solids()) {
    const ConvexAxis axis = medial_axis(solid);
    for (const auto& [edge, sheets] : axis.seams) EXPECT_GE(sheets, 3);
    for (const auto& [edge, sheets] : axis.boundaries) EXPECT_EQ(sheets, 1);
    EXPECT_EQ(axis.boundaries.size(), edges_of(solid).size());
    EXPECT_EQ(axis.corners(), count(solid.vertices));
  }
}

TEST(ConvexOracle, AxisOfAConvexSolidIsContractible) {
  for (const ConvexPolyhedron& solid : solids())
    EXPECT_EQ(betti_numbers(medial_mesh_of(medial_axis(solid))), (Betti{1, 0, 0}));
}

TEST(ConvexOracle, PointsOfTheAxisHaveTwoNearestFaces) {
  for (const ConvexPolyhedron& solid : solids()) {
    const ConvexAxis axis = medial_axis(solid);
    for (const Vec3& x : sample_axis(axis, 200, 3)) {
      std::vector<double> distances;
      for (const HalfSpace& h : solid.half_spaces) distances.push_back(h.distance(x));
      std::sort(distances.begin(), distances.end());
      EXPECT_NEAR(distances[0], distances[1], 1e-9);
      EXPECT_GE(distances[0], -1e-12);
      EXPECT_NEAR(distance_to_axis(axis, x), 0, 1e-9);
    }
  }
}

// The axis is where the nearest face changes: between two points with different nearest faces lies a point of the axis.
TEST(ConvexOracle, TheNearestFaceChangesOnlyOnTheAxis) {
  const ConvexPolyhedron solid = random_convex_polyhedron(11, 12);
  const ConvexAxis axis = medial_axis(solid);
  const auto nearest_face = [&](const Vec3& x) {
    const auto& h = solid.half_spaces;
    return std::min_element(h.begin(), h.end(),
                            [&](const auto& p, const auto& q) { return p.distance(x) < q.distance(x); });
  };
  const auto inside = [&](KeyedRandom& random) {
    Vec3 x;
    do x = Vec3{random.uniform(), random.uniform(), random.uniform()} * 4 - Vec3{2, 2, 2};
    while (solid.depth(x) < 0);
    return x;
  };
  int changes = 0;
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    KeyedRandom random(1, 2, trial);
    Vec3 p = inside(random), q = inside(random);
    if (nearest_face(p) == nearest_face(q)) continue;
    ++changes;
    for (int step = 0; step < 50; ++step) {
      const Vec3 middle = lerp(p, q, 0.5);
      (nearest_face(middle) == nearest_face(p) ? p : q) = middle;
    }
    EXPECT_NEAR(distance_to_axis(axis, p), 0, 1e-9);
  }
  EXPECT_GT(changes, 100);
}

TEST(ConvexOracle, DistanceToTheAxisOfACubeInClosedForm) {
  const ConvexAxis axis = medial_axis(box(2, 2, 2));
  // The axis is the union of the planes |y| = |z| = max etc.; above the face z = 1 the nearest sheets are z = |x|, z =
  // |y|.
  EXPECT_NEAR(distance_to_axis(axis, {0, 0, 1}), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(distance_to_axis(axis, {0.5, 0, 1}), 0.5 * std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(distance_to_axis(axis, {0, 0, 0}), 0, 1e-12);
}

TEST(ConvexOracle, RandomSolidsCanBeAskedToBeSharp) {
  for (int faces = 6; faces <= 12; ++faces) EXPECT_GE(least_turn(random_convex_polyhedron(5, faces, 0.25, 35)), 35);
}

}  // namespace
}  // namespace matstruct::oracle
