// The medial structure of a result: its strata with their measures, how they bound each other, and where each sphere
// touches the solid.
#pragma once

#include <array>
#include <vector>

#include <matstruct/strata.h>
#include <matstruct/types.h>

namespace matstruct {

/// A two-dimensional stratum. Lists are ascending and without repetition.
struct SheetStratum {
  std::vector<Index> faces;
  double area = 0;         ///< of its triangles of centres
  double mean_radius = 0;  ///< of the interpolated radius over the area; of the vertices if the area is 0
  double min_radius = 0, max_radius = 0;
  std::vector<Index> seams, boundaries, junctions;  ///< those that it touches: positions in Structure
};

/// A one-dimensional stratum: a seam, a boundary or a medial curve.
struct CurveStratum {
  std::vector<Index> vertices;  ///< in order; a closed curve repeats its first vertex at the end
  std::vector<Index> sheets;    ///< around each edge, as in Curve: an entry per face
  double length = 0;            ///< of the polygon of centres
  bool closed = false;
  /// Where it begins and ends: the stratum of the corner there, else of the junction, else kInvalid.
  std::array<Index, 2> ends{kInvalid, kInvalid};
  /// Of a boundary: all its vertices are spheres of radius 0 on a convex sharp line. Otherwise it ends freely, at least
  /// in part.
  bool sharp = false;
};

/// A point where curves meet. Lists are ascending and without repetition.
struct PointStratum {
  Index vertex = kInvalid;
  std::vector<Index> seams, boundaries, curves;  ///< those that begin, end or pass here: positions in Structure
};

/// Every stratum has one id: sheets come first, then seams, boundaries, medial curves, junctions and corners, each in
/// their order.
struct Structure {
  std::vector<Index> sheet_of_face;  ///< #F
  std::vector<SheetStratum> sheets;
  std::vector<CurveStratum> seams;       ///< where three or more faces meet
  std::vector<CurveStratum> boundaries;  ///< edges of one face
  std::vector<CurveStratum> curves;      ///< medial curves: edges of no face
  std::vector<PointStratum> junctions;   ///< where at least two seams end
  std::vector<PointStratum> corners;     ///< spheres of type kCorner; one where two seams end is a junction too
  /// Pairs of strata (lower dimension, higher dimension), the first in the closure of the second: a curve on the border
  /// of a sheet, a point on a curve, a medial curve that ends in a sheet. Sorted.
  std::vector<std::array<Index, 2>> adjacency;

  Index first_seam() const { return static_cast<Index>(sheets.size()); }
  Index first_boundary() const { return first_seam() + static_cast<Index>(seams.size()); }
  Index first_curve() const { return first_boundary() + static_cast<Index>(boundaries.size()); }
  Index first_junction() const { return first_curve() + static_cast<Index>(curves.size()); }
  Index first_corner() const { return first_junction() + static_cast<Index>(junctions.size()); }
  Index strata() const { return first_corner() + static_cast<Index>(corners.size()); }
};

/// Told from the connectivity (trace_strata()), the centres and radii, and, for corners and sharp boundaries, the
/// types. Units of the mesh. Cost O(n log n). Needs what MedialMesh promises.
Structure structure_of(const MedialMesh& mesh);

/// Types that agree with the structure: what is kSharpEdge or kCorner stays; of the others, junctions become kJunction,
/// vertices of seams kSeam, all else kSheet, whatever their type was.
std::vector<SphereType> types_by_structure(const MedialMesh& mesh, const Structure& structure);

/// Where the spheres of a medial mesh touch the solid: connected parts of its surface that are nearer to the centre
/// than the nearest point by no more than 1e-6 of the diagonal.
struct VertexContacts {
  std::vector<Index> start;      ///< #V + 1: contacts of vertex v are start[v] up to start[v + 1], nearest first
  std::vector<Vec3> points;      ///< on the surface, input units
  std::vector<Index> triangles;  ///< of Result::surface, that hold the points
  /// Per triangle of Result::surface: connected over edges that are not convex and sharp, numbered by first triangles.
  std::vector<Index> patch_of_triangle;

  Index of(Index vertex) const {
    return start[static_cast<std::size_t>(vertex) + 1] - start[static_cast<std::size_t>(vertex)];
  }
};

}  // namespace matstruct
