// From spheres of the rounded solid to those of the solid as it came.
#pragma once

#include <matstruct/context.h>
#include <matstruct/structure.h>
#include <matstruct/types.h>

#include "prepare/domain.h"

namespace matstruct {

/// Moves every sphere, and its contacts with it, by what rounding has moved the surface at its contacts: the least
/// change of centre and radius that makes it tangent, to first order, which leaves an error of the square of
/// tolerance::kGrid; those that this would leave less tangent stay. A sphere of radius 0 stays at its place of the
/// surface, so that corners are the vertices of the input. Internal units; `surface` is that of Domain::unrounded.
void unround(const Domain& domain, const SurfaceQuery& surface, const Context& context, VertexContacts& contacts,
             MedialMesh& mesh);

}  // namespace matstruct
