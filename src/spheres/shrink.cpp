// Sphere shrinking: J. Ma, S. W. Bae and S. Choi, "3D medial axis point approximation using nearest neighbors and the
// normal field", The Visual Computer 2012, on the surface itself instead of a point cloud.
//
// Notation: p pin, n its outward normal, c = p - r n centre of a ball tangent at p, q surface point nearest to c. The
// ball tangent at p that passes through q has radius |p - q|^2 / (2 n.(p - q)); the step is Newton's for the equation
// dist(c) = r, hence quadratic, and exact in the limit for planes.
#include "spheres/shrink.h"

#include <cmath>
#include <numbers>

#include "base/index.h"
#include "base/parallel.h"
#include "base/tolerances.h"

namespace matstruct {
namespace {

// Caps, far above what is needed: steps stay below 15 on real parts.
constexpr int kMaxSteps = 200;
constexpr int kMaxClimbs = 20;
constexpr Index kGrain = 64;

/// A ball tangent at a pin, on its way.
struct Ball {
  Vec3 center;
  double radius = 0;
  SurfaceHit contact;           ///< what the ball was last shrunk to pass through; no triangle: nothing yet
  SurfaceHit nearest;           ///< to the centre
  bool stopped_smooth = false;  ///< the next contact would have been one with the pin
};

/// Angle at the centre of a ball of radius r between two points of its sphere at squared distance d2.
double angle_of_chord(double d2, double r) {
  return 2 * std::asin(std::min(1.0, 0.5 * std::sqrt(d2) / r));
}

/// Shrinks until the ball is empty to rounding or its next contact is a smooth one.
Ball shrink_along_normal(const Domain& domain, const Pin& pin, double smooth_angle) {
  const double smallest_step = tolerance::kShrinkStep * domain.diagonal;
  Ball ball;
  ball.radius = tolerance::kShrinkStart * domain.diagonal;
  ball.center = pin.point - pin.normal * ball.radius;
  ball.nearest = domain.query.closest_near(ball.center, pin.triangle);
  for (int step = 0; step < kMaxSteps; ++step) {
    const double depth = ball.radius - std::sqrt(ball.nearest.distance2);
    if (depth <= smallest_step) break;
    const Vec3 chord = pin.point - ball.nearest.point;
    const double along = dot(pin.normal, chord);
    // A point inside the ball has along > 0; rounding may say otherwise of one beside the pin.
    if (along <= 0 || norm2(chord) <= smallest_step * smallest_step) break;
    const double radius = norm2(chord) / (2 * along);
    if (radius >= ball.radius) break;
    if (angle_of_chord(norm2(chord), radius) < smooth_angle) {
      ball.stopped_smooth = true;
      break;
    }
    const bool last = ball.radius - radius <= smallest_step;
    ball.contact = ball.nearest;
    ball.radius = radius;
    ball.center = pin.point - pin.normal * radius;
    ball.nearest = domain.query.closest_near(ball.center, ball.contact.triangle);
    if (last) break;
  }
  return ball;
}

bool fits_badly(const Ball& ball) {
  return ball.stopped_smooth && ball.radius - std::sqrt(ball.nearest.distance2) > tolerance::kSmoothGap * ball.radius;
}

ShrunkSphere finished(const Domain& domain, const Pin& pin, const Ball& ball) {
  ShrunkSphere sphere;
  sphere.center = ball.center;
  if (ball.contact.triangle == kInvalid) return sphere;
  const double signed_distance = domain.query.signed_distance(ball.center, ball.nearest.triangle);
  sphere.radius = std::abs(signed_distance);
  // The contact was found from the centre of the step before, which is good to the square root of the depth only.
  sphere.contact = domain.query.closest_on(ball.contact.triangle, ball.center).point;
  sphere.contact_triangle = ball.contact.triangle;
  sphere.separation = angle_between(pin.point - ball.center, sphere.contact - ball.center);
  sphere.converged = signed_distance < -tolerance::kSmallestRadius * domain.diagonal;
  return sphere;
}

}  // namespace

ShrunkSphere shrink_sphere(const Domain& domain, const Pin& pin, double smooth_angle) {
  Ball ball = shrink_along_normal(domain, pin, smooth_angle);
  // The ball about the same centre that touches the nearest point is empty. The one that shrinks from there contains
  // it: the radius grows with every climb.
  for (int climb = 0; climb < kMaxClimbs && fits_badly(ball); ++climb) {
    const SurfaceHit foot = ball.nearest;
    const Vec3 outward = normalized(foot.point - ball.center);
    if (dot(outward, domain.triangle_normals[uz(foot.triangle)]) <= 0) break;
    const Ball next = shrink_along_normal(domain, {foot.point, outward, foot.triangle}, smooth_angle);
    if (next.contact.triangle == kInvalid || next.nearest.distance2 <= ball.nearest.distance2) break;
    ball = next;
  }
  return finished(domain, pin, ball);
}

std::vector<ShrunkSphere> shrink_spheres(const Domain& domain, const std::vector<Pin>& pins, double smooth_angle,
                                         const Context& context) {
  std::vector<ShrunkSphere> spheres(pins.size());
  parallel_for(context, count(pins), kGrain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) spheres[uz(i)] = shrink_sphere(domain, pins[uz(i)], smooth_angle);
  });
  return spheres;
}

}  // namespace matstruct
