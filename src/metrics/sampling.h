// Evenly spread points on triangles, deterministic and free of random numbers.
#pragma once

#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// A place on a triangle, for whatever is interpolated over it.
struct TriangleSample {
  Index triangle = kInvalid;
  double from_first = 0;  ///< from the first corner (0) to the opposite side (1)
  double along_side = 0;  ///< along that side, from the second corner (0) to the third (1)

  Vec3 at(const Vec3& a, const Vec3& b, const Vec3& c) const { return lerp(a, lerp(b, c, along_side), from_first); }
  double at(double a, double b, double c) const { return a + (b + (c - b) * along_side - a) * from_first; }
};

/// `samples` places uniform by area: equal steps along the running sum of the triangles' areas, the place in a triangle
/// from the R2 low-discrepancy sequence (Roberts 2018). None if there are no triangles.
std::vector<TriangleSample> sample_by_area(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                           Index samples);

/// Length of the diagonal of the bounding box of the surface's triangles; 0 without triangles.
double diagonal_of(const TriSurface& surface);

}  // namespace matstruct
