// How far a surface stands from the shape that it stands for, read off the angles between its facets.
#pragma once

#include <array>
#include <vector>

#include <matstruct/types.h>

#include "prepare/domain.h"

namespace matstruct {

/// The height (half of edge_height(): above the shape in the middle, and below) that nine tenths of the given edges, by
/// their length, do not exceed; 0 without edges. `neighbors` and `normals` as in Domain; `smooth` as in face_turn().
double height_of_edges(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                       const std::vector<Vec3>& normals, const std::vector<SharpEdge>& edges, double smooth);

/// How far facets stand from the smooth faces that they stand for: the same of all edges of a domain but the sharp ones
/// and those between facets of one plane; 0 on polyhedra, internal units.
double height_of_facets(const Domain& domain, double smooth);

/// The same at one triangle: the greatest height of its edges that are not sharp.
double height_of_facet(const Domain& domain, Index triangle, double smooth);

}  // namespace matstruct
