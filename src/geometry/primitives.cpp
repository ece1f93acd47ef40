// Notation: x the point, w the weights, c(w) and r(w) the interpolated centre and radius, and s (cone) or g (slab) the
// slope of the radius: its derivative along the axis, its gradient in the plane of the centres.
//
// Where |x - c| - r is stationary, the unit vector u from c to x has the component -s along the axis (-g in the plane).
// So with h the distance from x to the axis (plane) and q the foot of that perpendicular, c = q + h s / sqrt(1 - s^2).
// As the function is convex, a stationary point outside the segment (triangle) puts the minimum on its boundary.
#include "geometry/primitives.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace matstruct {

namespace {

PrimitiveHit hit_at(const Vec3& x, const Ball& a, const Ball& b, const Ball& c, const std::array<double, 3>& weights) {
  return {distance_to_ball(x, ball_at(a, b, c, weights)), weights};
}

/// How far the weights of a stationary point may be off, relative to their sum, for slabs that are not thin.
constexpr double kWeightRounding = 1e-6;
/// Squared sine of the angle at the first centre below which a slab is thin: rounding may make of its weights anything.
constexpr double kThin2 = 1e-6;

/// Coordinates in the basis (e1, e2) of the slab's plane of a vector given by its dot products with e1 and e2.
std::array<double, 2> solve(const SlabFrame& frame, double with_e1, double with_e2) {
  return {(frame.e22 * with_e1 - frame.e12 * with_e2) / frame.normal2,
          (frame.e11 * with_e2 - frame.e12 * with_e1) / frame.normal2};
}

/// Weights of the least point of the whole plane, some of which are negative if it is not in the triangle.
std::array<double, 3> stationary(const Vec3& x, const Ball& a, const SlabFrame& frame) {
  const Vec3 p = x - a.center;
  const auto [q1, q2] = solve(frame, dot(p, frame.e1), dot(p, frame.e2));
  const double shift = std::abs(dot(p, frame.normal)) / frame.foot;
  const double w1 = q1 + shift * frame.g1, w2 = q2 + shift * frame.g2;
  return {1 - w1 - w2, w1, w2};
}

/// With frame_of_side(k) that of the cone from ball k to the next one. What is convex has its least value in the
/// triangle at the stationary point, or on a side that separates the triangle from it.
template <class FrameOfSide>
PrimitiveHit closest(const Vec3& x, const std::array<Ball, 3>& balls, const std::optional<SlabFrame>& frame,
                     const FrameOfSide& frame_of_side) {
  const auto& [a, b, c] = balls;
  std::array<double, 3> weights{-1, -1, -1};
  double rounding = 0;
  PrimitiveHit best{std::numeric_limits<double>::infinity(), {}};
  if (frame) {
    weights = stationary(x, a, *frame);
    rounding = frame->rounding * (std::abs(weights[0]) + std::abs(weights[1]) + std::abs(weights[2]));
    if (weights[0] >= 0 && weights[1] >= 0 && weights[2] >= 0) {
      best = hit_at(x, a, b, c, weights);
      if (!frame->thin()) return best;
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3, opposite = (k + 2) % 3;
    if (weights[opposite] > rounding) continue;
    const PrimitiveHit hit = closest_on_cone(x, balls[k], balls[next], frame_of_side(k));
    if (!(hit.distance < best.distance)) continue;
    best.distance = hit.distance;
    best.weights[k] = hit.weights[0];
    best.weights[next] = hit.weights[1];
    best.weights[opposite] = 0;
  }
  return best;
}

}  // namespace

Ball ball_at(const Ball& a, const Ball& b, const Ball& c, const std::array<double, 3>& w) {
  // Differences from a, so that a primitive whose centres are equal keeps them to the last bit.
  return {a.center + (b.center - a.center) * w[1] + (c.center - a.center) * w[2],
          std::max(0.0, w[0] * a.radius + w[1] * b.radius + w[2] * c.radius)};
}

double distance_to_ball(const Vec3& x, const Ball& ball) {
  return distance(x, ball.center) - ball.radius;
}

ConeFrame cone_frame(const Ball& a, const Ball& b) {
  ConeFrame frame;
  frame.greater = a.radius >= b.radius ? 0 : 1;
  const auto side = cone_side(a, b);
  if (!side) return frame;
  frame.axis = side->axis;
  frame.lean = side->along / side->across;
  frame.length = distance(a.center, b.center);
  return frame;
}

std::optional<SlabFrame> slab_frame(const Ball& a, const Ball& b, const Ball& c) {
  SlabFrame frame;
  frame.e1 = b.center - a.center;
  frame.e2 = c.center - a.center;
  frame.normal = cross(frame.e1, frame.e2);
  frame.normal2 = norm2(frame.normal);
  if (!(frame.normal2 > 0)) return std::nullopt;
  frame.e11 = norm2(frame.e1);
  frame.e12 = dot(frame.e1, frame.e2);
  frame.e22 = norm2(frame.e2);
  const auto [g1, g2] = solve(frame, b.radius - a.radius, c.radius - a.radius);
  const double slope2 = norm2(frame.e1 * g1 + frame.e2 * g2);
  if (!(slope2 < 1)) return std::nullopt;
  frame.g1 = g1;
  frame.g2 = g2;
  frame.cosine = std::sqrt(1 - slope2);
  frame.foot = std::sqrt(frame.normal2) * frame.cosine;
  const bool is_thin = frame.normal2 < kThin2 * frame.e11 * frame.e22;
  frame.rounding = is_thin ? std::numeric_limits<double>::infinity() : kWeightRounding;
  return frame;
}

PrimitiveHit closest_on_cone(const Vec3& x, const Ball& a, const Ball& b, const ConeFrame& frame) {
  double w = frame.greater;
  if (frame.length > 0) {
    const Vec3 p = x - a.center;
    const double along = dot(p, frame.axis);
    const double across = norm(p - frame.axis * along);
    w = std::clamp((along - across * frame.lean) / frame.length, 0.0, 1.0);
  }
  return hit_at(x, a, b, a, {1 - w, w, 0});
}

PrimitiveHit closest_on_cone(const Vec3& x, const Ball& a, const Ball& b) {
  return closest_on_cone(x, a, b, cone_frame(a, b));
}

PrimitiveHit closest_on_slab(const Vec3& x, const std::array<Ball, 3>& balls, const std::optional<SlabFrame>& frame,
                             const std::array<ConeFrame, 3>& sides) {
  return closest(x, balls, frame, [&](std::size_t k) { return sides[k]; });
}

PrimitiveHit closest_on_slab(const Vec3& x, const Ball& a, const Ball& b, const Ball& c) {
  const std::array<Ball, 3> balls{a, b, c};
  return closest(x, balls, slab_frame(a, b, c),
                 [&](std::size_t k) { return cone_frame(balls[k], balls[(k + 1) % 3]); });
}

PrimitiveHit closest_on_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  return closest_on_slab(x, {a, 0}, {b, 0}, {c, 0});
}

