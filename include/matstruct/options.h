// Options of a computation. Aggregate with defaults: {.gamma = 60, .threads = 2}.
#pragma once

#include <cstdint>

#include <matstruct/types.h>

namespace matstruct {

/// Mechanical parts have sharp edges, flat and round walls; organic shapes are smooth and noisy.
enum class ShapeKind { kAuto, kMechanical, kOrganic };

/// Ranges are what validate() accepts.
struct Options {
  /// Sampling density: points on the surface from which spheres are made are a bounding-box diagonal / gamma apart; in
  /// [2, 1000]. The number of spheres grows with its square.
  double gamma = 40;
  /// Degrees in [0.001, 179.999]: an edge is convex-sharp if its dihedral angle is below 180 - this. Also the angle
  /// below which two contacts of a sphere count as one smooth contact.
  double convex_angle = 30;
  /// Degrees in [0.001, 179.999]: an edge is concave-sharp if its dihedral angle is above 180 + this.
  double concave_angle = 30;
  /// Organic shapes get no seams of their own, since their bumps would make too many. kAuto: organic without convex
  /// sharp lines, or if seams leave much of the mesh without sheets.
  ShapeKind shape = ShapeKind::kAuto;
  double thinning = 0.2;   ///< faces of less importance than this are thinned away (method of MATTopo); in [0, 1]
  double deviation = 0.3;  ///< % of the diagonal: where the mesh cuts across a bend of the axis by more, spheres are
                           ///< added; bumps of parts below half of it make no sheets; in [0.001, 100]
  int refinements = 2;     ///< cap on the rounds of that; in [0, 100]
  /// Edges and faces of the dual complex are judged by the solid between their spheres; otherwise by what the cells
  /// hold of its surface alone, as in earlier programs (MATFP 2022).
  bool volume_classification = true;
  bool seams = true;   ///< find seams and junctions, put spheres on them and keep them (paper section 7)
  bool clean = true;   ///< drop strata that are there by chance, fill gaps that thinning left in sheets
  bool remesh = true;  ///< even out the triangles of the medial mesh, keeping its strata
  /// Cap on the rounds of particles (paper section 8), in [0, 1000]. 0, the default, is none: beside remeshing they
  /// hardly help triangles, raise the Hausdorff distance of CAD parts and take time (docs/design/optimise.md).
  int particle_rounds = 0;
  /// The rounds end when the number of spheres whose cells meet three or more sub-volumes, those at seams and
  /// junctions, changes by less than this share; in [0, 1], 0: all rounds are run.
  double particle_change = 3e-4;
  /// A minimisation ends when the root mean square of the particles' gradients is below this; in [1e-6, 1].
  double particle_gradient = 5e-3;
  /// Particles move in the directions only that their contacts leave free; otherwise all but those on sharp lines move
  /// anywhere and are projected back afterwards.
  bool gradient_projection = true;
  int max_rounds = 60;     ///< cap on the rounds of topology and feature preservation; in [0, 100000]
  std::uint64_t seed = 1;  ///< of all random choices
  int samples = 100000;    ///< points on either side for the report's Hausdorff distance; in [1000, 100000000]
  int threads = 0;         ///< 0 = all cores; in [0, 4096]; never changes a result

  /// Throws Error naming the first field that is out of its range.
  void validate() const;
};

}  // namespace matstruct
