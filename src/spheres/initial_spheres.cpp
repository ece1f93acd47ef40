#include "spheres/initial_spheres.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "base/index.h"
#include "base/parallel.h"
#include "spheres/feature_spheres.h"
#include "spheres/guards.h"
#include "spheres/pins.h"
#include "spheres/point_grid.h"
#include "spheres/shrink.h"

namespace matstruct {

namespace {

// Spheres nearer to each other than this share of the spacing crowd, and nearer to a sharp line hug it.
constexpr double kCrowding = 0.5;
// A sphere inside the solid of at least this share of a hugging sphere's radius, and this much farther from the line...
constexpr double kNoLessRadius = 0.99, kFartherInside = 1.5;
// ...within this many spacings, makes the hugging sphere superfluous.
constexpr double kWitnessReach = 1.5;

struct Ball {
  Vec3 center;
  double radius = 0;
  double line_distance = 0;  // to the nearest convex sharp edge
};

double distance_to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double t = std::clamp(dot(x - a, ab) / norm2(ab), 0.0, 1.0);
  return distance(x, a + t * ab);
}

// Distances to the convex sharp edges, exact up to `reach`, which replaces greater ones.
void measure_line_distances(const Domain& domain, double reach, std::vector<Ball>& balls) {
  std::vector<Vec3> centers;
  for (const Ball& b : balls) centers.push_back(b.center);
  const PointGrid grid(centers, reach);
  for (Ball& b : balls) b.line_distance = reach;
  for (const SharpEdge& e : domain.features.edges) {
    if (e.kind != EdgeKind::kConvex) continue;
    const Vec3 &a = domain.surface.vertices[uz(e.vertices[0])], &b = domain.surface.vertices[uz(e.vertices[1])];
    grid.for_each_in_box(min(a, b) - Vec3{reach, reach, reach}, max(a, b) + Vec3{reach, reach, reach}, [&](Index k) {
      balls[uz(k)].line_distance = std::min(balls[uz(k)].line_distance, distance_to_segment(centers[uz(k)], a, b));
    });
  }
}

std::vector<bool> hugging(const std::vector<Ball>& balls, double spacing) {
  std::vector<Vec3> centers;
  for (const Ball& b : balls) centers.push_back(b.center);
  const double reach = kWitnessReach * spacing;
  const PointGrid grid(centers, reach);
  std::vector<bool> result(balls.size(), false);
  for (std::size_t k = 0; k < balls.size(); ++k) {
    const Ball& b = balls[k];
    if (b.line_distance >= kCrowding * spacing) continue;
    grid.for_each_near(b.center, reach, [&](Index m) {
      const Ball& other = balls[uz(m)];
      if (other.radius >= kNoLessRadius * b.radius && other.line_distance >= kFartherInside * b.line_distance)
        result[k] = true;
    });
  }
  return result;
}

// Greatest first; a ball is dropped if a kept one lies within the crowding distance on the same sheet.
std::vector<Ball> thinned(const std::vector<Ball>& balls, double spacing) {
  std::vector<Index> order(balls.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return balls[uz(a)].radius > balls[uz(b)].radius; });
  std::vector<Vec3> centers;
  for (const Ball& b : balls) centers.push_back(b.center);
  const double reach = kCrowding * spacing;
  const PointGrid grid(centers, reach);
  std::vector<bool> kept(balls.size(), false);
  std::vector<Ball> result;
  for (const Index k : order) {
    bool crowded = false;
    grid.for_each_near(centers[uz(k)], reach, [&](Index m) {
      crowded = crowded || (kept[uz(m)] && distance(centers[uz(k)], centers[uz(m)]) < balls[uz(m)].radius);
    });
    if (crowded) continue;
    kept[uz(k)] = true;
    result.push_back(balls[uz(k)]);
  }
  return result;
}

}  // namespace

double target_spacing(const Domain& domain, const Options& options) {
  return domain.diagonal / options.gamma;
}

double smooth_angle(const Options& options) {
  return options.convex_angle * std::numbers::pi / 180;
}

Spheres initial_spheres(const Domain& domain, const Options& options, const Context& context) {
  const double spacing = target_spacing(domain, options);
  std::vector<Pin> pins = sample_surface(domain, spacing, options.seed, context);
  const std::vector<Pin> concave = sample_concave_lines(domain, spacing, smooth_angle(options));
  pins.insert(pins.end(), concave.begin(), concave.end());

  std::vector<Ball> balls;
  for (const ShrunkSphere& s : shrink_spheres(domain, pins, smooth_angle(options), context))
    if (s.converged) balls.push_back({s.center, s.radius, 0});
  measure_line_distances(domain, kWitnessReach * spacing, balls);
  const std::vector<bool> hugs = hugging(balls, spacing);
  std::vector<Ball> free;
  for (std::size_t k = 0; k < balls.size(); ++k)
    if (!hugs[k]) free.push_back(balls[k]);

  Spheres spheres;
  const std::vector<SphereSeed> guards = guard_spheres(domain, spacing, context);
  const FeatureReach reach(domain, guards);
  for (SphereSeed& s : feature_spheres(domain, spacing)) {
    s.reach = reach.at(s.center);
    spheres.add(s);
  }
  for (const SphereSeed& s : guards) spheres.add(s);
  for (const Ball& b : thinned(free, spacing))
    spheres.add({b.center, b.radius, SphereType::kSheet, kInvalid, kInvalid, 0});
  return spheres;
}

}  // namespace matstruct
