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

/// What the distances to a cone have in common, for many of them.
struct ConeFrame {
  double greater = 0;  ///< weight of b at the greater ball: the nearest one if that holds the other
  double length = 0;   ///< of the axis; 0 if one ball holds the other
  double lean = 0;     ///< shift of the nearest ball against the axis, per distance from it
  Vec3 axis;           ///< unit, from a to b
};
ConeFrame cone_frame(const Ball& a, const Ball& b);
PrimitiveHit closest_on_cone(const Vec3& x, const Ball& a, const Ball& b, const ConeFrame& frame);

/// What the distances to a slab have in common: the plane of its centres in the basis (b - a, c - a), and the gradient
/// of the radius in it.
struct SlabFrame {
  Vec3 e1, e2;
  double e11 = 0, e12 = 0, e22 = 0;  ///< their dot products
  Vec3 normal;                       ///< cross(e1, e2), not normalised
  double normal2 = 0;                ///< its squared length, the determinant of the Gram matrix of e1, e2
  double g1 = 0, g2 = 0;             ///< gradient of the radius in the basis
  double cosine = 0;                 ///< sqrt(1 - |gradient|^2), of the angle between the plane and the tangent planes
  double foot = 0;                   ///< |normal| * cosine
  double rounding = 0;               ///< of weights, relative to their sum; infinite if the slab is thin
  bool thin() const { return rounding > 1; }
};
/// Nothing if the centres are collinear or the radius is too steep for tangent planes.
std::optional<SlabFrame> slab_frame(const Ball& a, const Ball& b, const Ball& c);
/// With the frame of the slab, and those of the cones from each ball to the next one.
PrimitiveHit closest_on_slab(const Vec3& x, const std::array<Ball, 3>& balls, const std::optional<SlabFrame>& frame,
                             const std::array<ConeFrame, 3>& sides);

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
