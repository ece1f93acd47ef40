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
  SurfaceTopology topology;    ///< of `surface`
  SurfaceTopology expected;    ///< of the boundary of a solid that is homotopy equivalent to the medial mesh
  double to_envelope = 0;      ///< input units: greatest distance of a vertex or centroid from the envelope
  double from_envelope = 0;    ///< input units: greatest distance of a sample of the envelope from `surface`, without
                               ///< the hidden ones
  double hidden_share = 0;     ///< of the envelope's area, in [0, 1]: in cracks and bubbles that are closed
  double deepest_filling = 0;  ///< input units: distance from the union of the deepest place in a bubble or tunnel that
                               ///< was filled for the sake of the topology; 0 if none was
  double tolerance = 0;        ///< input units: asked for
  double diagonal = 0;         ///< of the bounding box of the medial mesh's balls
  bool within_tolerance() const { return to_envelope <= tolerance && from_envelope <= tolerance; }
};

/// The surface of the union of a medial mesh's balls, cones and slabs, up to a tolerance in % of the diagonal, in
/// [0.02, 10]. The union of a coarse medial mesh has cracks, and where they meet tunnels and bubbles, which the solid
/// does not have. Cracks too narrow for a ball of radius `tolerance` may be closed, and so may tunnels and bubbles of
/// any width if that gives the surface the topology of the medial mesh: their walls are the hidden part of the
/// envelope. Distances to the envelope are exact, not those of a tessellation. The same input gives the same surface
/// whatever the number of threads. Throws Error if there are no spheres, if they have no extent, or if the tolerance is
/// out of its range; Cancelled if the context says so.
Reconstruction reconstruct(const MedialMesh& mesh, double tolerance_percent, Context& context);

/// Of a surface of which every edge has two triangles and every vertex one fan, as that of a reconstruction.
SurfaceTopology surface_topology(const TriSurface& surface);

}  // namespace matstruct
