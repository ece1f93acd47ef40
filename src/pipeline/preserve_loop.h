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
  Index not_mended = 0;  ///< of these: connected, hence nothing that split_dual() could mend
  LineCheck lines;       ///< of the final diagram
  Index seam_gaps = 0;   ///< neighbours on seams whose cells do not meet
  /// The seams lie nearer to each other than their spheres: most neighbours on them do not meet, and spheres between
  /// them would only part others.
  bool seams_crowded = false;
  bool ran_away = false;  ///< violations multiplied: more spheres of any kind would only break more
};

/// What is wrong with a state of the spheres, worst first: lost lines and what cannot be mended; other violations; gaps
/// of seams, which cost structure and no guarantee.
using Defects = std::array<Index, 3>;
Defects defects_of(const PreserveResult& result);
/// Whether a state has more defects than another, gaps of seams apart, and up to `few` of those that can be split.
bool worse(const PreserveResult& a, const PreserveResult& b, Index few = 0);

/// `engine` holds the diagram of `spheres` on entry and on return. Ends when nothing is violated, after
/// options.max_rounds, when some rounds bring no better state, or when the spheres inserted outgrow the first ones;
/// then spheres and diagram are those of the best state, and what is left is in the result.
PreserveResult preserve(const Domain& domain, const Options& options, const SeamNetwork& network, FinderPool& finders,
                        Spheres& spheres, RpdEngine& engine, Context& context);

}  // namespace matstruct
