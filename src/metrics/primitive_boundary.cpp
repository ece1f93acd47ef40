#include "metrics/primitive_boundary.h"

#include <cmath>
#include <numbers>

namespace matstruct {

namespace {

BoundaryPoint on_ball(const Ball& ball, const Vec3& normal) {
  return {ball.center + normal * ball.radius, normal};
}

}  // namespace

PrimitiveBoundary PrimitiveBoundary::of_ball(const Ball& a) {
  PrimitiveBoundary boundary(Kind::kBall, {a, a, a});
  boundary.exists_ = true;
  boundary.area_ = 4 * std::numbers::pi * a.radius * a.radius;
  return boundary;
}

PrimitiveBoundary PrimitiveBoundary::of_cone(const Ball& a, const Ball& b) {
  PrimitiveBoundary boundary(Kind::kCone, {a, b, b});
  if (const auto side = cone_side(a, b)) {
    boundary.exists_ = true;
    boundary.area_ = side->area;
    boundary.side_ = *side;
  }
  return boundary;
}

PrimitiveBoundary PrimitiveBoundary::of_slab(const Ball& a, const Ball& b, const Ball& c) {
  PrimitiveBoundary boundary(Kind::kSlab, {a, b, c});
  if (const auto normals = slab_normals(a, b, c)) {
    boundary.exists_ = true;
    boundary.normals_ = *normals;
    for (const Vec3& n : *normals)
      boundary.area_ += triangle_area(a.center + n * a.radius, b.center + n * b.radius, c.center + n * c.radius);
  }
  return boundary;
}

BoundaryPoint PrimitiveBoundary::point(double u, double v) const {
  switch (kind_) {
    case Kind::kBall:
      return point_on_ball(u, v);
    case Kind::kCone:
      return point_on_cone(u, v);
    case Kind::kSlab:
      return point_on_slab(u, v);
  }
  return {};
}

/// Archimedes: the height of a uniform point of a sphere is uniform.
BoundaryPoint PrimitiveBoundary::point_on_ball(double u, double v) const {
  const double height = 2 * u - 1, angle = 2 * std::numbers::pi * v;
  const double circle = std::sqrt(std::max(0.0, 1 - height * height));
  const Vec3 direction{circle * std::cos(angle), circle * std::sin(angle), height};
  return on_ball(balls_[0], direction);
}

/// The area up to w grows with ra w + (rb - ra) w^2 / 2; w solves that for the share u of the whole.
BoundaryPoint PrimitiveBoundary::point_on_cone(double u, double v) const {
  const auto& [a, b, unused] = balls_;
  const double ra = a.radius, rb = b.radius;
  const double root = std::sqrt(ra * ra + u * (rb * rb - ra * ra));
  const double w = ra + root > 0 ? u * (ra + rb) / (ra + root) : u;
  const double angle = 2 * std::numbers::pi * v;
  const auto [e1, e2] = orthonormal_to(side_.axis);
  const Vec3 direction = side_.axis * side_.along + (e1 * std::cos(angle) + e2 * std::sin(angle)) * side_.across;
  return on_ball(ball_at(a, b, unused, {1 - w, w, 0}), direction);
}

/// The two triangles are mirror images; the halves of the unit square stand for them.
BoundaryPoint PrimitiveBoundary::point_on_slab(double u, double v) const {
  const bool first = u < 0.5;
  const Vec3& normal = normals_[first ? 0 : 1];
  const double root = std::sqrt(first ? 2 * u : 2 * u - 1);
  const auto& [a, b, c] = balls_;
  return on_ball(ball_at(a, b, c, {1 - root, root * (1 - v), root * v}), normal);
}

}  // namespace matstruct
