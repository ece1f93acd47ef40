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

}  // namespace matstruct
