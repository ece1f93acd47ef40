// From any triangle surface to clean, oriented, nested shells in the internal frame: what a mesher needs.
#pragma once

#include <vector>

#include <matstruct/context.h>
#include <matstruct/error.h>
#include <matstruct/types.h>

#include "prepare/boundary.h"
#include "prepare/domain.h"

namespace matstruct {

/// What keeps a surface from bounding a solid as it is.
enum class SurfaceDefect { kOpen, kCrowdedEdge, kOneSided, kSelfIntersection, kNotFilled };

/// A surface is refused for a defect that a repair may remove.
class SurfaceError : public Error {
 public:
  SurfaceError(SurfaceDefect what_is_wrong, const std::string& sentence) : Error(sentence), defect(what_is_wrong) {}
  SurfaceDefect defect;
};

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

/// Throws Error if an index is out of range, a used coordinate is not finite, or there are no triangles.
void check_elements(const TriSurface& input);

/// The input with equal vertices made one, and those of open borders that lie within tolerance::kWeld of each other;
/// without triangles that name a vertex twice and without unused vertices.
TriSurface weld_surface(const TriSurface& input);

/// Welds, drops degenerate and duplicate triangles, orients and nests. Throws Error for whatever tetrahedralise()
/// lists, SurfaceError for the defects above, except self-intersections; with them the nesting means nothing: look for
/// them first by passing `check`, which is called with the oriented surface before nesting.
ClosedSurface close_surface(const TriSurface& input, Context& context,
                            const std::function<void(const ClosedSurface&)>& check);

/// The same for a surface whose orientation is right and which cuts itself nowhere, but may have edges of four and more
/// triangles: there those are neighbours that have the same material between them.
ClosedSurface close_resolved_surface(const TriSurface& input, Context& context);

}  // namespace matstruct
