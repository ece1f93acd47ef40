// Closest points on a fixed triangle surface, by an 8-wide bounding volume hierarchy in double precision.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// Closest point of a surface.
struct SurfaceHit {
  double distance2 = std::numeric_limits<double>::infinity();
  Vec3 point;
  Index triangle = kInvalid;  ///< kInvalid if nothing lies within the bound
};

/// Immutable after construction; all members may be called from several threads at once.
class SurfaceQuery {
 public:
  /// Cost O(n log n). Triangles of zero area are allowed. Copies what it needs of the surface.
  explicit SurfaceQuery(const TriSurface& surface);
  ~SurfaceQuery();
  SurfaceQuery(SurfaceQuery&&) noexcept;
  SurfaceQuery& operator=(SurfaceQuery&&) noexcept;

  /// Closest point to `p` within squared distance `bound2`; the hit's triangle is kInvalid if there is none; ties go to
  /// the least triangle id. O(log n) in practice.
  SurfaceHit closest(const Vec3& p, double bound2 = std::numeric_limits<double>::infinity()) const;
  /// The same answer without bound, found faster if `triangle_guess` is near the closest point, as the triangle of a
  /// nearby query is. Any guess is allowed; one that is no triangle is ignored.
  SurfaceHit closest_near(const Vec3& p, Index triangle_guess) const;
  /// The closest point of one triangle, which must exist.
  SurfaceHit closest_on(Index triangle, const Vec3& p) const;
  /// Every triangle within `reach` of `p`, to rounding, ascending, into `triangles`, which is cleared first. O(log n)
  /// plus the number of triangles, in practice.
  void within(const Vec3& p, double reach, std::vector<Index>& triangles) const;
  /// True if `p` is inside the closed, outward oriented surface (sign of the angle-weighted pseudonormal at the closest
  /// point, Baerentzen & Aanaes 2005). Undefined for open surfaces.
  bool inside(const Vec3& p) const;
  /// Distance to the surface, negative inside. Same requirement as inside(). A guess helps as in closest_near().
  double signed_distance(const Vec3& p, Index triangle_guess = kInvalid) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace matstruct
