// A cube filled with tetrahedra that can be refined where needed and stay conforming: two tetrahedra meet in a common
// vertex, edge or face, or not at all.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// A point of the grid, in its finest units.
using GridPoint = std::array<std::int32_t, 3>;

/// Bisection of Kuhn's six tetrahedra per cube at their longest edges (Maubach 1995), kept conforming by the rule that
/// a midpoint is split only after all midpoints on which its tetrahedra depend.
class TetGrid {
 public:
  /// Edge of the whole cube in finest units, and of the cubes that it starts from.
  static constexpr std::int32_t kSize = 1 << 20, kCube = kSize >> 3;

  TetGrid();

  /// #P points in the order in which they were asked for: vertices, and those that someone has looked at.
  const std::vector<GridPoint>& points() const { return points_; }
  /// The tetrahedra, positively oriented, as indices into points(); the longest edge joins the first two.
  const std::vector<Tetrahedron>& tets() const { return tets_; }
  /// The id of a point; makes it a point if it is none yet.
  Index point(const GridPoint& at);
  /// The midpoint of two vertices of a tetrahedron; makes it a point.
  Index midpoint(Index a, Index b);
  /// The tetrahedron around a point, which is in finest units; nothing outside of the cube.
  std::optional<Tetrahedron> around(const Vec3& at) const;
  /// Length of the longest edge, finest units.
  double size(const Tetrahedron& tet) const;

  /// Asks that the tetrahedron be bisected at the next refine(). One whose edges can no longer be halved stays.
  void mark(const Tetrahedron& tet);
  /// The same for the tetrahedron around a point of the cube, which is in finest units, if it is larger than `size`;
  /// false if it is not.
  bool mark_around(const Vec3& at, double size);
  /// Bisects what was marked and what must follow for the tetrahedra to stay conforming. Returns how many of the first
  /// `first` tetrahedra remain; they come first, in their order.
  Index refine(Index first);

 private:
  static std::uint64_t key(const GridPoint& at);
  static bool inside(const GridPoint& at);
  GridPoint halfway(Index a, Index b) const;
  Tetrahedron longest_edge_first(const Tetrahedron& tet) const;
  void split(const GridPoint& midpoint);
  bool is_split(const GridPoint& midpoint) const { return split_.contains(key(midpoint)); }

  std::vector<GridPoint> points_;
  std::unordered_map<std::uint64_t, Index> index_;
  std::unordered_set<std::uint64_t> split_;  // midpoints of bisected edges
  std::unordered_set<std::uint64_t> fresh_;  // those of this refine(); of the tetrahedra that are left, only they open
  std::vector<Tetrahedron> roots_, tets_;
  std::vector<GridPoint> marked_;
};

}  // namespace matstruct
