// Puts spheres on the seams and junctions of the medial axis and makes room for them.
#pragma once

#include <vector>

#include <matstruct/context.h>
#include <matstruct/options.h>

#include "rpd/rpd.h"
#include "spheres/seams.h"
#include "spheres/sheets.h"

namespace matstruct {

struct SeamStage {
  SeamNetwork network;
  std::vector<TangentSphere> medial;  ///< by sphere id, with contacts; guards without
};

/// `spheres` gains the spheres of all seams found, from the corners and from pairs of spheres whose cells meet though
/// no sheet joins them, and loses sheet spheres that crowd a seam. Sheet spheres become tangent to two contacts.
/// `engine` holds the diagram of the result.
SeamStage place_seams(const Domain& domain, const Options& options, Spheres& spheres, RpdEngine& engine,
                      FinderPool& finders, Context& context);

/// Sheet spheres, by id, too near to seams of theirs, of the network's curves from `first_curve` on: they would part
/// the cells of the seam's spheres. `medial`: by sphere id, with contacts; `spacing` in internal units.
std::vector<Index> crowding_seams(FinderPool& finders, const Spheres& spheres, const std::vector<TangentSphere>& medial,
                                  const SeamNetwork& network, std::size_t first_curve, double spacing);

/// Sheet spheres, by id, that only bumps lower than `height` (internal units) have put there: a larger ball, grown by
/// that, holds theirs, and their cells meet. A ball that is held so itself does not count. Spheres on medial curves
/// stay.
std::vector<Index> spheres_of_bumps(const Spheres& spheres, const std::vector<TangentSphere>& medial,
                                    const Rpd& diagram, double height);

/// Takes them out of `spheres` and of the diagram that `engine` holds.
void drop_bumps(double height, const std::vector<TangentSphere>& medial, Spheres& spheres, RpdEngine& engine,
                Context& context);

/// Pairs of spheres (ascending, sorted) whose cells meet, guards left out.
std::vector<Edge> meeting_pairs(const Spheres& spheres, const Rpd& rpd);

}  // namespace matstruct
