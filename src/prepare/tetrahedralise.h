// From a closed triangle surface to a tetrahedral mesh that keeps the surface's triangles exactly.
#pragma once

#include <optional>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/solid.h>
#include <matstruct/types.h>

namespace matstruct {

struct FillOptions {
  double tet_size = 0;    ///< greatest length of edges inside, in diagonals; 0 = none
  double seconds = 100;   ///< that Gmsh may take
  bool resolved = false;  ///< the surface is oriented and cuts itself nowhere, see close_resolved_surface()
  /// Flat regions are triangulated anew if they can be, see merge_flat_regions(): the shape stays, not each triangle.
  bool merge_flat = false;
  bool quick = false;  ///< ways that seldom help where the first have failed are not tried
  const std::vector<SharpSegment>* sharp = nullptr;  ///< known sharp edges, which stay; nullptr: none are
};

/// Tetrahedralises the solid bounded by a closed surface; the surface may have several shells: nested shells bound
/// cavities and bodies inside cavities, disjoint ones are separate components. Steps: weld vertices (exactly equal ones
/// first, then within tolerance::kWeld if the surface is open without), drop degenerate and duplicate triangles, orient
/// outward, sort shells by nesting, tetrahedralise with Gmsh (HXT, then Delaunay), in a child process where a crash of
/// the library cannot hurt the caller. The input's triangles are facets of the result, as coarse inside as they allow,
/// unless flat regions are to be merged.
/// The surface may touch itself in vertices; so does the result then, and prepare_domain() cuts it apart. Throws Error:
/// empty surface, NaN, open surface (with the number and a place of its border edges), edges shared by more than two
/// triangles, self-intersection (with a pair of triangles and coordinates), mesher failure; of these SurfaceError
/// (closed_surface.h) for what a repair may cure.
TetMesh tetrahedralise(const TriSurface& surface, Context& context, const FillOptions& options = {});

/// Other tets of the same solid, over its boundary with merged flat regions. Nothing if the solid touches itself, has
/// faults, or Gmsh does not fill it: the tets that are there must do then, or be refused by prepare_domain().
std::optional<TetMesh> refill_merged(const TetMesh& solid, Context& context, const FillOptions& options = {});

}  // namespace matstruct
