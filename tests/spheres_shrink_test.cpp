// Sphere shrinking on solids whose medial axis is known.
#include "spheres/shrink.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <random>

#include "base/index.h"
#include "base/tolerances.h"
#include "shapes.h"

namespace matstruct {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Domain prepare(const TetMesh& mesh) {
  Context context;
  return prepare_domain(mesh, {}, context);
}

std::vector<Pin> pins_of(const Domain& domain, double density) {
  return sample_surface(domain, domain.diagonal / density, 1, {});
}

/// Distances from a point inside a convex polyhedron to the planes of its faces, ascending; coplanar triangles count
/// once.
std::vector<double> plane_distances(const Domain& domain, const Vec3& p) {
  std::vector<double> result;
  std::vector<Vec3> seen;
  for (Index t = 0; t < count(domain.surface.triangles); ++t) {
    const Vec3& n = domain.triangle_normals[uz(t)];
    if (std::any_of(seen.begin(), seen.end(), [&](const Vec3& m) { return distance(m, n) < 1e-9; })) continue;
    seen.push_back(n);
    result.push_back(dot(domain.surface.vertices[uz(domain.surface.triangles[uz(t)][0])] - p, n));
  }
  std::sort(result.begin(), result.end());
  return result;
}

void expect_exactly_medial(const Domain& domain) {
  const std::vector<Pin> pins = pins_of(domain, 12);
  const double tolerance = 1e-12 * domain.diagonal;
  for (const Pin& pin : pins) {
    const ShrunkSphere sphere = shrink_sphere(domain, pin, 0);
    if (sphere.radius < tolerance::kSmallestRadius * domain.diagonal) continue;  // the pin lies on an edge
    ASSERT_TRUE(sphere.converged);
    const std::vector<double> d = plane_distances(domain, sphere.center);
    ASSERT_NEAR(d[0], sphere.radius, tolerance);
    ASSERT_NEAR(d[1], d[0], tolerance);
    ASSERT_NEAR(distance(sphere.center, pin.point), sphere.radius, tolerance);
    ASSERT_NEAR(distance(sphere.center, sphere.contact), sphere.radius, tolerance);
    ASSERT_GT(distance(domain.triangle_normals[uz(sphere.contact_triangle)], pin.normal), 1e-9);
    ASSERT_NEAR(sphere.separation, angle_between(pin.point - sphere.center, sphere.contact - sphere.center), 1e-15);
  }
}

TEST(Shrink, ConvexShapesAreExact) {
  for (const shapes::Shape& shape : shapes::all()) {
    if (shape.concave_lines > 0 || shape.topology.b1 > 0) continue;
    SCOPED_TRACE(shape.name);
    expect_exactly_medial(prepare(shape.mesh));
  }
}

TEST(Shrink, RandomAffineImagesOfConvexShapesAreExact) {
  std::mt19937_64 random(1);
  const auto entry = [&] { return std::normal_distribution<double>()(random); };
  const std::vector<TetMesh> meshes{shapes::tetrahedron(), shapes::box({1, 1, 1}, 2, 2, 2), shapes::pyramid(),
                                    shapes::prism(1, 2, 5)};
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const Vec3 x{entry(), entry(), entry()}, y{entry(), entry(), entry()}, z{entry(), entry(), entry()};
    expect_exactly_medial(
        prepare(shapes::transformed(meshes[uz(i % 4)], [&](Vec3 p) { return x * p.x + y * p.y + z * p.z; })));
  }
}

TEST(Shrink, PinsNearAConvexEdgeGiveTinyTrueSpheres) {
  const Domain domain = prepare(shapes::box({1, 1, 1}));
  for (const double offset : {1e-1, 1e-2, 1e-3, 1e-4}) {
    const Pin pin{domain.frame.to_internal({offset, 0.4, 1}), domain.frame.turned({0, 0, 1}), kInvalid};
    const ShrunkSphere sphere = shrink_sphere(domain, pin, 30 * kDegree);
    ASSERT_TRUE(sphere.converged);
    EXPECT_NEAR(sphere.radius / domain.frame.scale, offset, 1e-13);
    EXPECT_NEAR(sphere.separation, std::numbers::pi / 2, 1e-9);
  }
}

TEST(Shrink, ConcaveEdgeOfTheLProfileGivesParabolicSheets) {
  const Domain domain = prepare(shapes::l_profile(3));
  int checked = 0;
  for (const Pin& pin : sample_concave_lines(domain, domain.diagonal / 40, 0.1)) {
    const double z = domain.frame.to_input(pin.point).z;
    if (z < 0.7 || z > 2.3) continue;  // the end faces are nearer
    // The ball touches the edge x = y = 1 in direction n and the face x = 0 or y = 0, whichever n faces away from more.
    const Vec3 normal = domain.frame.turned_back(pin.normal);
    const double radius = 1 / (1 + std::max(normal.x, normal.y));
    const ShrunkSphere sphere = shrink_sphere(domain, pin, 0);
    ASSERT_TRUE(sphere.converged);
    EXPECT_NEAR(sphere.radius / domain.frame.scale, radius, 1e-12 / domain.frame.scale);
    EXPECT_NEAR(distance(sphere.center, pin.point - pin.normal * sphere.radius), 0, 1e-12);
    const Vec3 contact = domain.frame.to_input(sphere.contact);
    EXPECT_NEAR(std::min(contact.x, contact.y), 0, 1e-15);
    ++checked;
  }
  EXPECT_GT(checked, 100);
}

