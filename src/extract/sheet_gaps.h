// Gaps that thinning has left in sheets.
#pragma once

#include <vector>

#include <matstruct/types.h>

#include "spheres/finder_pool.h"
#include "spheres/sheets.h"

namespace matstruct {

/// Where a sheet fades out, because its two contacts draw together, thinning may take a face between two others at a
/// sphere of a seam: the sheet then has two ends there, and the sphere looks like a junction. Or it takes several along
/// a seam, which then stops an edge or two before the sheet's next end; or all faces at an edge, as of a sharp line,
/// and leaves it bare, or hanging in two fans on one sphere of the line; or those in a notch of a free border. Puts a
/// face there, with a new edge, if its three spheres lie in one sheet, not all on sharp lines, and the ball in the
/// middle holds the surface no deeper than `deviation` (internal units); at a bare edge of a line it is enough that the
/// ball's radius is the distance to the surface to within that. It is the reverse of an elementary collapse, which
/// keeps the homotopy type. Goes on until there is no such gap. `spheres` by vertex: ids in `medial`. Returns the
/// number of new faces.
Index fill_sheet_gaps(FinderPool& finders, const std::vector<TangentSphere>& medial, const std::vector<Index>& spheres,
                      double deviation, MedialMesh& mesh);

}  // namespace matstruct
