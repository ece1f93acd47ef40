// Exact test for triangles of one surface that cut each other.
#pragma once

#include <array>
#include <optional>

#include <matstruct/types.h>

namespace matstruct {

/// The number of pairs of triangles that meet elsewhere than in a shared vertex or edge, and the least pair.
struct SelfIntersection {
  Index pairs = 0;
  std::array<Index, 2> triangles{};
};

/// Looks for self-intersections of a closed, oriented surface whose edges have two triangles each; none if empty. To
/// touch itself in a common vertex is not one. O(n log n) in practice.
std::optional<SelfIntersection> find_self_intersection(const TriSurface& surface);

}  // namespace matstruct
