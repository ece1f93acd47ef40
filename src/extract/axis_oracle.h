// The axis of a solid, by sphere shrinking.
#pragma once

#include "extract/remesh.h"
#include "prepare/domain.h"

namespace matstruct {

/// Sheets: the sphere shrunk from the surface point nearest to the guess. No curves. `smooth_angle`: shrink_sphere().
/// Refers to `domain`, which must outlive it.
AxisOracle shrinking_oracle(const Domain& domain, double smooth_angle);

}  // namespace matstruct