TEST(Shrink, SpheresOfNonConvexSolidsAreEmptyAndTouchTwice) {
  for (const shapes::Shape& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const Domain domain = prepare(shape.mesh);
    std::vector<Pin> pins = pins_of(domain, 12);
    const std::vector<Pin> concave = sample_concave_lines(domain, domain.diagonal / 10, 0.5);
    pins.insert(pins.end(), concave.begin(), concave.end());
    for (const Pin& pin : pins) {
      const ShrunkSphere sphere = shrink_sphere(domain, pin, 0);
      if (!sphere.converged) continue;
      const double tolerance = 3e-12 * domain.diagonal;
      ASSERT_LT(std::abs(domain.query.signed_distance(sphere.center) + sphere.radius), 1e-15);
      ASSERT_NEAR(distance(sphere.center, pin.point), sphere.radius, tolerance);
      ASSERT_NEAR(distance(sphere.center, sphere.contact), sphere.radius, tolerance);
    }
  }
}

/// Subdivided octahedron with its vertices on the unit sphere.
TetMesh ball(int cells) {
  std::vector<Vec3> vertices;
  std::map<std::array<int, 3>, Index> ids;
  const auto vertex = [&](int x, int y, int z) {
    const auto [it, added] = ids.try_emplace({x, y, z}, count(vertices));
    if (added) vertices.push_back(normalized(Vec3{double(x), double(y), double(z)}));
    return it->second;
  };
  std::vector<std::vector<Index>> faces;
  for (const int sx : {-1, 1}) {
    for (const int sy : {-1, 1}) {
      for (const int sz : {-1, 1}) {
        const auto at = [&](int i, int j) { return vertex(sx * i, sy * j, sz * (cells - i - j)); };
        for (int i = 0; i < cells; ++i) {
          for (int j = 0; i + j < cells; ++j) {
            faces.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + j + 1 < cells) faces.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
          }
        }
      }
    }
  }
  return shapes::convex(std::move(vertices), faces);
}

/// Part of the spheres, in input units, for which `good` holds; those that have not converged are not good.
template <class Predicate>
double share(const Domain& domain, const std::vector<Pin>& pins, double smooth_angle, const Predicate& good) {
  Index n = 0;
  for (const ShrunkSphere& sphere : shrink_spheres(domain, pins, smooth_angle, {})) {
    n += sphere.converged && good(domain.frame.to_input(sphere.center), sphere.radius / domain.frame.scale);
  }
  return double(n) / double(pins.size());
}

TEST(Shrink, FacettedCylinderGivesItsAxis) {
  const double height = 6;
  const Domain domain = prepare(shapes::prism(1, height, 32, 8));
  std::vector<Pin> pins;
  for (const Pin& pin : pins_of(domain, 60)) {
    const Vec3 p = domain.frame.to_input(pin.point);
    if (p.z > 1.1 && p.z < height - 1.1) pins.push_back(pin);
  }
  const auto on_axis = [](const Vec3& c, double) { return std::hypot(c.x, c.y) < 0.01; };
  EXPECT_GT(share(domain, pins, 30 * kDegree, on_axis), 0.99);
  // Without the angle every facet's pins end on the sheets between facets.
  EXPECT_LT(share(domain, pins, 0, on_axis), 0.1);
}

TEST(Shrink, FacettedBallGivesItsCenter) {
  const Domain domain = prepare(ball(16));
  // The facets are unlike, so that the deepest point is near the centre only.
  const auto at_center = [](const Vec3& c, double r) { return norm(c) < 0.02 && r > 0.97; };
  EXPECT_GT(share(domain, pins_of(domain, 30), 30 * kDegree, at_center), 0.99);
}

TEST(Shrink, FacettedTorusGivesItsCircle) {
  const Domain domain = prepare(shapes::torus(3, 1, 96, 32));
  const auto on_circle = [](const Vec3& c, double) { return std::hypot(std::hypot(c.x, c.y) - 3, c.z) < 0.01; };
  EXPECT_GT(share(domain, pins_of(domain, 30), 30 * kDegree, on_circle), 0.99);
}

TEST(Shrink, PinsThatFaceInwardsGiveNoSphere) {
  for (const TetMesh& mesh : {shapes::box({1, 1, 1}), shapes::l_profile(), shapes::hollow_box()}) {
    const Domain domain = prepare(mesh);
    for (Pin pin : pins_of(domain, 10)) {
      pin.normal = -pin.normal;
      EXPECT_FALSE(shrink_sphere(domain, pin, 0).converged);
      EXPECT_FALSE(shrink_sphere(domain, pin, 30 * kDegree).converged);
    }
  }
}

TEST(Shrink, ThreadsDoNotMatter) {
  const Domain domain = prepare(shapes::torus(3, 1, 24, 16));
  Context one, four;
  one.threads = 1, four.threads = 4;
  const std::vector<Pin> pins = pins_of(domain, 40);
  const std::vector<ShrunkSphere> a = shrink_spheres(domain, pins, 0.5, one),
                                  b = shrink_spheres(domain, pins, 0.5, four);
  ASSERT_EQ(a.size(), pins.size());
  for (std::size_t i = 0; i < pins.size(); ++i) {
    EXPECT_EQ(a[i].center, b[i].center);
    EXPECT_EQ(a[i].radius, b[i].radius);
    EXPECT_EQ(a[i].contact_triangle, b[i].contact_triangle);
  }
}

}  // namespace
}  // namespace matstruct
