// Thinning of the dual complex to a medial mesh by elementary collapses, which keep its homotopy type.
//
// A simplex is free if exactly one simplex of the next dimension contains it; removing both is an elementary collapse.
// Since the dual complex is embedded in space, every set of tetrahedra has a free face: no tetrahedron remains.
#pragma once

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "extract/dual.h"
#include "model/spheres.h"
#include "prepare/domain.h"

namespace matstruct {

struct ThinningOptions {
  /// Free faces of less importance are removed. The importance of a face is the length of its restricted power edge
  /// over twice the mean radius of its corners, feature spheres not counted (MATTopo 2024); in [0, 1].
  double importance = 0.3;
};

/// `feature_edges`: ascending pairs of spheres along feature lines, sorted; they and their ends are never removed.
/// Vertex k of the result is sphere dual.vertices[k]. Tetrahedra go first, through the free face that lies farthest
/// from the medial axis (interpolated radius against distance to the surface); then free faces of little importance.
MedialMesh thin(const Domain& domain, const Spheres& spheres, const DualComplex& dual,
                const std::vector<Edge>& feature_edges, const ThinningOptions& options, const Context& context);

}  // namespace matstruct
