// Reconstruction: the grid stays conforming, and the surfaces of solids that are known exactly come out closed, without
// self-intersections, within the tolerance and with the right genus.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <matstruct/error.h>
#include <matstruct/reconstruct.h>

#include "base/index.h"
#include "base/random.h"
#include "prepare/self_intersection.h"
#include "reconstruct/homotopic.h"
#include "reconstruct/level_set.h"
#include "reconstruct/tet_grid.h"

namespace matstruct {
namespace {

MedialMesh medial_mesh(const std::vector<Vec3>& centers, const std::vector<double>& radii,
                       const std::vector<Edge>& edges = {}, const std::vector<Triangle>& faces = {}) {
  return {centers, radii, std::vector<SphereType>(centers.size(), SphereType::kSheet), edges, faces};
}

double volume(const TriSurface& surface) {
  double sum = 0;
  const auto& v = surface.vertices;
  for (const auto& [i, j, k] : surface.triangles) sum += dot(v[uz(i)], cross(v[uz(j)], v[uz(k)])) / 6;
  return sum;
}

/// Every directed edge once, its opposite once too, and no triangle meets another elsewhere.
void expect_closed_and_embedded(const TriSurface& surface) {
  std::set<Edge> directed;
  for (const auto& [i, j, k] : surface.triangles)
    for (const Edge& edge : {Edge{i, j}, Edge{j, k}, Edge{k, i}}) EXPECT_TRUE(directed.insert(edge).second);
  for (const auto& [i, j] : directed) EXPECT_TRUE(directed.contains({j, i}));
  EXPECT_FALSE(find_self_intersection(surface));
}

Reconstruction good(const MedialMesh& mesh, double tolerance_percent) {
  Context context;
  Reconstruction result = reconstruct(mesh, tolerance_percent, context);
  expect_closed_and_embedded(result.surface);
  EXPECT_TRUE(result.within_tolerance()) << result.to_envelope << " " << result.from_envelope;
  EXPECT_EQ(result.topology, result.expected);
  return result;
}

TEST(TetGrid, StaysConformingWhereverItIsRefined) {
  TetGrid grid;
  KeyedRandom random(7, 0, 0);
  const double whole = std::pow(double(TetGrid::kSize), 3);
  for (int round = 0; round < 12; ++round) {
    // Near one point, so that small tetrahedra meet large ones, and anywhere.
    const Vec3 fixed = Vec3{0.31, 0.42, 0.53} * double(TetGrid::kSize);
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(grid.mark_around(fixed + Vec3{double(k), 0, 0}, 8));
    for (int k = 0; k < 5; ++k)
      grid.mark(grid.tets()[static_cast<std::size_t>(random.uniform() * double(grid.tets().size()))]);
    grid.refine(0);

    std::map<Triangle, int> faces;
    double sum = 0;
    for (const auto& [a, b, c, d] : grid.tets()) {
      const auto at = [&](Index p) {
        const GridPoint& point = grid.points()[uz(p)];
        return Vec3{double(point[0]), double(point[1]), double(point[2])};
      };
      const double six_volumes = dot(cross(at(b) - at(a), at(c) - at(a)), at(d) - at(a));
      ASSERT_GT(six_volumes, 0);
      sum += six_volumes / 6;
      for (Triangle face : {Triangle{a, b, c}, Triangle{a, b, d}, Triangle{a, c, d}, Triangle{b, c, d}}) {
        std::sort(face.begin(), face.end());
        ++faces[face];
      }
    }
    EXPECT_NEAR(sum / whole, 1, 1e-12);
    for (const auto& [face, tets] : faces) {
      const auto on_side = [&](std::size_t axis, std::int32_t value) {
        return std::all_of(face.begin(), face.end(), [&](Index p) { return grid.points()[uz(p)][axis] == value; });
      };
      bool outer = false;
      for (std::size_t axis = 0; axis < 3; ++axis) outer |= on_side(axis, 0) || on_side(axis, TetGrid::kSize);
      ASSERT_EQ(tets, outer ? 1 : 2);
    }
  }
}

TEST(TetGrid, RefinesAroundTheGivenPoint) {
  TetGrid grid;
  const Vec3 at{123456.7, 654321.1, 222222.2};
  while (grid.mark_around(at, 1000)) grid.refine(0);
  const auto holds = [&](const Tetrahedron& tet) {
    std::array<Vec3, 4> p;
    for (std::size_t k = 0; k < 4; ++k)
      for (int axis = 0; axis < 3; ++axis) p[k][axis] = grid.points()[uz(tet[k])][static_cast<std::size_t>(axis)];
    const auto side = [&](int a, int b, int c) {
      return dot(cross(p[uz(b)] - p[uz(a)], p[uz(c)] - p[uz(a)]), at - p[uz(a)]) >= 0;
    };
    return side(0, 1, 2) && side(0, 2, 3) && side(0, 3, 1) && side(1, 3, 2);
  };
  int around = 0;
  for (const Tetrahedron& tet : grid.tets()) {
    if (!holds(tet)) continue;
    ++around;
    EXPECT_LE(grid.size(tet), 1000);
  }
  EXPECT_GE(around, 1);
}

/// Grid vertices with a function of their place, in parts of the grid's side, as values.
struct Sampled {
  TetGrid grid;
  std::vector<double> values;
  std::vector<Vec3> places;
  template <class Function>
  Sampled(int rounds, const Function& function) {
    for (int k = 0; k < rounds; ++k) {
      for (const Tetrahedron& tet : grid.tets()) grid.mark(tet);
      grid.refine(0);
    }
    for (const GridPoint& at : grid.points()) {
      places.push_back(Vec3{double(at[0]), double(at[1]), double(at[2])} / double(TetGrid::kSize));
      values.push_back(function(places.back()));
    }
  }
  std::vector<char> below(double level) const {
    std::vector<char> inside;
    for (const double v : values) inside.push_back(v < level);
    return inside;
  }
  SurfaceTopology topology(const std::vector<char>& inside) const {
    std::vector<double> signs;
    for (const char in : inside) signs.push_back(in ? -1 : 1);
    return surface_topology(march(places, signs, grid.tets(), 0));
  }
  std::vector<char> filled(double level, const SurfaceTopology& wanted, const std::vector<double>& levels) const {
    std::vector<char> inside = below(level);
    const auto added = fill(grid.tets(), values, inside, topology(inside), wanted, levels, Context{});
    for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = inside[v] || added[v];
    return inside;
  }
};

const Vec3 kMiddle{0.5, 0.5, 0.5};
double ring(const Vec3& x) {
  return std::hypot(std::hypot(x.x - 0.5, x.y - 0.5) - 0.25, x.z - 0.5) - 0.12;
}

TEST(Homotopic, ShrinkKeepsTheTopology) {
  const Sampled ball(6, [](const Vec3& x) { return distance(x, kMiddle) - 0.3; });
  const std::vector<char> nothing(ball.values.size(), 0);
  const auto point = shrink(ball.grid.tets(), ball.values, 0, nothing);
  EXPECT_EQ(std::count(point.begin(), point.end(), 1), 1);  // a ball shrinks to a point
  EXPECT_EQ(ball.topology(point), (SurfaceTopology{1, 0}));

  const Sampled solid_ring(6, ring);
  const auto circle = shrink(solid_ring.grid.tets(), solid_ring.values, 0, nothing);
  EXPECT_EQ(solid_ring.topology(solid_ring.below(0)), (SurfaceTopology{1, 1}));
  EXPECT_EQ(solid_ring.topology(circle), (SurfaceTopology{1, 1}));
  EXPECT_LT(std::count(circle.begin(), circle.end(), 1), 100);

  const Sampled shell(6, [](const Vec3& x) { return std::abs(distance(x, kMiddle) - 0.3) - 0.1; });
  EXPECT_EQ(shell.topology(shrink(shell.grid.tets(), shell.values, 0, nothing)), (SurfaceTopology{2, 0}));
}

TEST(Homotopic, FillClosesTunnelsBubblesAndGaps) {
  const std::vector<double> levels{0.02, 0.05, 0.1, 0.2};
  const Sampled solid_ring(6, ring);
  EXPECT_EQ(solid_ring.topology(solid_ring.filled(0, {1, 0}, levels)), (SurfaceTopology{1, 0}));
  EXPECT_EQ(solid_ring.filled(0, {1, 1}, levels), solid_ring.below(0));  // it is what it should be
  const Sampled shell(6, [](const Vec3& x) { return std::abs(distance(x, kMiddle) - 0.3) - 0.15; });
  EXPECT_EQ(shell.topology(shell.filled(0, {1, 0}, levels)), (SurfaceTopology{1, 0}));
  const Sampled halves(9,
                       [](const Vec3& x) { return std::max(distance(x, kMiddle) - 0.3, 0.05 - std::abs(x.x - 0.5)); });
  EXPECT_EQ(halves.topology(halves.below(0)), (SurfaceTopology{2, 0}));
  EXPECT_EQ(halves.topology(halves.filled(0, {1, 0}, levels)), (SurfaceTopology{1, 0}));
}

TEST(Homotopic, FillTakesTheNarrowTunnelAndLeavesTheWideOne) {
  // A plate with a wide hole and a narrow one; both are closed at the last level.
  const Sampled plate(6, [](const Vec3& x) {
    const double body = std::max({std::abs(x.x - 0.5) - 0.45, std::abs(x.y - 0.5) - 0.3, std::abs(x.z - 0.5) - 0.15});
    const double wide = 0.17 - std::hypot(x.x - 0.3, x.y - 0.5), narrow = 0.1 - std::hypot(x.x - 0.7, x.y - 0.5);
    return std::max({body, wide, narrow});
  });
  ASSERT_EQ(plate.topology(plate.below(0)), (SurfaceTopology{1, 2}));
  const auto inside = plate.filled(0, {1, 1}, {0.2});
  EXPECT_EQ(plate.topology(inside), (SurfaceTopology{1, 1}));
  for (std::size_t v = 0; v < inside.size(); ++v) {
    if (!inside[v] || plate.values[v] < 0) continue;
    EXPECT_LT(std::hypot(plate.places[v].x - 0.7, plate.places[v].y - 0.5), 0.15);  // the wide one is further off
  }
}

TEST(Reconstruct, ATunnelThatTheMedialMeshHasNotIsFilled) {
  // An open chain of cones whose end balls overlap: the union is a ring, the complex is not.
  MedialMesh chain;
  constexpr int kAround = 12;
  for (int k = 0; k < kAround; ++k) {
    const double angle = 2 * std::numbers::pi * k / kAround;
    chain.centers.push_back({std::cos(angle), std::sin(angle), 0});
    chain.radii.push_back(0.9);
    chain.types.push_back(SphereType::kSheet);
    if (k + 1 < kAround) chain.edges.push_back({k, k + 1});
  }
  const Reconstruction result = good(chain, 0.5);
  EXPECT_EQ(result.topology, (SurfaceTopology{1, 0}));
  EXPECT_NEAR(result.deepest_filling, 0.07, 0.05);
}

TEST(Reconstruct, Ball) {
  const Reconstruction result = good(medial_mesh({{3, -2, 1}}, {2}), 0.1);
  EXPECT_NEAR(result.diagonal, 4 * std::sqrt(3.0), 1e-12);
  EXPECT_EQ(result.topology, (SurfaceTopology{1, 0}));
  for (const Vec3& p : result.surface.vertices) EXPECT_NEAR(distance(p, {3, -2, 1}), 2, result.tolerance);
  EXPECT_NEAR(volume(result.surface) / (std::numbers::pi * 32 / 3), 1, 0.005);
}

TEST(Reconstruct, BallsApartAreComponents) {
  const Reconstruction result = good(medial_mesh({{0, 0, 0}, {5, 0, 0}, {0, 4, 0}}, {1, 2, 0.05}), 0.3);
  EXPECT_EQ(result.topology, (SurfaceTopology{3, 0}));
}

TEST(Reconstruct, RingOfConesHasGenusOne) {
  MedialMesh ring;
  constexpr int kAround = 12;
  for (int k = 0; k < kAround; ++k) {
    const double angle = 2 * std::numbers::pi * k / kAround;
    ring.centers.push_back({std::cos(angle), std::sin(angle), 0});
    ring.radii.push_back(k % 2 == 0 ? 0.2 : 0.15);
    ring.types.push_back(SphereType::kSheet);
    ring.edges.push_back(k + 1 < kAround ? Edge{k, k + 1} : Edge{0, k});
  }
  std::sort(ring.edges.begin(), ring.edges.end());
  EXPECT_EQ(good(ring, 0.2).topology, (SurfaceTopology{1, 1}));
}

TEST(Reconstruct, ShellHasTwoComponents) {
  // The faces of a tetrahedron as slabs: solid with a cavity.
  const MedialMesh shell =
      medial_mesh({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {0.2, 0.2, 0.3, 0.2},
                  {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}});
  EXPECT_EQ(good(shell, 0.3).topology, (SurfaceTopology{2, 0}));
}

TEST(Reconstruct, SharpEdgesAndFacesWithoutThickness) {
  // A wedge that ends in an edge of radius 0, and a triangle of spheres of radius 0 at it.
  const MedialMesh wedge = medial_mesh({{0, 0, 0}, {0, 3, 0}, {2, 1, 0}, {-1, 1, 0}}, {0, 0, 0.8, 0},
                                       {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}}, {{0, 1, 2}, {0, 1, 3}});
  const Reconstruction result = good(wedge, 0.2);
  EXPECT_EQ(result.topology, (SurfaceTopology{1, 0}));
}

TEST(Reconstruct, SameSurfaceForAnyNumberOfThreads) {
  const MedialMesh mesh =
      medial_mesh({{0, 0, 0}, {1, 0.3, 0}, {0.2, 1, 0.4}}, {0.1, 0.3, 0.2}, {{0, 1}, {0, 2}, {1, 2}}, {{0, 1, 2}});
  Context one, two;
  one.threads = 1;
  two.threads = 2;
  const TriSurface a = reconstruct(mesh, 0.5, one).surface, b = reconstruct(mesh, 0.5, two).surface;
  EXPECT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t v = 0; v < a.vertices.size(); ++v)
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(a.vertices[v][axis], b.vertices[v][axis]);
}

