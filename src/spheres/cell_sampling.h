// Further volume samples inside power cells that hold too few.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <matstruct/context.h>

#include "prepare/domain.h"
#include "spheres/power_owners.h"
#include "spheres/volume_samples.h"

namespace matstruct {

struct CellSamplingOptions {
  Index least = 48;  ///< cells with fewer samples get so many more
  std::uint64_t seed = 1;
};

/// Spreads further samples over every poor cell among those `wanted` (#spheres). The new samples are as good as the
/// others for the rest of a computation, once link_samples() has linked them all anew. `owners`, as set by
/// update_owners(), is extended by theirs. Returns how many were added. A cell in which no first point is found gets
/// none. Cost: some three surface queries per new sample, and 200 per cell.
Index add_cell_samples(const Domain& domain, std::span<const WeightedPoint> spheres, const SphereNeighbors& neighbors,
                       const std::vector<bool>& wanted, const CellSamplingOptions& options, const Context& context,
                       VolumeSamples& samples, std::vector<Index>& owners);

}  // namespace matstruct
