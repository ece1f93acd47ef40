// Sharp edges, lines and corners on surfaces with known angles.
#include "prepare/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "base/index.h"
#include "prepare/edge_heights.h"
#include "shapes.h"

namespace matstruct {
namespace {

Domain prepare(const TetMesh& mesh, const Options& options = {}) {
  Context context;
  return prepare_domain(mesh, options, context);
}

// A prism over an isosceles triangle whose apex angle, at the edge along z, is `degrees`.
TetMesh roof(double degrees) {
  const double half = degrees / 2 * std::numbers::pi / 180;
  const double x = std::sin(half), y = -std::cos(half);
  return shapes::convex({{0, 0, 0}, {x, y, 0}, {-x, y, 0}, {0, 0, 1}, {x, y, 1}, {-x, y, 1}},
                        {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}});
}

TEST(Features, DihedralAnglesOfAPrism) {
  for (const double degrees : {1.0, 60.0, 90.0, 149.0, 151.0, 179.0}) {
    SCOPED_TRACE(degrees);
    const Domain d = prepare(roof(degrees));
    const auto apex_edge = std::find_if(d.features.edges.begin(), d.features.edges.end(), [&](const SharpEdge& edge) {
      return edge.vertices == Edge{0, 3};
    });
    ASSERT_EQ(apex_edge != d.features.edges.end(), degrees < 150);
    if (degrees > 150) continue;
    EXPECT_EQ(apex_edge->kind, EdgeKind::kConvex);
    EXPECT_NEAR(apex_edge->dihedral, degrees * std::numbers::pi / 180, 1e-13);
  }
}

TEST(Features, AnglesOfOptionsAreUsed) {
  const TetMesh mesh = roof(140);  // the apex edge turns by 40 degrees
  EXPECT_EQ(count(prepare(mesh, {.convex_angle = 39}).features.edges), 9);
  EXPECT_EQ(count(prepare(mesh, {.convex_angle = 41}).features.edges), 8);
  const auto concave = [](double limit) {
    const Features features = prepare(shapes::l_profile(), {.concave_angle = limit}).features;
    return std::count_if(features.lines.begin(), features.lines.end(),
                         [](const FeatureLine& line) { return line.kind == EdgeKind::kConcave; });
  };
  EXPECT_EQ(concave(89), 1);
  EXPECT_EQ(concave(91), 0);
}

TEST(Features, ConcaveEdgesHaveReflexAngles) {
  for (const SharpEdge& edge : prepare(shapes::l_profile()).features.edges)
    EXPECT_NEAR(edge.dihedral, (edge.kind == EdgeKind::kConcave ? 1.5 : 0.5) * std::numbers::pi, 1e-14);
}

// Lines are paths: edge k joins vertex k and k + 1, every sharp edge is in exactly one line of its own kind, corners
// are the ends of open lines and never inside one.
TEST(Features, LinesPartitionTheSharpEdges) {
  for (const shapes::Shape& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const Features f = prepare(shape.mesh).features;
    const std::set<Index> corners(f.corners.begin(), f.corners.end());
    std::vector<int> used(f.edges.size(), 0);
    for (Index l = 0; l < count(f.lines); ++l) {
      const FeatureLine& line = f.lines[uz(l)];
      ASSERT_EQ(line.vertices.size(), line.edges.size() + (line.closed ? 0 : 1));
      for (std::size_t k = 0; k < line.edges.size(); ++k) {
        const SharpEdge& edge = f.edges[uz(line.edges[k])];
        const Index a = line.vertices[k], b = line.vertices[(k + 1) % line.vertices.size()];
        EXPECT_EQ(edge.vertices, ordered_edge(a, b));
        EXPECT_EQ(edge.kind, line.kind);
        EXPECT_EQ(edge.line, l);
        ++used[uz(line.edges[k])];
      }
      for (std::size_t k = 0; k < line.vertices.size(); ++k) {
        const bool end = !line.closed && (k == 0 || k + 1 == line.vertices.size());
        EXPECT_EQ(corners.count(line.vertices[k]) == 1, end);
      }
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), 1), count(f.edges));
  }
}

