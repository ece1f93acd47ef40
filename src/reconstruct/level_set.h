// Marching tetrahedra.
#pragma once

#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// Where the values (#P, one per place) interpolated linearly in conforming, positively oriented tetrahedra change from
/// negative to not negative, oriented towards greater values. A 2-manifold, closed if all values at the boundary of the
/// tetrahedra have one sign. A vertex is kept `margin`, or a tenth of its edge if that is less, away from the ends of
/// the edge that it is on: so triangles in neighbouring tetrahedra meet in common edges only, however values are
/// rounded.
TriSurface march(const std::vector<Vec3>& places, const std::vector<double>& values,
                 const std::vector<Tetrahedron>& tets, double margin);

}  // namespace matstruct
