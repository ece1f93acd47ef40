// Orientation of surfaces that are not closed 2-manifolds.
#pragma once

#include <matstruct/types.h>

namespace matstruct {

/// Turns triangles so that winding numbers mean something. Sets of triangles connected across edges of exactly two are
/// left as they are if they run alike, since inner shells may be meant as cavities; else they are made to, and turned
/// outward by their volume. One-sided sets stay as they are. If all together have a negative volume, all are turned.
TriSurface orient_soup(TriSurface surface);

/// Volume enclosed by an oriented surface: of open ones that of the cones from the origin.
double signed_volume(const TriSurface& surface);

}  // namespace matstruct
