// The ids that strata have in files of other formats.
#pragma once

#include <vector>

#include <matstruct/strata.h>

namespace matstruct {

/// Where the ids of each kind begin; sheets begin at 0.
struct StratumIds {
  Index seams, boundaries, curves, junctions;
  explicit StratumIds(const Strata& strata);
};

/// #V, -1 for a vertex that is on none; io.h says which.
std::vector<Index> stratum_of_vertices(const MedialMesh& mesh, const Strata& strata);

}  // namespace matstruct
