// The steps of thinning on complexes small enough to know what must be left.

#include "extract/thinning.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include <matstruct/metrics.h>

#include "base/index.h"
#include "prepare/domain.h"
#include "shapes.h"

namespace matstruct {
namespace {

constexpr double kRadius = 0.1;

/// Spheres of one radius in the middle plane of a plate, and simplices between them.
struct Case {
  Spheres spheres;
  std::vector<TangentSphere> medial;
  DualComplex dual;
  SimplexClasses classes;

  Case(const std::vector<Vec3>& places, const std::vector<Triangle>& faces, const std::vector<Edge>& more_edges = {}) {
    std::set<Edge> edges(more_edges.begin(), more_edges.end());
    for (const Vec3& p : places) {
      dual.vertices.push_back(count(spheres.seeds));
      spheres.add({.center = p, .radius = kRadius});
      medial.push_back({p, kRadius, {}});
    }
    for (const auto& [a, b, c] : faces) edges.insert({{a, b}, {a, c}, {b, c}});
    dual.edges.assign(edges.begin(), edges.end());
    dual.triangles = faces;
    dual.lengths.assign(faces.size(), kRadius);
    classes.edge_contacts.assign(edges.size(), 2);
    classes.face_valid.assign(faces.size(), 1);
  }

  std::size_t edge(const Edge& e) const {
    return static_cast<std::size_t>(std::lower_bound(dual.edges.begin(), dual.edges.end(), e) - dual.edges.begin());
  }

  ThinMesh thinned(const std::vector<Edge>& features = {}, double cover = 0) const {
    Context context;
    static const Domain plate = prepare_domain(shapes::box({4, 4, 1}), {}, context);
    return thin(plate, spheres, medial, dual, classes, features, {.importance = 0, .cover = cover}, context);
  }
};

/// Two triangles of a sheet at the edge 0 1, and a third one, 0 1 4, that stands on it.
Case leaf_on_a_sheet() {
  Case c({{0, 0, 0}, {0.2, 0, 0}, {0.1, 0.2, 0}, {0.1, -0.2, 0}, {0.1, 0.01, 0.1}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}});
  c.dual.lengths[2] /= 10;
  return c;
}

TEST(ThinningFlaps, GoWhereNoSeamRuns) {
  const ThinMesh thin = leaf_on_a_sheet().thinned();
  EXPECT_EQ(thin.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}}));
  EXPECT_EQ(thin.mesh.edges.size(), 6u);
  EXPECT_EQ(betti_numbers(thin.mesh), (Betti{1, 0, 0}));
}

TEST(ThinningFlaps, StayOnSeams) {
  Case c = leaf_on_a_sheet();
  c.classes.edge_contacts[c.edge({0, 1})] = 3;
  EXPECT_EQ(c.thinned().mesh.faces.size(), 3u);
}

TEST(ThinningFlaps, StayWhereAllTheirFreeEdgesAreFeatures) {
  const Case c = leaf_on_a_sheet();
  const std::vector<Edge> features{{0, 2}, {0, 3}, {0, 4}, {1, 2}, {1, 3}, {1, 4}};
  EXPECT_EQ(c.thinned(features).mesh.faces.size(), 3u);
}

TEST(Thinning, AFlatTetrahedronLeavesOneTriangulationOfItsQuadrangle) {
  Case c({{0, 0, 0}, {0.2, 0, 0}, {0.2, 0.2, 0}, {0, 0.2, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}});
  c.dual.tets = {{0, 1, 2, 3}};
  const ThinMesh thin = c.thinned();
  ASSERT_EQ(thin.mesh.faces.size(), 2u);
  EXPECT_EQ(thin.mesh.edges.size(), 5u);
  EXPECT_EQ(betti_numbers(thin.mesh), (Betti{1, 0, 0}));
  double area = 0;
  for (const auto& [i, j, k] : thin.mesh.faces)
    area += 0.5 * norm(cross(thin.mesh.centers[uz(j)] - thin.mesh.centers[uz(i)],
                             thin.mesh.centers[uz(k)] - thin.mesh.centers[uz(i)]));
  EXPECT_NEAR(area, 0.04, 1e-15);
}

