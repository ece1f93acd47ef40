// Solids with concave edges and round ones, each with the numbers of the strata of its medial axis, derived by hand.
//
// Extrusions. Let P be the plane profile, d(x) the distance of x in P to its outline, M the plane medial axis of P: a
// graph with n nodes of degree three or more and a arcs between nodes and the c convex corners of P, where it ends. A
// concave corner touches discs like an edge does, and the bisector goes on smoothly from the part that belongs to a
// neighbouring edge to the part that belongs to the corner (line into parabola): it makes neither nodes nor arcs. M
// cuts P into R regions, one for each stretch of the outline between convex corners, and one for each hole without
// them. Extruded to the height h:
//
// - Tall, h / 2 above the greatest d: a wall over each arc, a roof {z = d} and a floor over each region (again smooth
//   across what belongs to a concave corner). Sheets a + 2 R; seams: one upright at each node, two along each arc,
//   n + 2 a; junctions 2 n.
// - Flat, h / 2 below d at all nodes, and {d >= h / 2} in one piece: the middle {d >= h / 2}, for each region a slanted
//   sheet above and below, for each convex corner a triangle from its upright edge to the middle. Sheets 1 + 2 R + c;
//   seams: R around the middle, two at each triangle, R + 2 c; junctions c.
//
// Both have 2 c corners. Boundaries run along the convex edges; at the end of a concave edge two of them go over into
// each other, since no seam ends there: c upright ones and 2 R along the outlines. Of the R regions those of a hole
// without convex corners have closed seams (flat) and closed boundaries; then their sheets and the middle have holes.
// A closed circle of M without nodes counts as one arc, with closed seams along it.
#pragma once

#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <matstruct/metrics.h>

#include "shapes.h"

