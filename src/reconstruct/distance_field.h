// The distance to the union of medial primitives, at the points of a grid that is refined near one of its level sets.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "metrics/medial_tree.h"
#include "reconstruct/tet_grid.h"

namespace matstruct {

class DistanceField {
 public:
  /// What to resolve; input units.
  struct Resolution {
    double level;    ///< of the level set
    double error;    ///< that linear interpolation may make there
    double finest;   ///< tetrahedra are not divided for its sake when shorter than this
    double largest;  ///< tetrahedra at the level set are at most this long
  };
  /// The grid spans the box from `low` to `high`, and more.
  DistanceField(const MedialTree& tree, const Vec3& low, const Vec3& high, const Resolution& resolution,
                const Context& context);

  /// Refines wherever the level set may be until the distance is nearly linear in each tetrahedron there. Deterministic
  /// whatever the number of threads.
  void refine();
  /// Divides the tetrahedra around the points until they are no longer than `size`; false if they are already.
  bool divide_around(const std::vector<Vec3>& points, double size);

  const std::vector<Tetrahedron>& tets() const { return grid_.tets(); }
  /// #P points and their values; some are in no tetrahedron.
  std::vector<Vec3> places() const;
  const std::vector<double>& values() const { return values_; }
  /// The tetrahedron around a point; nothing outside of the grid.
  std::optional<Tetrahedron> tet_around(const Vec3& x) const { return grid_.around((x - origin_) / unit_); }

 private:
  Vec3 place(const GridPoint& at) const { return origin_ + Vec3{double(at[0]), double(at[1]), double(at[2])} * unit_; }
  double length(const Tetrahedron& tet) const { return unit_ * grid_.size(tet); }
  void evaluate();
  bool may_split(const Tetrahedron& tet) const;
  std::array<Index, 6> midpoints_of(const Tetrahedron& tet);
  bool must_split(const Tetrahedron& tet, const std::array<Index, 6>& midpoints) const;

  const MedialTree& tree_;
  Resolution resolution_;
  const Context& context_;
  TetGrid grid_;
  Index seen_ = 0;  // the first tetrahedra, of which it is known whether they must be split
  Vec3 origin_;
  double unit_ = 1;
  std::vector<double> values_;  // at the grid's points
};

}  // namespace matstruct
