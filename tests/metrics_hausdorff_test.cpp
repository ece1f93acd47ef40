// Hausdorff distance: shapes whose envelope and surface are known exactly, offsets, and the distance from inside a
// union against dense samples of its boundary.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <matstruct/error.h>
#include <matstruct/metrics.h>

#include "base/index.h"
#include "base/random.h"
#include "convex_oracle.h"
#include "metrics/envelope.h"

namespace matstruct {
namespace {

constexpr Index kSamples = 20000;

MedialMesh spheres(const std::vector<Ball>& balls) {
  MedialMesh mesh;
  for (const Ball& ball : balls) {
    mesh.centers.push_back(ball.center);
    mesh.radii.push_back(ball.radius);
    mesh.types.push_back(SphereType::kSheet);
  }
  return mesh;
}

/// Surface of revolution about the x axis of a capsule: hull of two balls of equal radius, whose centres lie `length`
/// apart. All vertices are on the capsule exactly.
TriSurface capsule(double length, double radius, Index rings, Index around) {
  TriSurface surface;
  const auto add_ring = [&](double x, double r) {
    for (Index k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      surface.vertices.push_back({x, r * std::cos(angle), r * std::sin(angle)});
    }
  };
  for (Index i = 0; i <= 2 * rings; ++i) {
    const double latitude = std::numbers::pi * (i - rings) / (2 * rings);
    add_ring(radius * std::sin(latitude), radius * std::cos(latitude));
    if (i == rings) add_ring(0, radius);
    if (i >= rings)
      for (Index k = 0; k < around; ++k) surface.vertices[surface.vertices.size() - 1 - uz(k)].x += length;
  }
  const Index all_rings = count(surface.vertices) / around;
  for (Index i = 0; i + 1 < all_rings; ++i) {
    for (Index k = 0; k < around; ++k) {
      const Index next = (k + 1) % around;
      const Index a = i * around + k, b = i * around + next, c = a + around, d = b + around;
      surface.triangles.push_back({a, b, d});
      surface.triangles.push_back({a, d, c});
    }
  }
  return surface;
}

TEST(HausdorffDistance, SphereAgainstItsTessellation) {
  Context context;
  const Index rings = 100, around = 400;
  const TriSurface surface = capsule(0, 2, rings, around);
  const Hausdorff h = hausdorff_distance(spheres({{{0, 0, 0}, 2}}), surface, kSamples, context);
  // A quad that spans the angle s both ways keeps within r (1 - cos(s / 2)^2), about r s^2 / 4, of the sphere.
  const double step = 2 * std::numbers::pi / around, sagitta = 2 * step * step / 4;
  EXPECT_LE(h.surface_to_envelope, sagitta);
  EXPECT_GE(h.surface_to_envelope, sagitta / 2);
  EXPECT_LE(h.envelope_to_surface, sagitta);
  EXPECT_GE(h.envelope_to_surface, sagitta / 2);
  EXPECT_NEAR(h.diagonal, 4 * std::numbers::sqrt3, 1e-12);
  EXPECT_LE(h.mean_surface_to_envelope, h.surface_to_envelope);
  EXPECT_LE(h.mean_envelope_to_surface, h.envelope_to_surface);
}

TEST(HausdorffDistance, CapsuleAgainstItsTessellation) {
  Context context;
  MedialMesh mesh = spheres({{{0, 0, 0}, 0.5}, {{3, 0, 0}, 0.5}});
  const TriSurface surface = capsule(3, 0.5, 50, 200);
  const double step = 2 * std::numbers::pi / 200, sagitta = 0.5 * step * step / 4;
  mesh.edges = {{0, 1}};
  const Hausdorff with_cone = hausdorff_distance(mesh, surface, kSamples, context);
  EXPECT_LE(with_cone.surface_to_envelope, sagitta);
  EXPECT_LE(with_cone.envelope_to_surface, sagitta);
  // Without the cone the middle of the side is missing; its distance to the two spheres is that to their equators.
  mesh.edges.clear();
  const Hausdorff without = hausdorff_distance(mesh, surface, kSamples, context);
  EXPECT_NEAR(without.surface_to_envelope, std::sqrt(1.5 * 1.5 + 0.25) - 0.5, 2e-3);
  // The inner half spheres are inside the capsule, their poles deepest: in the middle of its cross-section.
  EXPECT_NEAR(without.envelope_to_surface, 0.5, 2e-2);
}

TEST(HausdorffDistance, PartsOfSpheresInsideOthersAreNotOnTheEnvelope) {
  Context context;
  const Envelope envelope(spheres({{{0, 0, 0}, 1}, {{1, 0, 0}, 1}}), kSamples, 1e-10, context);
  double area = 0;
  for (const double w : envelope.samples().weights) area += w;
  EXPECT_NEAR(area, 2 * 3 * std::numbers::pi, 0.01 * area);  // two spheres without caps of height 1/2
  for (const Vec3& x : envelope.samples().points) {
    EXPECT_GE(distance(x, {0, 0, 0}), 1 - 1e-9);
    EXPECT_GE(distance(x, {1, 0, 0}), 1 - 1e-9);
  }
}

TEST(HausdorffDistance, BoxAgainstItsExactMedialMeshIsZero) {
  Context context;
  const oracle::ConvexPolyhedron solid = oracle::box(1, 2, 3);
  const MedialMesh mesh = oracle::medial_mesh_of(oracle::medial_axis(solid));
  const Hausdorff h = hausdorff_distance(mesh, oracle::surface_of(solid), kSamples, context);
  EXPECT_LT(h.surface_to_envelope, 1e-13);
  EXPECT_LT(h.envelope_to_surface, 1e-13);
  EXPECT_NEAR(h.diagonal, std::sqrt(14), 1e-13);
  EXPECT_LT(h.percent(), 1e-12);
}

TEST(HausdorffDistance, ConvexSolidsAgainstTheirExactMedialMeshesAreZero) {
  Context context;
  for (const int faces : {6, 11, 20}) {
    const auto solid = oracle::random_convex_polyhedron(static_cast<std::uint64_t>(faces), faces);
    const MedialMesh mesh = oracle::medial_mesh_of(oracle::medial_axis(solid));
    const Hausdorff h = hausdorff_distance(mesh, oracle::surface_of(solid), kSamples, context);
    EXPECT_LT(h.surface_to_envelope, 1e-9);  // vertices of the oracle are merged within 1e-7 and cut within 1e-11
    EXPECT_LT(h.envelope_to_surface, 1e-9);
  }
}

TEST(HausdorffDistance, GrownRadiiGiveTheGrowthExactly) {
  Context context;
  const oracle::ConvexPolyhedron solid = oracle::box(1, 2, 3);
  MedialMesh mesh = oracle::medial_mesh_of(oracle::medial_axis(solid));
  const double delta = 0.01;
  for (double& r : mesh.radii) r += delta;
  const Hausdorff h = hausdorff_distance(mesh, oracle::surface_of(solid), kSamples, context);
  EXPECT_NEAR(h.surface_to_envelope, delta, 1e-12);
  EXPECT_NEAR(h.mean_surface_to_envelope, delta, 1e-12);
  EXPECT_NEAR(h.envelope_to_surface, delta, 1e-12);
  EXPECT_NEAR(h.mean_envelope_to_surface, delta, 1e-12);
  EXPECT_NEAR(h.percent(), 100 * delta / std::sqrt(14), 1e-9);
}

TEST(HausdorffDistance, ShrunkRadiiGiveTheShrinkingExactly) {
  Context context;
  const MedialMesh sphere = spheres({{{1, 2, 3}, 1.75}});
  TriSurface surface = capsule(0, 2, 40, 160);
  for (Vec3& v : surface.vertices) v += Vec3{1, 2, 3};
  const double step = 2 * std::numbers::pi / 160, sagitta = 2 * step * step / 4;
  const Hausdorff h = hausdorff_distance(sphere, surface, kSamples, context);
  EXPECT_NEAR(h.surface_to_envelope, 0.25, 1e-12);  // at the vertices, which are sampled
  EXPECT_NEAR(h.envelope_to_surface, 0.25, sagitta);
  EXPECT_LE(h.envelope_to_surface, 0.25);
}

TEST(HausdorffDistance, LargerBoxGivesTheDistanceOfItsCorners) {
  Context context;
  const MedialMesh mesh = oracle::medial_mesh_of(oracle::medial_axis(oracle::box(1, 2, 3)));
  const Hausdorff h = hausdorff_distance(mesh, oracle::surface_of(oracle::box(1.2, 2.2, 3.2)), kSamples, context);
  EXPECT_NEAR(h.surface_to_envelope, 0.1 * std::numbers::sqrt3, 1e-12);
  EXPECT_NEAR(h.envelope_to_surface, 0.1, 1e-12);
}

TEST(HausdorffDistance, DoesNotDependOnTheNumberOfThreads) {
  const auto solid = oracle::random_convex_polyhedron(3, 9);
  MedialMesh mesh = oracle::medial_mesh_of(oracle::medial_axis(solid));
  for (double& r : mesh.radii) r *= 1.03;
  Hausdorff results[2];
  for (const int threads : {1, 2}) {
    Context context;
    context.threads = threads;
    results[threads - 1] = hausdorff_distance(mesh, oracle::surface_of(solid), kSamples, context);
  }
  EXPECT_EQ(results[0].surface_to_envelope, results[1].surface_to_envelope);
  EXPECT_EQ(results[0].envelope_to_surface, results[1].envelope_to_surface);
  EXPECT_EQ(results[0].mean_surface_to_envelope, results[1].mean_surface_to_envelope);
  EXPECT_EQ(results[0].mean_envelope_to_surface, results[1].mean_envelope_to_surface);
}

TEST(HausdorffDistance, ScalesWithTheUnits) {
  Context context;
  const auto solid = oracle::box(1, 2, 3);
  MedialMesh mesh = oracle::medial_mesh_of(oracle::medial_axis(solid));
  for (double& r : mesh.radii) r += 0.01;
  TriSurface surface = oracle::surface_of(solid);
  const Hausdorff h = hausdorff_distance(mesh, surface, 1000, context);
  for (const double scale : {0x1p-20, 0x1p20}) {  // powers of two: to the last bit
    MedialMesh scaled_mesh = mesh;
    TriSurface scaled_surface = surface;
    for (Vec3& c : scaled_mesh.centers) c *= scale;
    for (double& r : scaled_mesh.radii) r *= scale;
    for (Vec3& v : scaled_surface.vertices) v *= scale;
    const Hausdorff scaled = hausdorff_distance(scaled_mesh, scaled_surface, 1000, context);
    EXPECT_EQ(scaled.surface_to_envelope, h.surface_to_envelope * scale);
    EXPECT_EQ(scaled.percent(), h.percent());
  }
}

TEST(HausdorffDistance, RefusesWhatHasNoDistance) {
  Context context;
  const TriSurface surface = oracle::surface_of(oracle::box(1, 1, 1));
  const MedialMesh mesh = spheres({{{0, 0, 0}, 1}});
  EXPECT_THROW(hausdorff_distance({}, surface, kSamples, context), Error);
  EXPECT_THROW(hausdorff_distance(mesh, {}, kSamples, context), Error);
  EXPECT_THROW(hausdorff_distance(mesh, {{{1, 1, 1}}, {{0, 0, 0}}}, kSamples, context), Error);
  EXPECT_THROW(hausdorff_distance(mesh, surface, 999, context), Error);
}

// ---- the tree and the distance from inside a union against brute force ----------------------------------------------

MedialMesh random_mesh(std::uint64_t key, int spheres_count, double least_radius, double greatest_radius) {
  KeyedRandom random(5, 5, key);
  MedialMesh mesh;
  for (int v = 0; v < spheres_count; ++v) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    mesh.centers.push_back({x, y, z});
    mesh.radii.push_back(least_radius + (greatest_radius - least_radius) * random.uniform());
  }
  for (Index v = 0; v + 2 < spheres_count; v += 3) {
    if (v % 2 == 0) mesh.faces.push_back({v, v + 1, v + 2});
    mesh.edges.push_back({v, v + 1});
    mesh.edges.push_back({v, v + 2});
    mesh.edges.push_back({v + 1, v + 2});
  }
  return mesh;
}

double brute_distance(const MedialMesh& mesh, const Vec3& x) {
  const auto ball = [&](Index v) { return Ball{mesh.centers[uz(v)], mesh.radii[uz(v)]}; };
  double least = std::numeric_limits<double>::infinity();
  for (Index v = 0; v < count(mesh.centers); ++v) least = std::min(least, distance_to_ball(x, ball(v)));
  for (const auto& [i, j] : mesh.edges) least = std::min(least, closest_on_cone(x, ball(i), ball(j)).distance);
  for (const auto& [i, j, k] : mesh.faces)
    least = std::min(least, closest_on_slab(x, ball(i), ball(j), ball(k)).distance);
  return least;
}

Vec3 random_point(KeyedRandom& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return Vec3{x, y, z} * 1.4 - Vec3{0.2, 0.2, 0.2};
}

TEST(MedialTree, AgreesWithBruteForce) {
  for (std::uint64_t key = 0; key < 20; ++key) {
    const MedialMesh mesh = random_mesh(key, 1 + 4 * static_cast<int>(key), 0, 0.2);
    const MedialTree tree(mesh.centers, mesh.radii, maximal_primitives(mesh));
    for (std::uint64_t p = 0; p < 100; ++p) {
      KeyedRandom random(6, key, p);
      const Vec3 x = random_point(random);
      const double expected = brute_distance(mesh, x);
      const MedialHit hit = tree.closest(x);
      EXPECT_NEAR(hit.distance, expected, 1e-12);
      EXPECT_NEAR(distance_to_ball(x, hit.ball), expected, 1e-12);
      EXPECT_EQ(tree.covers(x, 0.01), hit.distance < -0.01);
    }
  }
}

// The bound that decides what a search leaves out, on smooth and on rough pieces.
TEST(BallBox, BoundsTheDistanceFromBelow) {
  struct Piece {
    std::array<Ball, 3> balls;
  };
  for (std::uint64_t key = 0; key < 200; ++key) {
    KeyedRandom random(9, 9, key);
    const Vec3 slope = random_point(random) * 0.5;
    const double roughness = key % 2 == 0 ? 0 : 0.2 * random.uniform();
    std::vector<Piece> pieces(1 + key % 4);
    for (Piece& piece : pieces) {
      for (Ball& ball : piece.balls) {
        ball.center = random_point(random) + Vec3{0.2, 0.2, 0.2};
        ball.center.z *= roughness;
        ball.radius = 0.5 + dot(slope, ball.center) + roughness * random.uniform();
      }
    }
    const auto& [a, b, c] = pieces[0].balls;
    for (const BallFrame& frame : {frame_of(a, b, c), frame_of(a, b, b), frame_of(a, a, a)}) {
      const BallBox box(frame, pieces);
      for (int p = 0; p < 20; ++p) {
        const Vec3 x = p == 0 ? box.center : random_point(random) * 2;
        double exact = std::numeric_limits<double>::infinity();
        for (const Piece& piece : pieces)
          exact = std::min(exact, closest_on_slab(x, piece.balls[0], piece.balls[1], piece.balls[2]).distance);
        EXPECT_LE(box.lower_bound(x), exact + 1e-12);
      }
    }
  }
}

TEST(MedialTree, KeepsOnlyMaximalPrimitives) {
  MedialMesh mesh = spheres(std::vector<Ball>(6));
  mesh.edges = {{0, 1}, {0, 2}, {1, 2}, {2, 3}};
  mesh.faces = {{0, 1, 2}};
  EXPECT_EQ(maximal_primitives(mesh), (std::vector<MedialPrimitive>{{0, 1, 2}, {2, 3, 3}, {4, 4, 4}, {5, 5, 5}}));
}

// Two balls of radius 1 meet in a circle of radius sqrt(3)/2, the concave crease of their union. From inside, its
// envelope is nearest at the crease or straight out of a ball at a place that is not in the other one.
TEST(Envelope, DistanceFromInsideTwoBallsInClosedForm) {
  Context context;
  const std::array<Ball, 2> balls{Ball{{-0.5, 0, 0}, 1}, Ball{{0.5, 0, 0}, 1}};
  const Envelope envelope(spheres({balls[0], balls[1]}), 5000, 1e-10, context);
  int at_crease = 0;
  for (std::uint64_t p = 0; p < 500; ++p) {
    KeyedRandom random(8, 8, p);
    const Vec3 x = Vec3{2 * random.uniform() - 1, random.uniform() - 0.5, random.uniform() - 0.5} * 1.4;
    if (std::min(distance_to_ball(x, balls[0]), distance_to_ball(x, balls[1])) > 0) continue;
    const double crease = std::hypot(x.x, std::hypot(x.y, x.z) - std::sqrt(0.75));
    double expected = crease;
    for (const std::size_t own : {0u, 1u}) {
      const Vec3 foot = balls[own].center + normalized(x - balls[own].center);
      if (distance_to_ball(foot, balls[1 - own]) >= 0) expected = std::min(expected, distance(x, foot));
    }
    at_crease += expected == crease ? 1 : 0;
    EXPECT_GE(envelope.distance(x), expected - 1e-9);
    EXPECT_LE(envelope.distance(x), 1.02 * expected + 1e-9);
  }
  EXPECT_GT(at_crease, 30);
}

// In a heap of primitives: not longer than to a point of a finer sample, and rarely so long that the ball of that
// radius clearly sticks out of the union.
TEST(Envelope, DistanceFromInsideAHeap) {
  Context context;
  int inside = 0, too_long = 0;
  for (std::uint64_t key = 0; key < 4; ++key) {
    const MedialMesh mesh = random_mesh(key, 12, 0.1, 0.3);
    const Envelope envelope(mesh, 5000, 1e-10, context), fine(mesh, 100000, 1e-10, context);
    for (std::uint64_t p = 0; p < 200; ++p) {
      KeyedRandom random(7, key, p);
      const Vec3 x = random_point(random);
      const double depth = -brute_distance(mesh, x);
      const double reported = envelope.distance(x);
      if (depth <= 0) {
        EXPECT_NEAR(reported, -depth, 1e-12);
        continue;
      }
      ++inside;
      EXPECT_GE(reported, depth - 1e-9);
      for (const Vec3& y : fine.samples().points) ASSERT_LE(reported, distance(x, y) + 0.005);
      bool sticks_out = false;
      for (int k = 0; k < 300; ++k) {
        const Vec3 direction = normalized(random_point(random) - Vec3{0.5, 0.5, 0.5});
        sticks_out |= brute_distance(mesh, x + direction * (0.99 * reported)) > 0;
      }
      too_long += sticks_out ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_LT(too_long, inside / 25);
}

}  // namespace
}  // namespace matstruct
