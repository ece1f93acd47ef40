// Cutting a solid apart where it touches itself in a vertex or along an edge.
#pragma once

#include "prepare/boundary.h"
#include "prepare/clean_solid.h"

namespace matstruct {

/// What cut_pinches() did.
struct PinchCut {
  Index copies = 0;          ///< vertices added as copies of others
  Index middles = 0;         ///< vertices added on edges
  Index example = kInvalid;  ///< a vertex that has copies now
};

/// Cuts a solid apart where tets meet in a vertex or an edge without being connected around it through facets. What
/// remains connected is what the interior of the solid connects. After it the tets at each vertex, and those at each
/// edge, form one fan. `boundary` is that of `clean.mesh` before and after. Tets keep their order; halves of split ones
/// come last. The boundary can still be pinched in a vertex: if two voids touch there, the tets around form one fan.
PinchCut cut_pinches(CleanSolid& clean, Boundary& boundary, const VertexName& name);

}  // namespace matstruct
