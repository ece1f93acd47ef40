// The angle between the faces that meet at an edge of a tessellated surface, which is not the angle between its facets.
#pragma once

#include <array>
#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// Interior dihedral angle in (0, 2 pi) at the edge opposite local vertex `local` of a triangle. Whether it is below,
/// at or above pi is decided exactly.
double dihedral_angle(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                      const std::vector<Vec3>& normals, Index triangle, std::size_t local);

/// By how much the solid turns at an edge from one face to the other, in radians: positive at a convex edge, negative
/// at a concave one. The edge is that opposite local vertex `local` of a triangle. A facet of a curved face is a chord:
/// it has the face's direction in its middle, and the face turns on up to the edge. By how much is read off the facets
/// behind, if they turn evenly; elsewhere the face is as its facets are. Facets that turn by `smooth` or more belong to
/// two faces. What is added is good to some per cent; they count for the convex edge. `neighbors` and `normals` as in
/// Domain; without a neighbour (kInvalid) a face ends.
double face_turn(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                 const std::vector<Vec3>& normals, Index triangle, std::size_t local, double smooth);

/// Whether an edge with a triangle on both sides is convex and the faces turn there by more than `limit`, radians.
/// `dihedral`: dihedral_angle() of the edge.
bool is_sharp_convex(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                     const std::vector<Vec3>& normals, Index triangle, std::size_t local, double dihedral,
                     double limit);

/// Whether the facets of an edge turn there by more than twice what the faces beside it turn, the same way, up to the
/// middle of the next facet along the section: the edges of a rounding do not. `smooth` as in face_turn().
bool stands_out(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                const std::vector<Vec3>& normals, Index triangle, std::size_t local, double smooth);

/// How far an edge with a triangle on both sides stands from the line between two places beside it, across it: those up
/// to which the surface has turned by half of what it turns at the edge, or where the face ends. So cutting facets into
/// smaller triangles changes nothing. `smooth` as in face_turn().
double edge_height(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                   const std::vector<Vec3>& normals, Index triangle, std::size_t local, double smooth);

}  // namespace matstruct
