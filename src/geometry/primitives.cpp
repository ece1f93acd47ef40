// Notation: x the point, w the weights, c(w) and r(w) the interpolated centre and radius, and s (cone) or g (slab) the
// slope of the radius: its derivative along the axis, its gradient in the plane of the centres.
//
// Where |x - c| - r is stationary, the unit vector u from c to x has the component -s along the axis (-g in the plane).
// So with h the distance from x to the axis (plane) and q the foot of that perpendicular, c = q + h s / sqrt(1 - s^2).
// As the function is convex, a stationary point outside the segment (triangle) puts the minimum on its boundary.
#include "geometry/primitives.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace matstruct {

namespace {

PrimitiveHit hit_at(const Vec3& x, const Ball& a, const Ball& b, const Ball& c, const std::array<double, 3>& weights) {
  return {distance_to_ball(x, ball_at(a, b, c, weights)), weights};
}

/// The plane of a slab's centres in the basis (b - a, c - a), and in it the gradient of the radius.
struct SlabFrame {
  Vec3 e1, e2;
  Vec3 normal;            // cross(e1, e2), not normalised
  double normal2 = 0;     // its squared length, the determinant of the Gram matrix of e1, e2
  double g1 = 0, g2 = 0;  // gradient of the radius in the basis
  double cosine = 0;      // sqrt(1 - |g|^2), of the angle between the plane and the tangent planes

  /// Coordinates in the basis of a vector given by its dot products with e1 and e2.
  std::array<double, 2> solve(double with_e1, double with_e2) const {
    const double e11 = norm2(e1), e12 = dot(e1, e2), e22 = norm2(e2);
    return {(e22 * with_e1 - e12 * with_e2) / normal2, (e11 * with_e2 - e12 * with_e1) / normal2};
  }
};

/// Nothing if the centres are collinear or the radius is too steep for tangent planes.
std::optional<SlabFrame> slab_frame(const Ball& a, const Ball& b, const Ball& c) {
  SlabFrame frame;
  frame.e1 = b.center - a.center;
  frame.e2 = c.center - a.center;
  frame.normal = cross(frame.e1, frame.e2);
  frame.normal2 = norm2(frame.normal);
  if (!(frame.normal2 > 0)) return std::nullopt;
  const auto [g1, g2] = frame.solve(b.radius - a.radius, c.radius - a.radius);
  const double slope2 = norm2(frame.e1 * g1 + frame.e2 * g2);
  if (!(slope2 < 1)) return std::nullopt;
  frame.g1 = g1;
  frame.g2 = g2;
  frame.cosine = std::sqrt(1 - slope2);
  return frame;
}

/// Weights of the stationary point if it lies in the triangle.
std::optional<std::array<double, 3>> stationary_in_slab(const Vec3& x, const Ball& a, const Ball& b, const Ball& c) {
  const auto frame = slab_frame(a, b, c);
  if (!frame) return std::nullopt;
  const Vec3 p = x - a.center;
  const auto [q1, q2] = frame->solve(dot(p, frame->e1), dot(p, frame->e2));
  const double shift = std::abs(dot(p, frame->normal)) / (std::sqrt(frame->normal2) * frame->cosine);
  const double w1 = q1 + shift * frame->g1, w2 = q2 + shift * frame->g2;
  const std::array<double, 3> weights{1 - w1 - w2, w1, w2};
  if (!(weights[0] >= 0 && w1 >= 0 && w2 >= 0)) return std::nullopt;
  return weights;
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

PrimitiveHit closest_on_cone(const Vec3& x, const Ball& a, const Ball& b) {
  const auto side = cone_side(a, b);
  double w = a.radius >= b.radius ? 0 : 1;
  if (side) {
    const Vec3 p = x - a.center;
    const double along = dot(p, side->axis);
    const double across = norm(p - side->axis * along);
    const double stationary = along - across * side->along / side->across;
    w = std::clamp(stationary / distance(a.center, b.center), 0.0, 1.0);
  }
  return hit_at(x, a, b, a, {1 - w, w, 0});
}

PrimitiveHit closest_on_slab(const Vec3& x, const Ball& a, const Ball& b, const Ball& c) {
  if (const auto weights = stationary_in_slab(x, a, b, c)) return hit_at(x, a, b, c, *weights);
  PrimitiveHit best = closest_on_cone(x, a, b);
  const PrimitiveHit bc = closest_on_cone(x, b, c);
  if (bc.distance < best.distance) best = {bc.distance, {0, bc.weights[0], bc.weights[1]}};
  const PrimitiveHit ca = closest_on_cone(x, c, a);
  if (ca.distance < best.distance) best = {ca.distance, {ca.weights[1], 0, ca.weights[0]}};
  return best;
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
