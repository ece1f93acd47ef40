// Numbers of the strata that a medial mesh should have, known exactly.
#pragma once

#include <array>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <matstruct/metrics.h>

#include "convex_oracle.h"

namespace matstruct {

inline void PrintTo(const StructureCounts& s, std::ostream* out) {
  *out << s.sheets << " sheets, " << s.seams << " seams (" << s.closed_seams << " closed), " << s.junctions
       << " junctions, " << s.corners << " corners, " << s.boundaries << " boundaries (" << s.closed_boundaries
       << " closed), " << s.curves << " curves (" << s.closed_curves << " closed)";
}

namespace oracle {

/// The exact counts of a convex polyhedron, degenerate or not: every edge bounds one sheet, at every vertex a seam ends
/// at least.
inline StructureCounts structure_of(const ConvexAxis& axis) {
  return {.sheets = count(axis.sheets),
          .seams = static_cast<Index>(axis.seams.size()),
          .boundaries = static_cast<Index>(axis.boundaries.size()),
          .junctions = axis.junctions(),
          .corners = axis.corners()};
}

/// Shortest edge of the axis, inside or on the solid's boundary: what a sampling has to resolve.
inline double shortest_edge(const ConvexAxis& axis) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& edges : {axis.seams, axis.boundaries})
    for (const auto& [edge, sheets] : edges)
      shortest = std::min(shortest, distance(axis.vertices[uz(edge[0])], axis.vertices[uz(edge[1])]));
  return shortest;
}

struct NamedPolyhedron {
  std::string name;
  ConvexPolyhedron solid;
};

/// All boxes 1 <= b <= c with edge ratios from a list that has equal, nearly equal and very different ones.
inline std::vector<NamedPolyhedron> boxes() {
  constexpr std::array<double, 6> kRatios = {1, 1.05, 1.5, 2, 4, 10};
  std::vector<NamedPolyhedron> list;
  for (const double b : kRatios)
    for (const double c : kRatios)
      if (b <= c) list.push_back({fmt::format("box 1 x {} x {}", b, c), box(1, b, c)});
  return list;
}

/// Regular prisms: flat, high, and of the height at which the axis of an even one degenerates.
inline std::vector<NamedPolyhedron> prisms() {
  std::vector<NamedPolyhedron> list;
  for (const int sides : {3, 4, 5, 6, 7, 8, 12})
    for (const double height : {0.5, 2.0, 6.0})
      list.push_back({fmt::format("prism of {} sides, height {}", sides, height), prism(sides, 1, height)});
  return list;
}

inline std::vector<NamedPolyhedron> pyramids() {
  std::vector<NamedPolyhedron> list;
  for (const int sides : {3, 4, 5, 6, 8})
    for (const double height : {0.7, 2.0, 4.0})
      list.push_back({fmt::format("pyramid of {} sides, height {}", sides, height), pyramid(sides, 1, height)});
  return list;
}

/// Wedges: a triangle of base 2 and the given height whose tip is above `tip` of the base, extruded by 3.
inline ConvexPolyhedron wedge(double height, double tip) {
  const Vec3 left = normalized(Vec3{-height, 2 * tip, 0}), right = normalized(Vec3{height, 2 - 2 * tip, 0});
  return convex_polyhedron(
      {{{0, -1, 0}, 0}, {left, 0}, {right, dot(right, {2, 0, 0})}, {{0, 0, 1}, 1.5}, {{0, 0, -1}, 1.5}});
}

inline std::vector<NamedPolyhedron> wedges() {
  std::vector<NamedPolyhedron> list;
  for (const double height : {0.5, 1.0, 3.0})
    for (const double tip : {0.0, 0.25, 0.5})
      list.push_back({fmt::format("wedge of height {}, tip at {}", height, tip), wedge(height, tip)});
  return list;
}

/// Solids of 6 to 20 faces in turn; the seed of the k-th is k.
inline std::vector<NamedPolyhedron> random_polyhedra(int n) {
  constexpr int kFewest = 6, kCounts = 15;
  std::vector<NamedPolyhedron> list;
  for (int k = 0; k < n; ++k) {
    const int faces = kFewest + k % kCounts;
    list.push_back({fmt::format("random polyhedron {} of {} faces", k, faces),
                    random_convex_polyhedron(static_cast<std::uint64_t>(k), faces)});
  }
  return list;
}

}  // namespace oracle
}  // namespace matstruct
