// How far a repaired solid is from the surface it was made of.
#pragma once

#include <matstruct/solid.h>
#include <matstruct/types.h>

namespace matstruct {

/// The measures of Repair, without its steps: change of the enclosed volume (NaN if the input is open or encloses
/// none), greatest distance of the solid's boundary to the input, at vertices and centres of triangles, and the share,
/// by length, of the input's edges that turn by more than 30 degrees along which the solid has such an edge, too.
Repair measure_repair(const TriSurface& input, const TetMesh& solid);

}  // namespace matstruct
