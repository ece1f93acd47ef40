// The sphere of least power distance to each of many fixed points.
#pragma once

#include <span>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "geometry/power_predicates.h"

namespace matstruct {

/// Neighbours in the regular triangulation of the spheres, as CSR: those of s are list[start[s]] .. list[start[s + 1]];
/// hidden spheres have none (rpd/power_triangulation.h).
struct SphereNeighbors {
  std::span<const Index> start, list;
};

/// Sets owners[k] to the sphere of least power distance to point k, as computed in double precision: of spheres that
/// tie to rounding any may own the point. Walks over the neighbours from the last owner, so that an update after small
/// moves costs little; `owners` may hold anything, or nothing the first time. Points in an order that is coherent in
/// space make the first time fast. The same for any number of threads.
void update_owners(std::span<const Vec3> points, std::span<const WeightedPoint> spheres,
                   const SphereNeighbors& neighbors, const Context& context, std::vector<Index>& owners);

}  // namespace matstruct
