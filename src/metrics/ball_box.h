// Bounding volume of balls of a piece of a medial mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <matstruct/vec3.h>

#include "geometry/primitives.h"

namespace matstruct {

/// Orthonormal axes and a gradient of the radius in their directions.
struct BallFrame {
  std::array<Vec3, 3> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  Vec3 slope;  ///< in the axes, shorter than 1
};
/// The frame in which the balls of a slab (of a cone, if b = c; of a ball, if all are equal) have no extent across the
/// slab and, if it has tangent planes, a radius with that slope.
BallFrame frame_of(const Ball& a, const Ball& b, const Ball& c);

/// Balls whose centres are in an oriented box around `center` and whose radius at the offset y from it, in the axes, is
/// at most radius + slope . y. On a smooth piece of a medial mesh neighbouring balls nearly follow such a rule, and
/// touch nearly the same planes; a bound of centre and radius separately would be off by the size of the piece.
struct BallBox {
  BallFrame frame;
  Vec3 center;
  Vec3 half;  ///< half extents along the axes
  double radius = 0;
  double lean = 0;  ///< shift of the nearest ball per distance from the box, along the slope: 1 / sqrt(1 - |slope|^2)

  /// The box of balls given as a range of primitives with a member `balls`.
  template <class Primitives>
  BallBox(const BallFrame& axes_and_slope, const Primitives& primitives);

  /// Never more than the signed distance from `x` to the union of all balls in the box.
  double lower_bound(const Vec3& x) const;

 private:
  Vec3 local(const Vec3& p) const { return {dot(frame.axes[0], p), dot(frame.axes[1], p), dot(frame.axes[2], p)}; }
  Vec3 world(const Vec3& y) const { return frame.axes[0] * y.x + frame.axes[1] * y.y + frame.axes[2] * y.z; }
};

template <class Primitives>
BallBox::BallBox(const BallFrame& axes_and_slope, const Primitives& primitives)
    : frame(axes_and_slope), lean(1 / std::sqrt(1 - norm2(axes_and_slope.slope))) {
  const Vec3 origin = primitives.front().balls[0].center;
  Vec3 low, high;  // contain the origin itself
  for (const auto& primitive : primitives) {
    for (const Ball& ball : primitive.balls) {
      low = min(low, local(ball.center - origin));
      high = max(high, local(ball.center - origin));
    }
  }
  center = origin + world((low + high) / 2);
  half = (high - low) / 2;
  radius = -std::numeric_limits<double>::infinity();
  for (const auto& primitive : primitives)
    for (const Ball& ball : primitive.balls)
      radius = std::max(radius, ball.radius - dot(frame.slope, local(ball.center - center)));
}

}  // namespace matstruct
