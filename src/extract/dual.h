// The dual complex (nerve) of a restricted power diagram: a subcomplex of the regular triangulation of the spheres.
#pragma once

#include <vector>

#include <matstruct/types.h>

#include "rpd/rpd.h"

namespace matstruct {

/// Simplices of sphere ids, each ascending, all sorted and unique; closed under taking faces.
struct DualComplex {
  std::vector<Index> vertices;
  std::vector<Edge> edges;
  std::vector<Triangle> triangles;
  std::vector<double> lengths;  ///< #triangles: length of the restricted power edge behind each triangle
  std::vector<Tetrahedron> tets;
};

/// A subcomplex of the spheres' regular triangulation, hence embedded in space. Cost O(records log records).
DualComplex dual_complex(const Rpd& rpd);

}  // namespace matstruct
