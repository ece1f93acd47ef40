// Edges of feature lines that turn by a little less than the limit of the angle.
#pragma once

#include <vector>

#include <matstruct/types.h>

#include "prepare/domain.h"

namespace matstruct {

/// Marks in `sharp` (one flag per edge) what closes gaps of lines: from a vertex where one sharp edge ends, edges of
/// its kind that are not sharp are followed, each time the straightest within tolerance::kCornerTurn, until a vertex of
/// one that turns by more than `strong` (radians) is reached. Only lines of `shortest` or more are continued, and by no
/// more than twice their length. All ways are found before any is marked, so the order of vertices does not matter.
/// `edges` are sharp or nearly.
void close_line_gaps(const TriSurface& surface, const std::vector<SharpEdge>& edges, double shortest, double strong,
                     std::vector<char>& sharp);

}  // namespace matstruct
