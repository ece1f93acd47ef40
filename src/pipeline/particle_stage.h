// Rounds that spread all spheres evenly over the medial axis as particles (paper section 8).
//
// A round finds the contacts of the cells from volume samples and from them how every sphere may move, minimises the
// energy of the particles, and puts the spheres back on the axis. Topology and features are preserved again after it.
#pragma once

#include <matstruct/compute.h>
#include <matstruct/context.h>
#include <matstruct/options.h>

#include "pipeline/preserve_loop.h"
#include "pipeline/stage_clock.h"
#include "rpd/rpd.h"
#include "spheres/seams.h"

namespace matstruct {

/// Up to options.particle_rounds rounds. On entry `engine` holds the diagram of `spheres`, whose preservation ended as
/// in `kept`; so they do on return. A round after which more is violated than before is undone and is the last.
/// Spheres on convex sharp lines slide along their line, those on curves of `network` along their seam, where they stay
/// tangent to all its contacts; corners, junctions and guards stay; the others move on their sheets and end as empty
/// balls that touch the surface. `mechanical`: these become tangent to two contacts where they nearly are, and none
/// comes to crowd a seam. A sphere for which no place on the axis is found stays where it was.
Report::Particles spread_particles(const Domain& domain, const Options& options, const SeamNetwork& network,
                                   bool mechanical, FinderPool& finders, Spheres& spheres, RpdEngine& engine,
                                   PreserveResult& kept, StageClock& clock, Context& context);

}  // namespace matstruct
