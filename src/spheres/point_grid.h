// Points in a uniform grid, for searches within a fixed reach.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <matstruct/types.h>

#include "base/index.h"

namespace matstruct {

/// Keeps a reference to the points. Cells are sorted by key, so that visits come in a fixed order.
class PointGrid {
 public:
  PointGrid(const std::vector<Vec3>& points, double cell) : points_(points), cell_(cell) {
    order_.resize(points.size());
    std::iota(order_.begin(), order_.end(), 0);
    for (const Vec3& p : points) keys_.push_back(key(p));
    std::stable_sort(order_.begin(), order_.end(), [&](Index a, Index b) { return keys_[uz(a)] < keys_[uz(b)]; });
    for (std::size_t k = 0; k < order_.size(); ++k) sorted_.push_back(keys_[uz(order_[k])]);
  }

  /// Calls visit(id) for every point within `reach` of x.
  template <class Visit>
  void for_each_near(const Vec3& x, double reach, Visit visit) const {
    const Vec3 r{reach, reach, reach};
    for_each_in_box(x - r, x + r, [&](Index k) {
      if (distance2(points_[uz(k)], x) <= reach * reach) visit(k);
    });
  }

  /// Calls visit(id) for every point in the cells that meet the box.
  template <class Visit>
  void for_each_in_box(const Vec3& low, const Vec3& high, Visit visit) const {
    const Key a = key(low), b = key(high);
    for (std::int64_t i = a[0]; i <= b[0]; ++i)
      for (std::int64_t j = a[1]; j <= b[1]; ++j) {
        const auto first = std::lower_bound(sorted_.begin(), sorted_.end(), Key{i, j, a[2]});
        for (auto k = first; k != sorted_.end() && *k <= Key{i, j, b[2]}; ++k)
          visit(order_[static_cast<std::size_t>(k - sorted_.begin())]);
      }
  }

 private:
  using Key = std::array<std::int64_t, 3>;
  Key key(const Vec3& p) const {
    const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / cell_)); };
    return {cell(p.x), cell(p.y), cell(p.z)};
  }

  const std::vector<Vec3>& points_;
  double cell_;
  std::vector<Index> order_;
  std::vector<Key> keys_, sorted_;
};

}  // namespace matstruct