TEST(Reconstruct, RefusesWhatHasNoSurface) {
  Context context;
  EXPECT_THROW(reconstruct(MedialMesh{}, 0.1, context), Error);
  EXPECT_THROW(reconstruct(medial_mesh({{1, 1, 1}}, {0}), 0.1, context), Error);
  EXPECT_THROW(reconstruct(medial_mesh({{1, 1, 1}}, {1}), 0.01, context), Error);
  EXPECT_THROW(reconstruct(medial_mesh({{1, 1, 1}}, {1}), std::nan(""), context), Error);
}

TEST(LevelSet, OfALinearFunctionIsItsPlane) {
  const std::vector<Vec3> places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Tetrahedron> tets{{0, 1, 2, 3}};
  for (const Vec3& normal : {Vec3{1, 2, 3}, Vec3{-1, 2, 0.5}, Vec3{1, -2, -3}, Vec3{-1, -2, -3}}) {
    std::vector<double> values;
    for (const Vec3& p : places) values.push_back(dot(normal, p) - (normal.x < 0 ? -0.3 : 0.3));
    const TriSurface surface = march(places, values, tets, 1e-9);
    for (const Vec3& p : surface.vertices) EXPECT_NEAR(dot(normal, p), normal.x < 0 ? -0.3 : 0.3, 1e-8);
    ASSERT_FALSE(surface.triangles.empty());
    for (const auto& [i, j, k] : surface.triangles) {
      const Vec3 &a = surface.vertices[uz(i)], &b = surface.vertices[uz(j)], &c = surface.vertices[uz(k)];
      EXPECT_GT(dot(cross(b - a, c - a), normal), 0);
    }
  }
}

}  // namespace
}  // namespace matstruct
