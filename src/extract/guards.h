// Removes the guards of concave lines (spheres/guards.h) from a dual complex without changing its homotopy type.
#pragma once

#include <vector>

#include <matstruct/types.h>

#include "extract/dual.h"
#include "model/spheres.h"

namespace matstruct {

struct GuardRemoval {
  DualComplex dual;  ///< without the guards that could go
  /// Guards that stay, since their links are not contractible. Their cells reach the surface at a second place, or meet
  /// the cells of other lines' guards across a wall.
  std::vector<Index> forced;
  /// Pairs (ascending) of forced guards whose cells meet, apart from neighbours on one line.
  std::vector<Edge> meeting;
};

/// Cuts the star of every guard out of the complex. That is a sequence of elementary collapses if the guard's link is
/// contractible, since the link lies in a 2-sphere (the dual complex is part of a triangulation of space), where
/// contractible complexes collapse to a point. Guards are taken as their links become contractible.
GuardRemoval remove_guards(const DualComplex& dual, const Spheres& spheres);

}  // namespace matstruct
