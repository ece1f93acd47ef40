// Erosion of a thin mesh from its borders: what a bump of the surface alone has put there burns away.
//
// Erosion thickness ("Erosion Thickness on Medial Axes of 3D Shapes", Yan, Sykes, Chambers, Letscher & Ju 2016): a fire
// starts at the borders, at each sphere after a time equal to its radius, and moves at unit speed; what it reaches at
// time t within a ball of radius r stands for a bump of height t - r.
#pragma once

#include <vector>

#include <matstruct/types.h>

#include "extract/thinning.h"

namespace matstruct {

struct ErosionOptions {
  double height = 0;  ///< of bumps, internal units: what stands for lower ones burns
  double cover = 0;   ///< internal units: ends of curves also go if they stick out of the rest by no more
};

/// Removes faces and loose edges by elementary collapses, which keep the homotopy type, in the order in which the fire
/// reaches them. At a seam the fire waits until it has come in all sheets but one. `fixed_edges`: pairs of spheres,
/// sorted; they and their ends stay.
ThinMesh eroded(const ThinMesh& thin, const std::vector<Edge>& fixed_edges, const ErosionOptions& options);

}  // namespace matstruct
