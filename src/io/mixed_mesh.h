// What a mesh file holds before it is known to be a solid or a surface.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <matstruct/types.h>

#include "io/cursor.h"
#include "io/parsers.h"

namespace matstruct {

struct MixedMesh {
  std::vector<Vec3> vertices;
  std::vector<Tetrahedron> tets;
  std::vector<Triangle> triangles;
};

/// Cuts a polygon into the fan of triangles around its first corner. Triangles that name a vertex twice are left out:
/// they have no area, and the surface around them stays closed. Fails if there are fewer than three corners.
void add_polygon(std::span<const Index> corners, Item item, const Cursor& cursor, std::vector<Triangle>& triangles);

/// Appends a tetrahedron; fails if it names a vertex twice.
void add_tetrahedron(const Tetrahedron& tet, Item item, const Cursor& cursor, std::vector<Tetrahedron>& tets);

/// The tetrahedra if there are any, else the triangles; throws Error if there are neither.
Model solid_or_surface(MixedMesh&& mesh, const std::string& name);

/// The triangles; throws Error if there are none.
TriSurface surface_of(MixedMesh&& mesh, const std::string& name);

}  // namespace matstruct
