// Erosion against what a fire on known sheets leaves: wedges between planes, whose balls have a known radius.

#include "extract/erosion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include <matstruct/metrics.h>

#include "base/index.h"

namespace matstruct {
namespace {

constexpr int kAround = 600, kRows = 20;
constexpr double kStep = 0.05;

/// A thin mesh from balls and faces; edges are those of the faces and more.
ThinMesh thin_of(std::vector<Vec3> centers, std::vector<double> radii, const std::vector<Triangle>& faces,
                 std::vector<Edge> edges = {}) {
  ThinMesh thin;
  thin.mesh.types.assign(centers.size(), SphereType::kSheet);
  for (Index v = 0; v < count(centers); ++v) thin.spheres.push_back(v);
  thin.mesh.centers = std::move(centers);
  thin.mesh.radii = std::move(radii);
  for (Triangle f : faces) {
    std::sort(f.begin(), f.end());
    thin.mesh.faces.push_back(f);
    edges.insert(edges.end(), {{f[0], f[1]}, {f[0], f[2]}, {f[1], f[2]}});
  }
  std::sort(thin.mesh.faces.begin(), thin.mesh.faces.end());
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  thin.mesh.edges = std::move(edges);
  thin.edge_contacts.assign(thin.mesh.edges.size(), 3);
  thin.face_invalid.assign(thin.mesh.faces.size(), 0);
  return thin;
}

/// Wedges that stand on a circle of radius 5: sheets of `depth` rows each, the first outward, the second upward, the
/// third downward, their outermost vertices on sharp edges, `half` the angle between their faces. A ball at depth d
/// below the edge has radius d sin(half); those of the circle are as if the first wedge were alone. Spheres are
/// numbered by rows, the circle first.
ThinMesh wedges(double half, const std::vector<int>& depths) {
  constexpr std::array<double, 3> kOut{1, 0, 0}, kUp{0, 1, -1};
  std::vector<Vec3> centers;
  std::vector<double> radii;
  std::vector<Triangle> faces;
  const auto add_row = [&](double radius, double height, double ball) {
    for (int k = 0; k < kAround; ++k) {
      const double turn = 2 * std::numbers::pi * k / kAround;
      centers.push_back({radius * std::cos(turn), radius * std::sin(turn), height});
      radii.push_back(ball);
    }
  };
  add_row(5, 0, depths[0] * kStep * std::sin(half));
  for (std::size_t w = 0; w < depths.size(); ++w) {
    Index before = 0;
    for (int row = 1; row <= depths[w]; ++row) {
      const Index here = count(centers);
      add_row(5 + kOut[w] * row * kStep, kUp[w] * row * kStep, (depths[w] - row) * kStep * std::sin(half));
      for (int k = 0; k < kAround; ++k) {
        const int next = (k + 1) % kAround;
        faces.insert(faces.end(), {{here + k, here + next, before + next}, {here + k, before + k, before + next}});
      }
      before = here;
    }
  }
  return thin_of(std::move(centers), std::move(radii), faces);
}

std::set<Triangle> faces_left(const ThinMesh& thin) {
  std::set<Triangle> faces;
  for (const auto& [a, b, c] : thin.mesh.faces)
    faces.insert({thin.spheres[uz(a)], thin.spheres[uz(b)], thin.spheres[uz(c)]});
  return faces;
}

TEST(Erosion, BurnsAWedgeToTheDepthOfTheHeight) {
  for (const double half : {0.4, 1.0, 1.4}) {
    const ThinMesh wedge = wedges(half, {kRows});
    std::vector<Edge> circle;
    for (const Edge& e : wedge.mesh.edges)
      if (e[1] < kAround) circle.push_back(e);
    for (const double height : {0.01, 0.05, 0.2}) {
      const ThinMesh left = eroded(wedge, circle, {height, 0});
      const std::set<Triangle> faces = faces_left(left);
      const double depth = height / (1 - std::sin(half));  // up to which the fire is lower than the height
      for (const Triangle& f : wedge.mesh.faces) {
        double at = 5 + kRows * kStep;
        for (const Index v : f) at -= norm(wedge.mesh.centers[uz(v)]) / 3;
        if (std::abs(at - depth) > kStep) {
          EXPECT_EQ(faces.contains(f), at > depth) << half << " " << height << " " << at;
        }
      }
      EXPECT_EQ(betti_numbers(left.mesh), (Betti{1, 1, 0}));
    }
  }
}

TEST(Erosion, WaitsAtSeams) {
  // The first wedge burns down to the circle at once. The others have rows left there: the fire may not enter them from
  // below as long as both stand.
  const double half = 0.4, height = 0.7 * (1 - std::sin(half));
  const std::set<Triangle> faces = faces_left(eroded(wedges(half, {2, 16, 16}), {}, {height, 0}));
  std::array<int, 3> rows{};  // of each wedge that have faces on the circle
  for (const auto& [a, b, c] : faces)
    if (b < kAround) ++rows[c < 3 * kAround ? 0 : (c < 19 * kAround ? 1 : 2)];
  EXPECT_EQ(rows, (std::array<int, 3>{0, kAround, kAround}));
}

TEST(Erosion, RemovesCurvesThatLargerBallsCover) {
  // A large ball with a disc around it, and a curve of small balls: within it, sticking out by 0.05, and by 0.2.
  for (const double sticks_out : {-0.3, 0.05, 0.2}) {
    const double reach = 1 + sticks_out - 0.2;
    const ThinMesh thin =
        thin_of({{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}, {0, 0, reach}}, {1, 0.8, 0.8, 0.2}, {{0, 1, 2}}, {{1, 3}});
    const std::vector<Edge> sheet{{0, 1}, {0, 2}, {1, 2}};
    EXPECT_EQ(eroded(thin, sheet, {0, 0.1}).spheres.size(), sticks_out < 0.1 ? 3u : 4u) << sticks_out;
    EXPECT_EQ(eroded(thin, {{0, 1}, {0, 2}, {1, 2}, {1, 3}}, {0, 0.1}).spheres.size(), 4u);
  }
}

}  // namespace
}  // namespace matstruct
