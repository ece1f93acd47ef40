// Sets of grid vertices with a wanted topology.
#pragma once

#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// Vertices (#P, 1 for those inside) of conforming tetrahedra. Starts from all whose value is below `start` and takes
/// away those with values of at least `end`, the greatest first, as long as the set's topology stays what it is: a
/// vertex goes only if its neighbours inside are connected among themselves, and those outside too (both within its
/// link, a sphere; so what is inside of it is a disc, and the vertex is homotopically redundant). Both the tetrahedra
/// between vertices inside and the complement keep their homotopy type. No vertex at the boundary of the grid may be
/// inside.
std::vector<char> shrink(const std::vector<Tetrahedron>& tets, const std::vector<double>& values, double start,
                         double end);

}  // namespace matstruct
