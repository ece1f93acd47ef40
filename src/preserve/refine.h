// Proposals that bring the medial mesh nearer to the axis: spheres in the middle of edges and faces that cut across a
// bend of their sheet.
#pragma once

#include <vector>

#include <matstruct/context.h>

#include "extract/thinning.h"
#include "preserve/edits.h"
#include "spheres/finder_pool.h"
#include "spheres/pins.h"
#include "spheres/seams.h"

namespace matstruct {

struct RefineOptions {
  double deviation = 0;  ///< between the envelope and the surface, internal units: what is allowed
  double spacing = 0;    ///< new spheres keep a share of this from each other; internal units
  /// Surface points that stand out by no more than the facets there are covered, too: on the curved walls of mechanical
  /// parts, where `deviation` does not allow for the facets' height.
  bool spare_facets = false;
};

/// For every edge and face of the mesh: the ball of its sheet next to its middle, if the slab's own ball there misses
/// the contacts of that ball, or holds a part of the surface, by more than the allowed deviation. Worst first.
/// `medial`: spheres by id, with contacts. Spheres on a seam of the network know their place on it.
Edits propose_refinement(FinderPool& finders, const ThinMesh& thin, const std::vector<TangentSphere>& medial,
                         const SeamNetwork& network, const RefineOptions& options, const Context& context);

/// For every edge of the mesh on a seam at which one of the seam's sheets has no face: a ball of that sheet beside the
/// middle of the edge, if it sticks out of the ball of the seam there by most of the allowed deviation. Worst first.
Edits propose_missing_sheets(FinderPool& finders, const ThinMesh& thin, const std::vector<TangentSphere>& medial,
                             double smooth_angle, const RefineOptions& options, const Context& context);

/// For surface points that the envelope of the mesh misses by more than the allowed deviation: the medial sphere that
/// touches there. Worst first. `pins`: a sample of the surface; `smooth_angle` as in shrink_sphere().
Edits propose_coverage(const Domain& domain, const MedialMesh& mesh, const std::vector<Pin>& pins, double smooth_angle,
                       const RefineOptions& options, const Context& context);

}  // namespace matstruct
