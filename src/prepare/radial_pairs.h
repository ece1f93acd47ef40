// Neighbours of triangles across edges that more than two of them share.
#pragma once

#include <array>
#include <vector>

#include <matstruct/types.h>

#include "prepare/boundary.h"

namespace matstruct {

/// For an outward oriented surface that cuts itself nowhere: across each edge the triangle that bounds the same
/// material there, found by the exact order of the triangles around the edge. Throws SurfaceError if they do not run
/// along the edge up and down in turn, so that no material is between them.
std::vector<std::array<Index, 3>> pair_across_material(const TriSurface& surface, const VertexName& name);

}  // namespace matstruct
