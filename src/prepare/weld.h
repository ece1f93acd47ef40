// Identification of equal points.
#pragma once

#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// For each point the least id of a point with equal coordinates. O(n log n).
std::vector<Index> weld_equal(const std::vector<Vec3>& points);

}  // namespace matstruct
