// A medial mesh with what a remeshing has to know of its strata.
#pragma once

#include <cstdint>
#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// Where a vertex may go: the dimension of its stratum.
enum class Freedom : std::uint8_t {
  kFixed = 0,  ///< nowhere: junction, corner, end of a curve, sharp line, or where sheets meet in some other way
  kCurve = 1,  ///< along its curve: inside a seam, a boundary or a medial curve
  kSheet = 2,  ///< in its sheet
};

/// Strata as trace_strata() tells them.
struct StratifiedMesh {
  MedialMesh mesh;               ///< internal units
  std::vector<Freedom> freedom;  ///< #V
  /// Edges that lie inside no sheet (of other than two faces), and fixed ones; ascending pairs, sorted.
  std::vector<Edge> curve_edges;
  std::vector<Index> sheet_of_face;  ///< #F
};

/// `fixed_edges`: edges that stay as they are, ascending pairs. Their ends are fixed, and so are the vertices of types
/// kSharpEdge, kCorner and kJunction and the junctions by connectivity. A vertex is free in a sheet only if its star is
/// a disk of that sheet, on a curve only if each sheet of the curve reaches it in half a disk.
StratifiedMesh stratify(MedialMesh mesh, const std::vector<Edge>& fixed_edges);

}  // namespace matstruct
