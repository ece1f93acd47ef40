// Finds points by their coordinates.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include <matstruct/types.h>

#include "base/index.h"

namespace matstruct {

/// Of a fixed list of points, which must outlive this.
class PointIndex {
 public:
  PointIndex(const std::vector<Vec3>& points, double tolerance) : points_(points), tolerance_(tolerance) {
    order_.resize(points.size());
    std::iota(order_.begin(), order_.end(), 0);
    std::sort(order_.begin(), order_.end(), [&](Index a, Index b) { return x(a) != x(b) ? x(a) < x(b) : a < b; });
  }

  /// The nearest point within the tolerance, of equally near ones the least; kInvalid if there is none.
  Index find(const Vec3& p) const {
    auto it = std::lower_bound(order_.begin(), order_.end(), p.x - tolerance_,
                               [&](Index v, double value) { return x(v) < value; });
    Index best = kInvalid;
    double best2 = tolerance_ * tolerance_;
    for (; it != order_.end() && x(*it) <= p.x + tolerance_; ++it) {
      const double d2 = distance2(points_[uz(*it)], p);
      if (d2 > best2 || (d2 == best2 && best != kInvalid && best < *it)) continue;
      best = *it;
      best2 = d2;
    }
    return best;
  }

 private:
  double x(Index v) const { return points_[uz(v)].x; }

  const std::vector<Vec3>& points_;
  double tolerance_;
  std::vector<Index> order_;  // by x
};

}  // namespace matstruct
