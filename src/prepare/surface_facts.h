// What can be said of any triangle surface, whether it bounds a solid or not.
#pragma once

#include <string>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

namespace matstruct {

struct SurfaceFacts {
  Index components = 0;                             ///< sets of triangles connected by vertices
  Index border_edges = 0;                           ///< of one triangle
  Index crowded_edges = 0;                          ///< of more than two
  std::vector<Vec3> border_places, crowded_places;  ///< middles of the first few, input units
  Index intersections = 0;                          ///< pairs of triangles that meet beside common vertices and edges
  std::vector<Vec3> intersection_places;            ///< a point of each of the first few
  std::string intersections_unknown;                ///< why they could not be looked for; empty if they were
};

/// After welding as for tetrahedralise(). Throws Error for indices out of range and coordinates that are not finite.
SurfaceFacts surface_facts(const TriSurface& surface, Context& context);

}  // namespace matstruct
