// Points on the boundaries of medial primitives: spheres, sides of cones, tangent triangles of slabs.
#pragma once

#include <array>

#include <matstruct/types.h>

#include "geometry/primitives.h"

namespace matstruct {

struct BoundaryPoint {
  Vec3 position;
  Vec3 normal;  ///< unit, outward
};

/// The part of a primitive's boundary that is not on a smaller primitive, in parametric form.
class PrimitiveBoundary {
 public:
  static PrimitiveBoundary of_ball(const Ball& a);
  /// No area if one ball holds the other.
  static PrimitiveBoundary of_cone(const Ball& a, const Ball& b);
  /// The two tangent triangles; no area if there are none.
  static PrimitiveBoundary of_slab(const Ball& a, const Ball& b, const Ball& c);

  /// False if there is nothing to sample: the boundary is that of a smaller primitive.
  bool exists() const { return exists_; }
  double area() const { return area_; }
  /// Maps the unit square to the boundary, uniformly with respect to area.
  BoundaryPoint point(double u, double v) const;

 private:
  enum class Kind { kBall, kCone, kSlab };
  PrimitiveBoundary(Kind kind, const std::array<Ball, 3>& balls) : kind_(kind), balls_(balls) {}
  BoundaryPoint point_on_ball(double u, double v) const;
  BoundaryPoint point_on_cone(double u, double v) const;
  BoundaryPoint point_on_slab(double u, double v) const;

  Kind kind_;
  bool exists_ = false;
  double area_ = 0;
  std::array<Ball, 3> balls_;
  ConeSide side_;                // of a cone
  std::array<Vec3, 2> normals_;  // of a slab
};

}  // namespace matstruct
