#include "metrics/ball_box.h"

namespace matstruct {

BallFrame frame_of(const Ball& a, const Ball& b, const Ball& c) {
  BallFrame frame;
  Vec3 gradient;
  if (const auto normals = slab_normals(a, b, c)) {
    const Vec3 e1 = normalized(b.center - a.center);
    const Vec3 e3 = normalized((*normals)[0] - (*normals)[1]);
    frame.axes = {e1, cross(e3, e1), e3};
    gradient = ((*normals)[0] + (*normals)[1]) / -2;
  } else if (const auto side = cone_side(a, b)) {
    const auto [e2, e3] = orthonormal_to(side->axis);
    frame.axes = {side->axis, e2, e3};
    gradient = side->axis * -side->along;
  }
  frame.slope = {dot(frame.axes[0], gradient), dot(frame.axes[1], gradient), dot(frame.axes[2], gradient)};
  if (!(norm2(frame.slope) < 1)) frame.slope = {};
  return frame;
}

/// For every vector u no longer than 1, |x - c| - r >= u . (x - c) - r, which for balls in the box is least at one of
/// its corners. The best u points from the nearest ball to x; that ball is found as in a slab, with the box as its
/// triangle.
double BallBox::lower_bound(const Vec3& x) const {
  const Vec3 p = local(x - center);
  const Vec3 outside = p - min(max(p, -half), half);
  const Vec3 shifted = p + frame.slope * (std::max(std::abs(p.z), norm(outside)) * lean);
  const Vec3 nearest = min(max(shifted, -half), half);
  const Vec3 u = normalized(p - nearest);
  const double reach = std::abs(u.x + frame.slope.x) * half.x + std::abs(u.y + frame.slope.y) * half.y +
                       std::abs(u.z + frame.slope.z) * half.z;
  return dot(u, p) - radius - reach;
}

}  // namespace matstruct
