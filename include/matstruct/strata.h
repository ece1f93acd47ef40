// The strata of a medial mesh: sheets, seams, boundaries, medial curves and junctions.
#pragma once

#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// A chain of edges of one kind with the same sheets all along. Its inner vertices lie on no other chain.
struct Curve {
  std::vector<Index> vertices;  ///< in order; a closed curve repeats its first vertex at the end
  std::vector<Index> sheets;    ///< around each edge, ascending, one entry per face: at least 3 for a seam, 1 for a
                                ///< boundary, none for a medial curve
  bool closed() const { return vertices.front() == vertices.back(); }
};

/// Told from the connectivity of the mesh alone.
struct Strata {
  std::vector<Index> sheet_of_face;  ///< #F, in [0, sheets): connected over edges with two faces
  Index sheets = 0;                  ///< numbered by their first faces
  std::vector<Curve> seams;          ///< of edges with three or more faces
  std::vector<Curve> boundaries;     ///< of edges with one face
  std::vector<Curve> curves;         ///< of edges without faces (medial curves)
  std::vector<Index> junctions;      ///< vertices where at least two seams end, ascending
};

/// Curves come in the order of their first edges in the mesh. Cost O(n log n). Needs what MedialMesh promises: edges
/// and faces sorted, every edge of a face present.
Strata trace_strata(const MedialMesh& mesh);

/// Length of the polygon of centres.
double length_of(const MedialMesh& mesh, const Curve& curve);

}  // namespace matstruct
