// Gaps in sheets beside their seams.
#pragma once

#include <vector>

#include <matstruct/types.h>

#include "spheres/finder_pool.h"
#include "spheres/sheets.h"

namespace matstruct {

/// Where a sheet fades out beside a seam, because its two contacts draw together, thinning may take a face between two
/// others at a sphere of the seam: the sheet then has two ends there, and the sphere looks like a junction. Puts a face
/// between those ends, with a new edge, if the three spheres lie in one sheet: the reverse of an elementary collapse,
/// which keeps the homotopy type. `spheres` by vertex: ids in `medial`. Returns the number of new faces.
Index fill_seam_gaps(FinderPool& finders, const std::vector<TangentSphere>& medial, const std::vector<Index>& spheres,
                     MedialMesh& mesh);

}  // namespace matstruct
