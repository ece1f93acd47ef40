// Leaving vertices out of a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// Removes the vertices that are not kept, of which no simplex is left, and numbers the others anew in their order.
/// `kept`: 1 for each vertex that stays. Returns those, ascending.
std::vector<Index> compact(MedialMesh& mesh, const std::vector<std::uint8_t>& kept);

}  // namespace matstruct
