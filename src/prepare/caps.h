// Removal of triangles without area from a surface.
#pragma once

#include <matstruct/types.h>

namespace matstruct {

/// Removes triangles whose three distinct corners lie on one line, exactly or to within `height` (with a corner well
/// between the others), by splitting the triangle across their longest edge at the corner in between: the surface keeps
/// its points and its holes, if any. Returns the number removed. Triangles that use an edge which more than two share
/// are left alone.
Index remove_caps(TriSurface& surface, double height);

}  // namespace matstruct
