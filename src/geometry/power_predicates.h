// Exact side tests of restricted power diagram vertices, with symbolic perturbation of the weights.
//
// Notation: sphere s has centre c_s and weight w_s = r_s^2, power distance pi_s(x) = |x - c_s|^2 - w_s. A vertex of the
// restricted power diagram is named by k + 1 spheres S and a simplex of the tetrahedral mesh with k + 1 vertices, and
// lies where all pi_s, s in S, are equal on the simplex's affine hull (k = 0: a tet vertex, 1: on a tet edge, 2: on a
// facet, 3: inside a tet, whatever tet).
//
// Ties are broken by subtracting infinitesimals from the weights, the largest from the lexicographically greatest
// centre (Devillers & Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D triangulations", 2011). That is
// the perturbation which CGAL's regular triangulation uses, so that the triangulation is dual to the very diagram
// decided here.
#pragma once

#include <span>

#include <matstruct/types.h>

namespace matstruct {

struct WeightedPoint {
  Vec3 center;
  double weight = 0;
};

/// A vertex of the restricted power diagram: `k + 1` simplex vertices and `k + 1` spheres, k in 0..3. The spheres'
/// centres are distinct. For k = 3 the simplex is not read.
struct PowerVertex {
  int k = 0;
  std::array<Vec3, 4> simplex;
  std::array<WeightedPoint, 4> spheres;
};

/// +1 if the vertex is nearer, in power distance, to its own spheres than to `other`, -1 if it is farther; never 0.
/// Filtered: plain double precision when its error bound allows, exact arithmetic otherwise. `other`'s centre is none
/// of the vertex's centres, and the vertex exists (its spheres' bisectors meet the simplex's hull in one point).
int power_side(const PowerVertex& vertex, const WeightedPoint& other);

/// The same sign in plain double precision, without error bound or perturbation; 0 for a computed tie. Wrong near ties:
/// it exists to show in tests what exactness buys.
int power_side_inexact(const PowerVertex& vertex, const WeightedPoint& other);

/// Coordinates of the vertex, with a bound of their error (Euclidean). Where rounding could cost more than `accepted`
/// and than a few units in the last place, the coordinates are computed exactly and rounded: `error` is then of the
/// order of 1e-15 times the coordinates' size.
struct LocatedVertex {
  Vec3 point;
  double error = 0;
};
LocatedVertex locate(const PowerVertex& vertex, double accepted = 0);

/// Number of times the calling thread's power_side() needed exact arithmetic, since the thread began. For benchmarks.
std::size_t exact_power_sides();

}  // namespace matstruct
