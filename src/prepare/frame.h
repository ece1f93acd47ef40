// The internal frame of a solid: one that turns, moves and grows with it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// Internal coordinates of points.
enum class Coordinates : std::uint8_t {
  kExact,   ///< the diagonal in (0.5, 1], the scale a power of two: scaling is exact, and turning by right angles too
  kRounded  ///< the diagonal 1, coordinates multiples of tolerance::kGrid: the same bits for a solid that was turned,
            ///< moved or scaled, of which rounding has left something else than the image
};

/// Similarity between input units and the internal frame (centred at the origin).
struct Frame {
  Vec3 offset;                                                        ///< input units
  double scale = 1;                                                   ///< internal units per input unit
  std::array<Vec3, 3> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, {0, 0, 1}};  ///< of the frame, orthonormal, right-handed
  double grid = 0;  ///< internal coordinates are rounded to multiples of it; 0: they are not

  Vec3 to_internal(const Vec3& p) const {
    const Vec3 q = unrounded(p);
    return grid > 0 ? Vec3{on_grid(q.x), on_grid(q.y), on_grid(q.z)} : q;
  }
  Vec3 unrounded(const Vec3& p) const { return turned(p - offset) * scale; }
  Vec3 to_input(const Vec3& p) const { return turned_back(p / scale) + offset; }
  /// Directions into the frame and out of it.
  Vec3 turned(const Vec3& v) const { return {dot(axes[0], v), dot(axes[1], v), dot(axes[2], v)}; }
  Vec3 turned_back(const Vec3& v) const { return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z; }

 private:
  double on_grid(double x) const { return std::nearbyint(x / grid) * grid; }
};

/// The frame of a surface. Its axes follow the surface: the direction in which most area faces (of planes, within
/// tolerance::kParallel), the same among those at right angles to it, and their product; which is x, y, z and which
/// way they point is told by moments of the area, and by the order of the vertices where the surface is symmetric. So
/// the bounding box, and with it every length that is relative to its diagonal, does not depend on how the solid lies
/// in its file, and the results for a moved solid are the moved results but for rounding. Where less than
/// tolerance::kPlanarShare of the area is planar, the axes are the file's.
/// Orientation and order of the triangles do not matter, to the last bit. Unused points are ignored.
/// Rounded coordinates are exact all the same where rounding would make two points one, or a triangle is lower than
/// tolerance::kGridHeights; triangles name each vertex once.
/// Throws Error if the points coincide or their extent is beyond the range of doubles.
Frame fit_frame(const std::vector<Vec3>& points, std::vector<Triangle> triangles, Coordinates coordinates);

}  // namespace matstruct
