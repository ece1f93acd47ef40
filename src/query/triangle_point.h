// The point of one triangle nearest to a given point, with the feature (vertex, edge, face) that holds it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <matstruct/types.h>

namespace matstruct {

/// Nearest point of a segment as its parameter in [0, 1]; 0 for a segment of length zero.
inline double nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = norm2(ab);
  return length2 > 0 ? std::clamp(dot(p - a, ab) / length2, 0.0, 1.0) : 0;
}

/// What of a triangle holds a point: one of its vertices, the inside of an edge (opposite a vertex), or its inside.
enum class TriangleFeature { kVertex, kEdge, kFace };

struct TrianglePoint {
  double distance2 = std::numeric_limits<double>::infinity();
  Vec3 point;
  TriangleFeature feature = TriangleFeature::kFace;
  int local = 0;  ///< the vertex, or the vertex opposite the edge
};

/// A triangle written over its longest edge ab: its third corner is c = a + k ab + h, where the height h is
/// perpendicular to ab. A point of the plane is a + s ab + w h, and s and w are found one without the other: the errors
/// of a needle's height stay within the needle.
struct TriangleFrame {
  Vec3 a, ab, h;
  double k = 0;

  explicit TriangleFrame(const std::array<Vec3, 3>& corners) {
    std::size_t start = 0;
    double longest = -1;
    for (std::size_t i = 0; i < 3; ++i) {
      const double length2 = distance2(corners[i], corners[(i + 1) % 3]);
      if (length2 > longest) longest = length2, start = i;
    }
    a = corners[start];
    ab = corners[(start + 1) % 3] - a;
    h = corners[(start + 2) % 3] - a;
    for (int pass = 0; pass < 2 && longest > 0; ++pass) {  // Gram-Schmidt, twice is enough
      const double along = dot(h, ab) / longest;
      k += along;
      h -= ab * along;
    }
  }
};

/// Nearest point of triangle `corners` of which `ids` are the vertex ids. Every candidate is a point of the triangle,
/// so the result is right to rounding for needles and caps, and for triangles without area. Two triangles that share an
/// edge or a vertex compute the same bits when it is nearest.
inline TrianglePoint nearest_on_triangle(const Vec3& p, const std::array<Vec3, 3>& corners, const Triangle& ids) {
  TrianglePoint best;
  const auto offer = [&](const Vec3& q, TriangleFeature feature, int local) {
    const double d2 = distance2(p, q);
    if (d2 < best.distance2) best = {d2, q, feature, local};
  };
  for (int k = 0; k < 3; ++k) offer(corners[static_cast<std::size_t>(k)], TriangleFeature::kVertex, k);
  for (int k = 0; k < 3; ++k) {
    auto i = static_cast<std::size_t>((k + 1) % 3), j = static_cast<std::size_t>((k + 2) % 3);
    if (ids[j] < ids[i]) std::swap(i, j);
    const double t = nearest_on_segment(p, corners[i], corners[j]);
    if (t > 0 && t < 1) offer(lerp(corners[i], corners[j], t), TriangleFeature::kEdge, k);
  }
  const TriangleFrame frame(corners);
  if (norm2(frame.h) > 0) {
    const Vec3 ap = p - frame.a;
    const double s = dot(ap, frame.ab) / norm2(frame.ab), w = dot(ap, frame.h) / norm2(frame.h), v = s - w * frame.k;
    if (v > 0 && w > 0 && v + w < 1) offer(frame.a + frame.ab * s + frame.h * w, TriangleFeature::kFace, 0);
  }
  return best;
}

}  // namespace matstruct
