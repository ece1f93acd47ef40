// Proposals that repair violations of the nerve theorem: new medial spheres where a cell, facet or edge is not
// contractible.
#pragma once

#include <cstdint>
#include <vector>

#include <matstruct/context.h>

#include "model/spheres.h"
#include "preserve/edits.h"
#include "structure/contractibility.h"

namespace matstruct {

struct TopologyOptions {
  double spacing = 0;       ///< target distance of spheres, internal units
  double smooth_angle = 0;  ///< as in shrink_sphere(), radians
  std::uint64_t seed = 1;
};

/// For each violation: of the surface points in (or nearest to) the offending component, the one farthest in power
/// distance from the component's sphere becomes a pin, and the sphere shrunk from it is proposed; right across a narrow
/// gap the nearest one instead. In later rounds another point of the component is drawn at random (keyed by seed and
/// round), so that a region that resists is seeded from elsewhere. A component that is no more than its sphere's
/// contact point is repaired by removing a sphere instead.
Edits propose_for_topology(const Domain& domain, const RpdEngine& engine, const Spheres& spheres,
                           const std::vector<Violation>& violations, const TopologyOptions& options, int round,
                           const Context& context);

}  // namespace matstruct