// Two flat tets beside each other, whose faces are of many heights: of each the wrong face may go first, and then the
// neighbour holds the diagonal of what is left.
TEST(Thinning, FlatTetrahedraSideBySideLeaveOneTriangulationOfTheirPentagon) {
  const std::vector<Edge> border{{0, 1}, {0, 3}, {1, 4}, {2, 3}, {2, 4}};
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> height(-1e-3, 1e-3);
    std::vector<Vec3> places{{0, 0.21, 0}, {0, 0, 0}, {0.32, 0.11, 0}, {0.16, 0.27, 0}, {0.16, -0.05, 0}};
    for (Vec3& p : places) p = Vec3{p.x / 4, p.y / 4, height(random)};
    Case c(places, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}, {1, 2, 4}, {1, 3, 4}, {2, 3, 4}});
    c.dual.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
    const ThinMesh thin = c.thinned(border);
    EXPECT_EQ(thin.mesh.faces.size(), 3u);
    EXPECT_EQ(thin.mesh.edges.size(), 7u);
    EXPECT_EQ(betti_numbers(thin.mesh), (Betti{1, 0, 0}));
  }
}

// Two sheets at the seam 1 2. The middle of the face 1 2 3 is in no stratum, as in a bend, and farthest off the axis;
// the edge 0 3 goes from sheet to sheet.
TEST(Thinning, FacesWithAnInvalidEdgeGoBeforeThoseInABend) {
  Case c({{0, -0.05, 0}, {-0.05, 0, 0.02}, {0.05, 0, 0.02}, {0, 0.05, 0.02}},
         {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}});
  c.dual.tets = {{0, 1, 2, 3}};
  c.classes.edge_contacts[c.edge({0, 3})] = 0;
  c.classes.edge_contacts[c.edge({1, 2})] = 3;
  c.classes.face_valid = {1, 0, 0, 0};
  EXPECT_EQ(c.thinned({{1, 3}, {2, 3}}).mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {1, 2, 3}}));
}

TEST(Thinning, InvalidFacesGoThroughTheirFreeEdges) {
  Case c({{0, 0, 0}, {0.2, 0, 0}, {0.1, 0.2, 0}, {0.1, -0.2, 0}}, {{0, 1, 2}, {0, 1, 3}});
  c.classes.face_valid[1] = 0;
  const ThinMesh thin = c.thinned();
  EXPECT_EQ(thin.mesh.faces, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(thin.face_invalid, (std::vector<std::uint8_t>{0}));
  // Nothing is free in the hollow tetrahedron: the invalid face stays, and is marked.
  Case hollow({{0, 0, 0}, {0.2, 0, 0}, {0.1, 0.2, 0}, {0.1, 0.1, 0.2}}, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}});
  hollow.classes.face_valid[0] = 0;
  EXPECT_EQ(hollow.thinned().mesh.faces.size(), 4u);
  EXPECT_EQ(hollow.thinned().face_invalid, (std::vector<std::uint8_t>{1, 0, 0, 0}));
}

TEST(Thinning, InvalidEdgesGoIfTheirBallsAreCovered) {
  Case c({{0, 0, 0}, {0.2, 0, 0}, {0.1, 0.2, 0}, {0.1, 0.25, 0}}, {{0, 1, 2}}, {{2, 3}});
  c.classes.edge_contacts[c.edge({2, 3})] = 0;
  EXPECT_EQ(c.thinned({}, 0.04).mesh.centers.size(), 4u);  // sticks out by 0.05
  EXPECT_EQ(invalid_edges(c.thinned({}, 0.04)).loose, (std::vector<Edge>{{2, 3}}));
  EXPECT_EQ(c.thinned({}, 0.06).mesh.centers.size(), 3u);
  EXPECT_EQ(c.thinned({{2, 3}}, 0.06).mesh.centers.size(), 4u);
  c.classes.edge_contacts[c.edge({2, 3})] = 1;  // a medial curve
  EXPECT_EQ(c.thinned({}, 0.06).mesh.centers.size(), 4u);
}

}  // namespace
}  // namespace matstruct
