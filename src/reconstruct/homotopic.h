// Sets of grid vertices with a wanted topology.
#pragma once

#include <span>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/reconstruct.h>
#include <matstruct/types.h>

namespace matstruct {

/// Vertices (#P, 1 for those inside) of conforming tetrahedra. Starts from all that are `kept` or have a value below
/// `level`, and takes away those that are not kept, the greatest values first, as long as the topology stays what it
/// is: a vertex goes only if its neighbours inside are connected among themselves, and those outside too (within its
/// link, a sphere: so what is inside of it is a disc). Both what is inside and what is outside keep their homotopy
/// type. No vertex at the boundary of the grid may be inside.
std::vector<char> shrink(const std::vector<Tetrahedron>& tets, const std::vector<double>& values, double level,
                         const std::vector<char>& kept);

/// Which vertices (#P, 1) to add to those that are `inside`, so that the surface around them gets the topology
/// `wanted`, or nearer to it than `given`, which it has. At each level, in order, the set is grown to that level and
/// shrunk again: what stays are films across tunnels, where they are narrowest, fillings of bubbles, bridges, and also
/// films and bridges that make things worse. Of these connected pieces those are added, the ones with least values
/// first, that bring the topology nearer to the one wanted.
std::vector<char> fill(const std::vector<Tetrahedron>& tets, const std::vector<double>& values,
                       const std::vector<char>& inside, const SurfaceTopology& given, const SurfaceTopology& wanted,
                       std::span<const double> levels, const Context& context);

}  // namespace matstruct
