// From any triangle surface to clean, oriented, nested shells in the internal frame: what a mesher needs.
#pragma once

#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "prepare/boundary.h"
#include "prepare/domain.h"

namespace matstruct {

/// One or more closed shells that bound solid material: outward normals look away from it. They may touch themselves
/// and each other in vertices, but not along edges.
struct ClosedSurface {
  Frame frame;
  TriSurface surface;               ///< internal frame, no equal and no unused vertices
  std::vector<Index> input_vertex;  ///< of each vertex its id in the input, the least one if several were welded
  std::vector<Index> triangle_shell;
  Index shells = 0;
  std::vector<std::vector<Index>> solids;  ///< shells of each connected solid: the outer one, then its cavities

  /// Names a vertex as in the input, with its coordinates there.
  VertexName name(const TriSurface& input) const;
};

/// Welds, drops degenerate and duplicate triangles, orients and nests. Throws Error for whatever tetrahedralise()
/// lists, except self-intersections, and with them the nesting means nothing: look for them first by passing `check`,
/// which is called with the oriented surface before nesting.
ClosedSurface close_surface(const TriSurface& input, Context& context,
                            const std::function<void(const ClosedSurface&)>& check);

}  // namespace matstruct
