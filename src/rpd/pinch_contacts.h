// Names of a restricted power diagram on the edges and vertices where the solid touches itself.
#pragma once

#include <vector>

#include "prepare/domain.h"
#include "rpd/rpd.h"

namespace matstruct {

/// A cell or facet of the diagram (`spheres`, ascending, the second kInvalid for a cell) that holds a vertex
/// (`simplex`, the second kInvalid) or meets an edge between two points, seen from one of the tets there. Elsewhere
/// tets around an edge or vertex are connected through facets; here these names are all that connects them.
struct PinchContact {
  Edge simplex{};
  Edge spheres{};
  Index tet = kInvalid;
  friend auto operator<=>(const PinchContact&, const PinchContact&) = default;
};

/// Sorted. Empty, at no cost worth mention, for a solid that does not touch itself.
std::vector<PinchContact> pinch_contacts(const Domain& domain, const RpdEngine& engine);

}  // namespace matstruct
