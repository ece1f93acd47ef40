// Triangles in blocks laid out for SIMD, and the search for the nearest of them. Internal to SurfaceQuery.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <matstruct/types.h>

#include "query/box_tree.h"

namespace matstruct {

/// Up to kSize triangles, coordinate by coordinate, in the form of triangle_point.h: ab is the longest edge, h the
/// height on it, ac = k ab + h. Unused slots repeat the last triangle.
struct alignas(64) TriangleBlock {
  static constexpr int kSize = 4;
  using Lanes = std::array<double, kSize>;
  std::array<Lanes, 3> a, ab, h;
  Lanes k;
  Lanes inv_ab2, inv_ac2, inv_bc2, inv_h2;  ///< 1 / squared lengths; zero for a length of zero
  std::array<Index, kSize> id;

  void set(int slot, const std::array<Vec3, 3>& corners, Index triangle);
};

/// Triangle of least squared distance; `triangle` is kInvalid if none is within the bound.
struct NearestTriangle {
  double distance2 = std::numeric_limits<double>::infinity();
  Index triangle = kInvalid;
};

/// Walks the tree, whose leaf k is block k, near children first. Among triangles at equal computed distance the least
/// id wins, so that the answer depends neither on the order of the walk nor on the bound. `first`: block to look at
/// before all others, or kInvalid.
NearestTriangle nearest_triangle(const BoxTree& tree, const std::vector<TriangleBlock>& blocks, const Vec3& p,
                                 double bound2, Index first);

/// Appends every triangle within squared distance `bound2` of `p`, to rounding, in no particular order.
void triangles_within(const BoxTree& tree, const std::vector<TriangleBlock>& blocks, const Vec3& p, double bound2,
                      std::vector<Index>& triangles);

}  // namespace matstruct
