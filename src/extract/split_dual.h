// The dual complex of a restricted power diagram whose cells, facets and edges need not be connected.
//
// The nerve theorem asks for contractible sets. Where the diagram has sets of several components, their components do
// as well: they are the pieces of a finer decomposition, and its dual, with one simplex per component, is homotopy
// equivalent to the solid if every component is contractible. Two such simplices may have the same corners; all but one
// are then subdivided, by a vertex in the middle that is joined to their boundary.
#pragma once

#include <vector>

#include "extract/dual.h"
#include "model/spheres.h"
#include "rpd/rpd.h"
#include "structure/contractibility.h"

namespace matstruct {

struct SplitDual {
  DualComplex dual;  ///< of the spheres' ids and, from #spheres on, those of `added`
  /// Vertices for components and for middles: balls about a point of the component, as large as the surface allows.
  /// Those of further components of a guard's cell are guards.
  std::vector<SphereSeed> added;
};

/// The component of a cell that keeps its sphere's id is the one on the sphere's sharp line if it is a feature sphere,
/// else the greatest; likewise for the facets of neighbours on a line. Where everything is connected this is
/// dual_complex() and adds nothing.
SplitDual split_dual(const Domain& domain, const RpdEngine& engine, const Spheres& spheres,
                     const std::vector<PinchContact>& contacts = {});

}  // namespace matstruct
