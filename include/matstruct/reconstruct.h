// The solid that a medial mesh stands for, as a triangle mesh.
#pragma once

#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

namespace matstruct {

/// Components and genus of closed surfaces.
struct SurfaceTopology {
  Index components = 0;
  Index genus = 0;  ///< sum over the components
  friend constexpr bool operator==(const SurfaceTopology&, const SurfaceTopology&) = default;
};

struct Reconstruction {
  /// Closed, oriented outward, a 2-manifold without self-intersections: it has one patch in each tetrahedron of a
  /// conforming grid.
  TriSurface surface;
  SurfaceTopology topology;  ///< of `surface`
  SurfaceTopology expected;  ///< of the boundary of a solid that is homotopy equivalent to the medial mesh
  double to_envelope = 0;    ///< input units: greatest distance from the surface to the envelope
  double from_envelope = 0;  ///< input units: greatest distance from a sample of the envelope to the surface
  double tolerance = 0;      ///< input units: asked for
  double diagonal = 0;       ///< of the bounding box of the medial mesh's balls
  bool within_tolerance() const { return to_envelope <= tolerance && from_envelope <= tolerance; }
};

/// The surface of the union of a medial mesh's balls, cones and slabs: marching tetrahedra in a grid that is refined
/// until the surface is within `tolerance_percent` (in % of the diagonal, in [0.02, 10]) of the envelope; distances to
/// the envelope are exact, not those of a tessellation. The same input gives the same surface whatever the number of
/// threads. Throws Error if there are no spheres, if they have no extent, or if the tolerance is out of its range;
/// Cancelled if the context says so.
Reconstruction reconstruct(const MedialMesh& mesh, double tolerance_percent, Context& context);

/// Of a surface of which every edge has two triangles and every vertex one fan, as that of a reconstruction.
SurfaceTopology surface_topology(const TriSurface& surface);

}  // namespace matstruct
