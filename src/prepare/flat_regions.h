// A triangulation of a surface that depends on its shape alone where it is flat.
//
// How a flat face was cut into triangles says nothing about the solid, but every later stage would hear of it: its
// vertices move samples, and with them the spheres. It also makes tets that nothing needs.
#pragma once

#include <optional>
#include <vector>

#include <matstruct/types.h>

namespace matstruct {

struct FlatRegions {
  std::vector<Index> vertices;         ///< of the input that are left, in the order of their coordinates
  std::vector<Triangle> triangles;     ///< into `vertices`, each with its least vertex first, ascending
  std::vector<Index> input_triangles;  ///< per triangle the least one of the input in its flat region
};

/// Flat regions (within tolerance::kFlat) of a closed, oriented surface are triangulated anew: constrained Delaunay,
/// over the vertices that the shape needs. Vertices inside a region and on straight borders of regions are left out.
/// `exact` has the coordinates that decide what is flat and straight; those of `surface` may be rounded, and decide the
/// triangles. Edges in `kept` (ascending pairs of vertices, sorted) and their ends stay. The surface that results is
/// that of the input within the tolerance, has the same topology and touches itself where that does. Nothing if
/// rounding would turn a triangle over. The same for every triangulation of the regions. O(n log n).
std::optional<FlatRegions> merge_flat_regions(const TriSurface& surface, const std::vector<Vec3>& exact,
                                              const std::vector<Edge>& kept);

}  // namespace matstruct
