// Bounding boxes of points.
#pragma once

#include <vector>

#include <matstruct/vec3.h>

namespace matstruct {

/// Of the axis-parallel bounding box; there must be a point.
inline double box_diagonal(const std::vector<Vec3>& points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) {
    low = min(low, p);
    high = max(high, p);
  }
  return norm(high - low);
}

}  // namespace matstruct