std::optional<ConeSide> cone_side(const Ball& a, const Ball& b) {
  const Vec3 d = b.center - a.center;
  const double length = norm(d);
  const double growth = b.radius - a.radius;
  if (!(length > std::abs(growth))) return std::nullopt;
  const double across = std::sqrt((length - growth) * (length + growth)) / length;
  // Along the side, a frustum of radii r * across, whose slant is the axis shortened by the same factor.
  const double area = std::numbers::pi * (a.radius + b.radius) * across * length * across;
  return ConeSide{d / length, -growth / length, across, area};
}

std::optional<std::array<Vec3, 2>> slab_normals(const Ball& a, const Ball& b, const Ball& c) {
  const auto frame = slab_frame(a, b, c);
  if (!frame) return std::nullopt;
  const Vec3 gradient = frame->e1 * frame->g1 + frame->e2 * frame->g2;
  const Vec3 up = frame->normal * (frame->cosine / std::sqrt(frame->normal2));
  return std::array<Vec3, 2>{up - gradient, -up - gradient};
}

std::array<Vec3, 2> orthonormal_to(const Vec3& axis) {
  const Vec3 other = std::abs(axis.x) < std::abs(axis.y) ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 first = normalized(cross(axis, other));
  return {first, cross(axis, first)};
}

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return norm(cross(b - a, c - a)) / 2;
}

double triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double ab = distance(a, b), bc = distance(b, c), ca = distance(c, a);
  const double longest = std::max({ab, bc, ca});
  if (!(longest > 0)) return 0;
  const double half_perimeter = (ab + bc + ca) / 2;
  return 2 * std::numbers::sqrt3 * triangle_area(a, b, c) / (half_perimeter * longest);
}

}  // namespace matstruct
