// Repair of tets that a mesher, which works in floating point, leaves flat or inverted.
#pragma once

#include <vector>

#include <matstruct/types.h>

#include "prepare/domain.h"

namespace matstruct {

/// Makes all tets strictly positive, in input coordinates and in all of `frames`, as prepare_domain() may see them, by
/// splitting inner edges of those that are not at new vertices beside the edge. Facets on the boundary stay. The tets
/// must be consistently oriented, that is, facets match with opposite orientation; Error if not. Returns false, with
/// the mesh in an undefined state, if a bad tet remains: usually one whose edges all lie on the boundary.
bool repair_slivers(TetMesh& solid, const std::vector<Frame>& frames);

}  // namespace matstruct
