// The axis of a solid, by sphere shrinking or by contacts.
#pragma once

#include <vector>

#include "extract/remesh.h"
#include "prepare/domain.h"
#include "spheres/sheets.h"

namespace matstruct {

/// Sheets: the sphere shrunk from the surface point nearest to the guess. No curves. `smooth_angle`: shrink_sphere().
/// Refers to `domain`, which must outlive it.
AxisOracle shrinking_oracle(const Domain& domain, double smooth_angle);

/// Sheets and seams by their contacts: the empty ball that is tangent to two contacts of the nearby vertex, or to all
/// that two vertices of a seam share. `spheres`: by vertex of the input mesh. Refers to both arguments.
AxisOracle contact_oracle(FinderPool& finders, const std::vector<TangentSphere>& spheres, double target);

}  // namespace matstruct
