// Preservation of the convex sharp lines: each shall be a chain of dual edges between its own feature spheres.
#pragma once

#include <vector>

#include "model/spheres.h"
#include "prepare/domain.h"
#include "preserve/edits.h"
#include "rpd/rpd.h"

namespace matstruct {

/// A line is preserved if its restricted power diagram holds only its own spheres (its corners included), and only
/// neighbours along the line meet on it. Decided on the exact names of the diagram.
struct LineCheck {
  Index lines = 0;  ///< convex feature lines
  Index preserved = 0;
  Edits edits;  ///< a sphere on every run of a line that a stranger holds; away with those of a line that it hides
  std::vector<Edge> feature_edges;  ///< consecutive spheres of all lines, ascending pairs, sorted
};

LineCheck check_lines(const Domain& domain, const Spheres& spheres, const Rpd& rpd);

}  // namespace matstruct
