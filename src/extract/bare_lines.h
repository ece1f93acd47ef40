// Sharp lines without a sheet.
#pragma once

#include <vector>

#include <matstruct/types.h>

#include "spheres/finder_pool.h"
#include "spheres/tangency.h"

namespace matstruct {

/// Every convex sharp line ends a sheet. Between lines shorter than the spacing of the spheres there may be none of it,
/// so that edges of a line have no face, or have one by chance. To each stretch of such edges that is no longer than
/// `longest` (internal units): a sphere of the sheet beside its middle, tangent to both sides of the line, and faces
/// from there to the edges. The reverse of collapses, which keeps the homotopy type. Stretches without such a sphere
/// stay bare. New vertices come last; their spheres are appended to `medial`, and the ids to `spheres`, which are those
/// of the vertices. Returns the number of stretches covered.
Index cover_bare_lines(FinderPool& finders, double longest, std::vector<TangentSphere>& medial,
                       std::vector<Index>& spheres, MedialMesh& mesh);

}  // namespace matstruct
