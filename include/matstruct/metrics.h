// Measures of a medial mesh (definitions: docs/design/metrics.md).
#pragma once

#include <string>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

namespace matstruct {

/// Mean over the faces of 6/sqrt(3) * area / (half perimeter * longest edge), 1 for equilateral; 0 without faces.
double triangle_quality(const MedialMesh& mesh);

/// A simplicial complex given by its simplices (every face of a simplex is present).
struct SimplicialComplex {
  Index vertices = 0;
  std::vector<Edge> edges;
  std::vector<Triangle> triangles;
  std::vector<Tetrahedron> tets;
};

/// Betti numbers over GF(2) by reduction of the boundary matrices. Throws Error if a face of a simplex is missing, a
/// simplex is there twice (in any order of its vertices) or repeats a vertex, or a vertex is out of range.
Betti betti_numbers(const SimplicialComplex& complex);
/// Of the complex of vertices, edges and faces.
Betti betti_numbers(const MedialMesh& mesh);
/// Of the complex of all faces of the tetrahedra; vertices of no tetrahedron do not count.
Betti betti_numbers(const TetMesh& solid);

/// Two-sided Hausdorff distance between a surface and the envelope of the medial primitives (spheres, cones, slabs with
/// exact distances, not a tessellation).
struct Hausdorff {
  double surface_to_envelope = 0;       ///< input units: greatest distance from a surface sample to the envelope
  double envelope_to_surface = 0;       ///< input units: greatest distance from an envelope sample to the surface
  double mean_surface_to_envelope = 0;  ///< input units, by area
  double mean_envelope_to_surface = 0;  ///< input units, by area; 0 if the envelope has no area
  double diagonal = 0;                  ///< of the surface's bounding box, input units
  double percent() const;               ///< the greater of the two, in % of the diagonal
};

/// `samples`: number of points on either side, at least 1000; on the envelope it is approximate. Deterministic whatever
/// the number of threads. Throws Error if there are no spheres or no triangles, if the surface has no extent, or if
/// `samples` is too small; Cancelled if the context says so.
Hausdorff hausdorff_distance(const MedialMesh& mesh, const TriSurface& surface, Index samples, Context& context);

/// Distances from one surface to another, input units.
struct SurfaceDistance {
  std::vector<double> of_vertices;  ///< #V of the first surface
  double greatest = 0, mean = 0;    ///< over its vertices and samples; the mean by area, over samples only
};
/// `samples` as in hausdorff_distance(). Throws Error if a surface has no triangles or `samples` is too small;
/// Cancelled if the context says so.
SurfaceDistance surface_distance(const TriSurface& from, const TriSurface& to, Index samples, Context& context);

/// What tells whether a medial mesh is thin: it has no tetrahedron, and as many pockets as the solid has cavities.
struct Thinness {
  Index tetrahedra = 0;  ///< vertex quadruples of which all four faces are present
  Index pockets = 0;     ///< closed pockets: second Betti number
};
Thinness thinness(const MedialMesh& mesh);

/// Whether spheres are what they claim to be, told from their contacts with the surface. Spheres of radius 0 (on sharp
/// lines, at corners) claim nothing.
struct StructureErrors {
  bool told_by_types = false;  ///< claims are the types kSeam and kJunction; if no sphere has one, trace_strata()'s
  Index seam_spheres = 0, seam_spheres_wrong = 0;          ///< wrong: fewer than 3 contacts
  Index junction_spheres = 0, junction_spheres_wrong = 0;  ///< wrong: fewer than 4, or not more than a seam there has
  Index sheet_spheres = 0;                                 ///< of faces, on no seam
  Index spikes = 0;                                        ///< sheet spheres without a second contact
  std::vector<Index> wrong;                                ///< ids of all these wrong spheres, ascending
  double mser() const;         ///< medial structure error ratio: share of wrong seam and junction spheres, 0 if none
  double spike_share() const;  ///< of the sheet spheres, 0 if none
};

/// `convex_angle`: degrees in (0, 180); an edge of the surface with a dihedral angle below 180 - this separates
/// contacts. The surface is closed and oriented, its vertices may be there several times. Deterministic whatever the
/// number of threads; about 0.1 ms per sphere. Throws Error if the surface has no triangles; Cancelled if
/// the context says so.
StructureErrors structure_errors(const MedialMesh& mesh, const TriSurface& surface, double convex_angle,
                                 Context& context);

/// How far the faces are from being medial: |radius - distance to the surface|, input units, over `samples` points of
/// the faces uniform by area; `max` also over the middles of all faces. Zeros without faces. Throws Error if the
/// surface has no triangles or `samples` < 1; Cancelled if the context says so.
struct Medialness {
  double mean = 0, max = 0;
};
Medialness medialness(const MedialMesh& mesh, const TriSurface& surface, Index samples, Context& context);

/// Lengths of the edges of one kind, input units; zeros without edges.
struct EdgeLengths {
  Index edges = 0;
  double min = 0, mean = 0, max = 0;
  double variation = 0;  ///< standard deviation / mean
};
/// Of the edges with two faces, with three or more, with one, and without faces.
struct Spacing {
  EdgeLengths sheets, seams, boundaries, curves;
};
Spacing spacing(const MedialMesh& mesh);

/// Numbers of the strata found by trace_strata(). Vertices of radius 0 at which seams end are corners, not junctions.
struct StructureCounts {
  Index sheets = 0;
  Index seams = 0, closed_seams = 0;            ///< closed ones are among all
  Index boundaries = 0, closed_boundaries = 0;  ///< likewise
  Index curves = 0, closed_curves = 0;          ///< likewise
  Index junctions = 0;
  Index corners = 0;  ///< vertices of radius 0 at which at least one seam ends
  friend constexpr bool operator==(const StructureCounts&, const StructureCounts&) = default;
};
StructureCounts structure_counts(const MedialMesh& mesh);

/// Two medial meshes as sets of points: faces, edges, vertices. Input units.
struct MeshComparison {
  /// From points of one mesh to the nearest ones of the other. Means are by area over the faces (without faces by
  /// length over the edges, without edges over the vertices), maxima also over all edges without faces and all
  /// vertices.
  struct Side {
    double max_distance = 0, mean_distance = 0;
    double max_radius_difference = 0, mean_radius_difference = 0;  ///< between the two points
  } first_to_second, second_to_first;
  StructureCounts first, second;
  double hausdorff() const;  ///< the greater of the two greatest distances
};

/// `samples`: points on the faces of either mesh, and on its edges without faces; at least 1. Deterministic whatever
/// the number of threads. Throws Error if a mesh has no spheres or `samples` is too small; Cancelled if the context
/// says so.
MeshComparison compare_meshes(const MedialMesh& first, const MedialMesh& second, Index samples, Context& context);

}  // namespace matstruct
