// The loop of the method: spheres on seams and junctions, preservation of topology and features, thinning, and spheres
// where the mesh cuts across a bend of the axis.
#pragma once

#include <vector>

#include <matstruct/compute.h>
#include <matstruct/context.h>
#include <matstruct/options.h>

#include "extract/thinning.h"
#include "pipeline/preserve_loop.h"
#include "pipeline/seam_stage.h"
#include "pipeline/stage_clock.h"
#include "rpd/rpd.h"

namespace matstruct {

struct StructureResult {
  ThinMesh thin;
  PreserveResult kept;                ///< of the last round
  std::vector<TangentSphere> medial;  ///< by sphere id, with contacts; then those of SplitDual::added
  SeamNetwork network;
  Index forced_guards = 0;  ///< helper spheres that could not be removed by collapses and stay
  bool organic = false;     ///< taken as an organic shape: no seams were placed
  Report::Particles particles;
  Index refined = 0;  ///< spheres inserted to follow the axis
};

/// `spheres` are the initial ones on entry; `engine` holds the diagram of the final ones on return.
StructureResult build_structure(const Domain& domain, const Options& options, Spheres& spheres, RpdEngine& engine,
                                FinderPool& finders, StageClock& clock, Context& context);

}  // namespace matstruct