namespace matstruct::shapes {

/// Surface of the ellipsoid with half axes along x, y, z: n meridians, n / 2 parallels.
inline TriSurface ellipsoid(const Vec3& half, int n) {
  TriSurface surface;
  const auto at = [&](double polar, double around) {
    surface.vertices.push_back({half.x * std::sin(polar) * std::cos(around),
                                half.y * std::sin(polar) * std::sin(around), half.z * std::cos(polar)});
  };
  const int rings = n / 2 - 1;
  at(0, 0);
  for (int i = 1; i <= rings; ++i)
    for (int k = 0; k < n; ++k) at(std::numbers::pi * i / (rings + 1), 2 * std::numbers::pi * k / n);
  at(std::numbers::pi, 0);
  const Index last = 1 + rings * n;
  for (int k = 0; k < n; ++k) {
    const int next = (k + 1) % n;
    surface.triangles.push_back({0, 1 + k, 1 + next});
    for (int i = 0; i + 1 < rings; ++i) {
      const Index upper = 1 + i * n, lower = upper + n;
      surface.triangles.push_back({upper + k, lower + k, lower + next});
      surface.triangles.push_back({upper + k, lower + next, upper + next});
    }
    surface.triangles.push_back({last, last - n + next, last - n + k});
  }
  return surface;
}

/// Surface of a cylinder of radius 1 and the given length along z with half spheres at its ends; n around.
inline TriSurface capsule(double length, int n) {
  TriSurface surface = ellipsoid({1, 1, 1}, n);
  // The parallels of the upper half move up and those of the lower half down; n / 2 is even, so one lies at z = 0.
  for (Vec3& p : surface.vertices) p.z += p.z > 1e-9 ? length / 2 : (p.z < -1e-9 ? -length / 2 : 0);
  return surface;
}

/// Tets from the origin to the triangles of a surface that is star-shaped around it.
inline TetMesh star(const TriSurface& surface) {
  TetMesh mesh{surface.vertices, {}};
  mesh.vertices.push_back({0, 0, 0});
  const Index origin = static_cast<Index>(surface.vertices.size());
  for (const auto& [a, b, c] : surface.triangles) mesh.tets.push_back({origin, a, b, c});
  return positive(std::move(mesh));
}

/// The cells of a grid in the plane, extruded along z: one string per row from the top, '#' where there is material.
inline TetMesh extruded(const std::vector<std::string>& rows, double height) {
  const int n = static_cast<int>(rows.size());
  const auto solid = [&](int i, int j, int) {
    return rows[static_cast<std::size_t>(n - 1 - j)][static_cast<std::size_t>(i)] == '#';
  };
  const int columns = static_cast<int>(rows.front().size());
  return grid(planes(columns, columns), planes(n, n), {0, height}, solid);
}

/// Triangles of the plane, extruded from z = 0.
inline TetMesh extruded(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles, double height) {
  TetMesh mesh{points, {}};
  const Index shift = static_cast<Index>(points.size());
  for (const Vec3& p : points) mesh.vertices.push_back(p + Vec3{0, 0, height});
  for (Triangle t : triangles) {
    std::sort(t.begin(), t.end());  // prisms with a common side cut it along the same diagonal
    const auto [a, b, c] = t;
    mesh.tets.push_back({a, b, c, c + shift});
    mesh.tets.push_back({a, b, b + shift, c + shift});
    mesh.tets.push_back({a, a + shift, b + shift, c + shift});
  }
  return positive(std::move(mesh));
}

/// Plate of columns x rows squares of side 2, each with a round hole in its middle; 4 m segments around a hole.
inline TetMesh plate_with_round_holes(int columns, int rows, double hole_radius, double thickness, int m = 12) {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::map<std::pair<int, int>, Index> on_squares;
  for (int ci = 0; ci < columns; ++ci)
    for (int cj = 0; cj < rows; ++cj) {
      const Vec3 middle{2.0 * ci + 1, 2.0 * cj + 1, 0};
      std::vector<Index> outer, inner;
      for (int k = 0; k < 4 * m; ++k) {
        const int step = k % m;
        const std::pair<int, int> corner[4] = {{step, 0}, {m, step}, {m - step, m}, {0, m - step}};
        const std::pair<int, int> place{ci * m + corner[k / m].first, cj * m + corner[k / m].second};
        const Vec3 at{2.0 * place.first / m, 2.0 * place.second / m, 0};
        const auto [it, added] = on_squares.try_emplace(place, static_cast<Index>(points.size()));
        if (added) points.push_back(at);
        outer.push_back(it->second);
        inner.push_back(static_cast<Index>(points.size()));
        points.push_back(middle + normalized(at - middle) * hole_radius);
      }
      for (std::size_t k = 0; k < outer.size(); ++k) {
        const std::size_t next = (k + 1) % outer.size();
        triangles.push_back({outer[k], outer[next], inner[k]});
        triangles.push_back({outer[next], inner[next], inner[k]});
      }
    }
  return extruded(points, triangles, thickness);
}

/// Ring of rectangular section around z: radii big -+ width / 2; m steps around.
inline TetMesh tube(double big, double width, double height, int m) {
  return sweep(1, 4, m, true, [=](double u, double v, int s) {
    const double angle = 2 * std::numbers::pi * s / m, radius = big + (u + v) * width / 2;
    return Vec3{radius * std::cos(angle), radius * std::sin(angle), (u - v) * height / 2};
  });
}

struct KnownStructure {
  std::string name;
  TetMesh mesh;
  StructureCounts counts;
  Index holes = 0;      ///< in the sheets, together
  Index free_ends = 0;  ///< of medial curves that end in no sheet; an axis that is one point counts as one
};

/// c convex corners, n nodes, a arcs and R regions, of which `round` belong to holes without convex corners.
struct Profile {
  Index corners = 0, nodes = 0, arcs = 0, regions = 0, round = 0;
};

inline StructureCounts tall(const Profile& p) {
  return {.sheets = p.arcs + 2 * p.regions,
          .seams = p.nodes + 2 * p.arcs,
          .boundaries = p.corners + 2 * p.regions,
          .closed_boundaries = 2 * p.round,
          .junctions = 2 * p.nodes,
          .corners = 2 * p.corners};
}

inline StructureCounts flat(const Profile& p) {
  return {.sheets = 1 + 2 * p.regions + p.corners,
          .seams = p.regions + 2 * p.corners,
          .closed_seams = p.round,
          .boundaries = p.corners + 2 * p.regions,
          .closed_boundaries = 2 * p.round,
          .junctions = p.corners,
          .corners = 2 * p.corners};
}

/// Extrusions of profiles of walls of width 1.
inline std::vector<KnownStructure> profiles() {
  // L: five convex corners and one concave. M is a tree with five ends, hence three nodes and seven arcs: a node where
  // each leg ends, at distance 1/2 of three sides, and one at 2 - sqrt(2) from both outer sides and the concave corner.
  const Profile l{5, 3, 7, 5};
  // T: flange 3 x 1 on a web of 1 x 2. Six convex corners: a tree with six ends, four nodes and nine arcs: nodes at
  // both ends of the flange and at the foot of the web, and one at 5/8 from the top and both concave corners.
  const Profile t{6, 4, 9, 6};
  // U: 3 x 3 without its upper middle. Six convex corners, a tree with six ends: a node at the end of each leg and one
  // in each lower corner, as in L.
  const Profile u{6, 4, 9, 6};
  // A square 3 x 3 without its middle: four convex corners, M a ring with an arc to each of them: four nodes, eight
  // arcs, four outer regions and one around the hole, whose four concave corners do not count.
  const Profile ring{4, 4, 8, 5, 1};
  const std::vector<std::string> l_cells{"#..", "#..", "###"}, t_cells{"###", ".#.", ".#."},
      u_cells{"#.#", "#.#", "###"}, ring_cells{"###", "#.#", "###"};
  return {{"tall L", extruded(l_cells, 4), tall(l)},
          {"flat L", extruded(l_cells, 0.5), flat(l)},
          {"tall T", extruded(t_cells, 4), tall(t)},
          {"flat T", extruded(t_cells, 0.5), flat(t)},
          {"tall U", extruded(u_cells, 4), tall(u)},
          {"flat U", extruded(u_cells, 0.5), flat(u)},
          {"tall frame", extruded(ring_cells, 4), tall(ring), 2},
          {"flat frame", extruded(ring_cells, 0.5), flat(ring), 3}};
}

/// Plates with round holes of 48 segments: four convex corners; nodes and arcs do not matter to flat ones.
inline std::vector<KnownStructure> plates() {
  // A block with a hole: a ring with arcs to the corners, as for the frame. At the nodes d = sqrt(2) (1 - d) - 1/2,
  // that is 0.38: half the height is more.
  const Profile one{4, 4, 8, 5, 1};
  // Flat: half the thickness, 0.15, is below half the gap between hole and side, 0.25: the middle is in one piece.
  const Profile six{4, 0, 0, 10, 6};
  return {{"block with a round hole", plate_with_round_holes(1, 1, 0.5, 2), tall(one), 2},
          {"plate with a round hole", plate_with_round_holes(1, 1, 0.5, 0.3), flat(one), 3},
          {"plate with six round holes", plate_with_round_holes(3, 2, 0.5, 0.3), flat(six), 18}};
}

/// Round solids of n segments around.
inline std::vector<KnownStructure> round_solids(int n) {
  // High cylinder: the axis, a medial curve, between the tips of two cones that end at the rims. Flat: a disc and two
  // cones' frusta meet in a circle. Ball: one point. Torus: a circle. Tube: the middle cylinder or ring and four frusta
  // to the rims; two circles as seams. Ellipsoids: an elliptic disc; a segment if the two shorter axes are equal.
  const StructureCounts high{.sheets = 2, .boundaries = 2, .closed_boundaries = 2, .curves = 1};
  const StructureCounts low{.sheets = 3, .seams = 1, .closed_seams = 1, .boundaries = 2, .closed_boundaries = 2};
  const StructureCounts ring{.sheets = 5, .seams = 2, .closed_seams = 2, .boundaries = 4, .closed_boundaries = 4};
  const StructureCounts disc{.sheets = 1, .boundaries = 1, .closed_boundaries = 1};
  const StructureCounts segment{.curves = 1}, circle{.curves = 1, .closed_curves = 1};
  return {{"high cylinder", prism(1, 4, n), high},
          {"flat cylinder", prism(1, 0.8, n), low, 2},
          {"high tube", tube(1, 0.4, 2, n), ring, 5},
          {"flat tube", tube(1.5, 1, 0.4, n), ring, 5},
          {"torus", torus(3, 1, 2 * n, n), circle},
          {"capsule", star(capsule(3, n)), segment, 0, 2},
          {"ball", star(ellipsoid({1, 1, 1}, n)), {}, 0, 1},
          {"ellipsoid", star(ellipsoid({3, 2, 1}, n)), disc},
          {"oblate ellipsoid", star(ellipsoid({2, 2, 1}, n)), disc},
          {"prolate ellipsoid", star(ellipsoid({1, 1, 2}, n)), segment, 0, 2}};
}

}  // namespace matstruct::shapes
