// The mesher's tasks. Each throws std::exception with a phrase for Answer::error, or fails in whatever way the
// libraries do: main() and the process's caller cope.
#pragma once

#include "prepare/mesher/protocol.h"

namespace matstruct::mesher {

/// Fills closed surfaces by Gmsh. Vertices and triangles of the request stay.
Answer fill(const Request& request);

/// Reads STEP or BREP by OpenCASCADE and makes a conforming triangulation of each solid.
Answer read_cad(const Request& request);

/// Cuts triangles where they meet, exactly, and keeps those that separate the inside (winding number above one half)
/// from the outside. Sheets with free edges are left out if they are small. Edges of the result may have four or more
/// triangles. Points are moved to a grid of width request.size if that is not 0. Coordinates are rounded to doubles;
/// the result is free of intersections nevertheless, or an exception says that it could not be made so.
Answer resolve(const Request& request);

/// Pairs of triangles that meet elsewhere than in a common vertex or edge: their number, and a point of each of the
/// first request.size.
Answer find_intersections(const Request& request);

/// Closes holes whose boundary loop is not larger than request.size.
Answer fill_holes(const Request& request);

/// CGAL's alpha wrap: the openings narrower than request.size are closed, the offset is a tenth of it.
Answer wrap(const Request& request);

}  // namespace matstruct::mesher
