// The smooth patches of a surface, and which points of it are joined within a ball.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// Triangles joined over edges that are not convex-sharp. Concave edges join: a sheet of the medial axis runs on
/// smoothly where its contact turns from a face to a concave edge.
class SurfacePatches {
 public:
  /// `convex_angle` in degrees: a convex edge at which the faces turn by more is sharp, see query/face_angle.h.
  /// Vertices at the same place are one; edges of one or of more than two triangles join nothing. Cost O(n log n).
  SurfacePatches(const TriSurface& surface, double convex_angle);

  /// Welded, and oriented outward if it was inward throughout. Triangles are the input's.
  const TriSurface& surface() const { return surface_; }
  /// Of each triangle the one joined to it over the edge opposite local vertex k, or kInvalid.
  const std::array<Index, 3>& neighbours(Index triangle) const {
    return neighbours_[static_cast<std::size_t>(triangle)];
  }

 private:
  TriSurface surface_;
  std::vector<std::array<Index, 3>> neighbours_;
};

/// Walks over the part of a surface in a ball. The part of a triangle in it is convex, so two triangles are joined in
/// the ball where their common edge meets it. Holds scratch memory: one for each thread.
class PatchWalk {
 public:
  explicit PatchWalk(const SurfacePatches& patches);

  /// Whether two triangles are joined within the ball. Cost: the triangles of a's patch in the ball, at most.
  bool joined(const Vec3& center, double radius, Index a, Index b);
  /// The number of pieces of the patches in the ball that hold the triangles, which may be repeated.
  Index pieces(const Vec3& center, double radius, std::span<const Index> triangles);

 private:
  bool flood(const Vec3& center, double radius, Index from, Index until);

  const SurfacePatches& patches_;
  std::vector<Index> seen_;  // of each triangle the number of the last walk that reached it
  Index walk_ = 0;
  std::vector<Index> stack_;
};

}  // namespace matstruct
