// Triangle quality and thinness on meshes whose numbers are known by hand.
#include <gtest/gtest.h>

#include <cmath>

#include <matstruct/metrics.h>

namespace matstruct {
namespace {

MedialMesh triangles(const std::vector<Vec3>& centers, const std::vector<Triangle>& faces) {
  return {centers, std::vector<double>(centers.size(), 1), {}, {}, faces};
}

TEST(TriangleQuality, OfSingleTriangles) {
  const double height = std::sqrt(3.0) / 2;
  EXPECT_NEAR(triangle_quality(triangles({{0, 0, 5}, {1, 0, 5}, {0.5, height, 5}}, {{0, 1, 2}})), 1, 1e-15);
  // Right angle with legs 3, 4: area 6, half perimeter 6, longest edge 5.
  EXPECT_NEAR(triangle_quality(triangles({{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}, {{0, 1, 2}})), 2 * std::sqrt(3.0) / 5,
              1e-15);
  EXPECT_EQ(triangle_quality(triangles({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}})), 0);
  EXPECT_EQ(triangle_quality(triangles({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}})), 0);
}

TEST(TriangleQuality, IsTheMeanOverFacesWhateverTheirSize) {
  const double height = std::sqrt(3.0) / 2;
  const std::vector<Vec3> centers{{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}, {300, 0, 0}, {0, 400, 0}};
  EXPECT_NEAR(triangle_quality(triangles(centers, {{0, 1, 2}, {0, 3, 4}})), (1 + 2 * std::sqrt(3.0) / 5) / 2, 1e-15);
}

TEST(TriangleQuality, IsZeroWithoutFaces) {
  EXPECT_EQ(triangle_quality(triangles({{0, 0, 0}}, {})), 0);
}

MedialMesh with_edges(Index vertices, const std::vector<Triangle>& faces, const std::vector<Edge>& edges) {
  return {std::vector<Vec3>(static_cast<std::size_t>(vertices)),
          std::vector<double>(static_cast<std::size_t>(vertices)),
          {},
          edges,
          faces};
}

TEST(Thinness, CountsTetrahedraAndPockets) {
  const std::vector<Edge> complete{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  const Thinness open = thinness(with_edges(4, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}}, complete));
  EXPECT_EQ(open.tetrahedra, 0);
  EXPECT_EQ(open.pockets, 0);
  const Thinness closed = thinness(with_edges(4, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}, complete));
  EXPECT_EQ(closed.tetrahedra, 1);
  EXPECT_EQ(closed.pockets, 1);
}

TEST(Thinness, TellsPocketsFromTetrahedra) {
  // An octahedron encloses a pocket but has no four vertices with all four faces.
  std::vector<Triangle> faces;
  std::vector<Edge> edges;
  for (const Index x : {0, 1})
    for (const Index y : {2, 3})
      for (const Index z : {4, 5}) faces.push_back({x, y, z});
  for (const Edge axis : {Edge{0, 2}, Edge{0, 4}, Edge{2, 4}})
    for (const Index i : {0, 1})
      for (const Index j : {0, 1}) edges.push_back({axis[0] + i, axis[1] + j});
  const Thinness octahedron = thinness(with_edges(6, faces, edges));
  EXPECT_EQ(octahedron.tetrahedra, 0);
  EXPECT_EQ(octahedron.pockets, 1);
}

TEST(Thinness, AllTetrahedraOfTheCompleteComplexOnFiveVertices) {
  std::vector<Triangle> faces;
  std::vector<Edge> edges;
  for (Index i = 0; i < 5; ++i)
    for (Index j = i + 1; j < 5; ++j) {
      edges.push_back({i, j});
      for (Index k = j + 1; k < 5; ++k) faces.push_back({k, i, j});
    }
  const Thinness complete = thinness(with_edges(5, faces, edges));
  EXPECT_EQ(complete.tetrahedra, 5);
  EXPECT_EQ(complete.pockets, 4);  // Euler characteristic 5 - 10 + 10 = 1 + b2, without tunnels
}

}  // namespace
}  // namespace matstruct
