// The contacts of the spheres of a finished mesh, found anew whatever way the spheres came about, and what they say of
// its structure.
#pragma once

#include <matstruct/compute.h>
#include <matstruct/context.h>

#include "spheres/finder_pool.h"

namespace matstruct {

/// Of every vertex; `mesh` and the points in internal units. In parallel, a range query and a few walks over the
/// surface per vertex.
VertexContacts vertex_contacts(FinderPool& finders, const MedialMesh& mesh, const Context& context);

/// The types of `mesh` agree with the structure; `surface` is that of the solid and `diagonal` its box's. One unit for
/// all.
Report::Strata strata_facts(const SurfaceQuery& surface, double diagonal, const MedialMesh& mesh,
                            const Structure& structure, const VertexContacts& contacts);

}  // namespace matstruct