TEST(Features, TrianglesKnowTheirSharpEdges) {
  const Domain d = prepare(shapes::plate_with_hole());
  std::vector<int> seen(d.features.edges.size(), 0);
  for (Index t = 0; t < count(d.surface.triangles); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index e = d.features.triangle_edges[uz(t)][k];
      if (e == kInvalid) continue;
      ++seen[uz(e)];
      const SharpEdge& edge = d.features.edges[uz(e)];
      const Index a = d.surface.triangles[uz(t)][(k + 1) % 3], b = d.surface.triangles[uz(t)][(k + 2) % 3];
      EXPECT_EQ(edge.vertices, ordered_edge(a, b));
      EXPECT_EQ(edge.triangles[a < b ? 0 : 1], t);
    }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 2), count(d.features.edges));
}

TEST(Features, ClosedLinesHaveNoCorners) {
  const Features f = prepare(shapes::prism(1, 3, 24)).features;
  ASSERT_EQ(count(f.lines), 2);
  for (const FeatureLine& line : f.lines) {
    EXPECT_TRUE(line.closed);
    EXPECT_EQ(count(line.vertices), 24);
  }
}

TEST(Features, FacetsOfRoundFacesHaveAHeightAndPlanesNone) {
  constexpr double kSmooth = std::numbers::pi / 6;
  EXPECT_EQ(height_of_facets(prepare(shapes::box({1, 2, 3}, 2, 2, 2)), kSmooth), 0);
  for (const int n : {24, 48}) {
    const Domain domain = prepare(shapes::prism(1, 3, n, 2));
    const double half = std::numbers::pi / n;  // of a facet's width, and of the turn
    const double expected = 2 * std::sin(half) * std::sin(half) / 2;
    EXPECT_NEAR(height_of_facets(domain, kSmooth) / domain.frame.scale, expected, 1e-6) << n;
  }
}

TEST(Features, AFaintCreaseEndsAtCorners) {
  // A cube's top corner pushed in: with 60 degrees as limit only some edges stay sharp and lines end where they fade.
  TetMesh mesh = shapes::box({1, 1, 1}, 2, 2, 2);
  for (Vec3& p : mesh.vertices)
    if (p == Vec3{1, 1, 1}) p = {0.8, 0.8, 0.8};
  const Features f = prepare(mesh, {.convex_angle = 60}).features;
  std::vector<int> degree(mesh.vertices.size(), 0);
  for (const SharpEdge& edge : f.edges)
    for (const Index v : edge.vertices) ++degree[uz(v)];
  const auto faded = std::count(degree.begin(), degree.end(), 1);
  EXPECT_EQ(faded, 3);
  for (std::size_t v = 0; v < degree.size(); ++v)
    EXPECT_TRUE(degree[v] != 1 || std::count(f.corners.begin(), f.corners.end(), static_cast<Index>(v)) == 1);
}

TEST(Features, LinesBreakWhereTheyTurn) {
  // A square's rim is a closed line of four right angles only if its walls are faint: use a frustum with 20 degrees.
  const double side = 1, inset = 0.3;
  const double rise = inset * std::tan(35 * std::numbers::pi / 180);
  const TetMesh mesh =
      shapes::convex({{0, 0, 0},
                      {side, 0, 0},
                      {side, side, 0},
                      {0, side, 0},
                      {inset, inset, rise},
                      {side - inset, inset, rise},
                      {side - inset, side - inset, rise},
                      {inset, side - inset, rise}},
                     {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
  // Edges: base turns by 145 degrees, top rim by 35, slanted ones by arccos(cos^2 35) = 47.9.
  const Features all = prepare(mesh, {.convex_angle = 30}).features;
  EXPECT_EQ(count(all.lines), 12);
  const Features base_only = prepare(mesh, {.convex_angle = 60}).features;
  EXPECT_EQ(count(base_only.edges), 4);
  EXPECT_EQ(count(base_only.lines), 4);
  EXPECT_EQ(count(base_only.corners), 4);
}

}  // namespace
}  // namespace matstruct
