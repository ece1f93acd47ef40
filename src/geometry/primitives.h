// The solids of which a medial mesh is made: balls, cones (convex hull of two balls) and slabs (convex hull of three).
//
// The hull of balls (c_i, r_i) is the union of the balls (c(w), r(w)) whose centre and radius interpolate linearly with
// barycentric weights w. The signed distance from x to its boundary, negative inside, is therefore
//
//     f(x) = min over w >= 0, sum w = 1, of |x - c(w)| - r(w),
//
// a convex minimisation with a closed-form solution. This also holds inside: every inner normal of the hull runs into
// the centre of the ball that it starts from, so the deepest ball around x tells the depth of x. Balls inside the hull
// of the others, equal and collinear centres are all allowed.
#pragma once

#include <array>
#include <optional>

#include <matstruct/vec3.h>

namespace matstruct {

struct Ball {
  Vec3 center;
  double radius = 0;  ///< >= 0
};

/// The ball of a primitive that is nearest to a point.
struct PrimitiveHit {
  double distance = 0;            ///< signed distance from the point to the primitive, negative inside
  std::array<double, 3> weights;  ///< of the primitive's balls: >= 0, sum 1, unused ones 0
};

/// The ball at barycentric weights of a slab (or of a cone, with any third ball of weight 0).
Ball ball_at(const Ball& a, const Ball& b, const Ball& c, const std::array<double, 3>& weights);

/// Signed distance from `x` to the ball.
double distance_to_ball(const Vec3& x, const Ball& ball);
/// Nearest ball of the cone ab.
PrimitiveHit closest_on_cone(const Vec3& x, const Ball& a, const Ball& b);
/// Nearest ball of the slab abc.
PrimitiveHit closest_on_slab(const Vec3& x, const Ball& a, const Ball& b, const Ball& c);
/// Closest point of the triangle abc, which may be degenerate, as weights with their (unsigned) distance.
PrimitiveHit closest_on_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c);

/// The lateral surface of a cone touches the balls at c(w) + r(w) u for the unit vectors u that make one angle with its
/// axis.
struct ConeSide {
  Vec3 axis;          ///< unit, from a to b
  double along = 0;   ///< component of u along the axis
  double across = 0;  ///< length of u across the axis, > 0
  double area = 0;    ///< of the lateral surface
};
/// Nothing if one ball holds the other: then the cone is that ball.
std::optional<ConeSide> cone_side(const Ball& a, const Ball& b);

/// Unit normals of the two planes that are tangent to all three balls of a slab and have them on one side; the planes
/// touch ball i at c_i + r_i * normal. The first normal is on the side of cross(b - a, c - a). Nothing if there are no
/// such planes: then the slab is the union of its cones.
std::optional<std::array<Vec3, 2>> slab_normals(const Ball& a, const Ball& b, const Ball& c);

/// Two unit vectors that complete the unit vector `axis` to a right-handed orthonormal basis.
std::array<Vec3, 2> orthonormal_to(const Vec3& axis);

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c);
/// 6/sqrt(3) * area / (half perimeter * longest edge), in [0, 1]: 1 if equilateral (Frey & Borouchaki 1999), 0 for a
/// triangle without area, also one that is a point.
double triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace matstruct
