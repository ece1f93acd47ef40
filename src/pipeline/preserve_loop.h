// The loop that inserts spheres until the dual complex has the solid's topology and its sharp lines are kept.
#pragma once

#include <matstruct/context.h>
#include <matstruct/options.h>

#include "model/spheres.h"
#include "preserve/lines.h"
#include "preserve/seams.h"
#include "rpd/rpd.h"

namespace matstruct {

struct PreserveResult {
  Index rounds = 0;
  Index inserted = 0;
  Index violations_left = 0;
  LineCheck lines;      ///< of the final diagram
  Index seam_gaps = 0;  ///< neighbours on seams whose cells do not meet
};

/// `engine` holds the diagram of `spheres` on entry and on return. Ends when nothing is violated, after
/// options.max_rounds, when many rounds bring no better state, or when the spheres inserted outgrow the first ones;
/// then spheres and diagram are those of the best state, and what is left is in the result.
PreserveResult preserve(const Domain& domain, const Options& options, const SeamNetwork& network, FinderPool& finders,
                        Spheres& spheres, RpdEngine& engine, Context& context);

}  // namespace matstruct
