// Distances of many points at once are those of one search per point, to the last bit.
#include <gtest/gtest.h>

#include <cmath>

#include "base/index.h"
#include "base/random.h"
#include "metrics/medial_tree.h"

namespace matstruct {
namespace {

MedialMesh random_mesh(Index balls) {
  KeyedRandom random(3, 1, 0);
  MedialMesh mesh;
  for (Index v = 0; v < balls; ++v) {
    mesh.centers.push_back({random.uniform(), random.uniform(), random.uniform()});
    mesh.radii.push_back(0.2 * random.uniform());
    mesh.types.push_back(SphereType::kSheet);
  }
  for (Index v = 0; v + 2 < balls; v += 2) {
    mesh.edges.insert(mesh.edges.end(), {{v, v + 1}, {v, v + 2}, {v + 1, v + 2}});
    if (v % 4 == 0) mesh.faces.push_back({v, v + 1, v + 2});
  }
  return mesh;
}

TEST(MedialDistances, AreThoseOfSingleSearches) {
  const MedialMesh mesh = random_mesh(301);
  const MedialTree tree(mesh.centers, mesh.radii, maximal_primitives(mesh));
  KeyedRandom random(3, 2, 0);
  std::vector<Vec3> points;
  for (int k = 0; k < 6000; ++k) points.push_back(Vec3{random.uniform(), random.uniform(), random.uniform()} * 2);
  for (int k = 0; k < 3000; ++k)  // a dense cluster, and points more than once
    points.push_back(Vec3{0.5, 0.5, 0.5} +
                     Vec3{random.uniform(), random.uniform(), std::floor(9 * random.uniform())} / 50);
  points.insert(points.end(), 100, mesh.centers[0]);
  Context one, two;
  one.threads = 1;
  two.threads = 2;
  const std::vector<double> distances = tree.distances(points, one);
  ASSERT_EQ(distances.size(), points.size());
  for (std::size_t p = 0; p < points.size(); ++p) ASSERT_EQ(distances[p], tree.closest(points[p]).distance) << p;
  EXPECT_EQ(distances, tree.distances(points, two));
}

TEST(MedialDistances, OfNothing) {
  const MedialTree tree({}, {}, {});
  EXPECT_TRUE(tree.distances({}, Context{}).empty());
  EXPECT_EQ(tree.distances({{1, 2, 3}}, Context{}), (std::vector<double>{std::numeric_limits<double>::infinity()}));
}

}  // namespace
}  // namespace matstruct
