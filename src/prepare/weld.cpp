#include "prepare/weld.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "base/index.h"

namespace matstruct {

std::vector<Index> weld_equal(const std::vector<Vec3>& points) {
  const auto key = [&](Index i) {
    const Vec3& p = points[uz(i)];
    return std::tie(p.x, p.y, p.z);
  };
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    if (key(a) != key(b)) return key(a) < key(b);
    return a < b;
  });
  std::vector<Index> first(points.size());
  Index representative = kInvalid;
  for (const Index i : order) {
    if (representative == kInvalid || key(i) != key(representative)) representative = i;
    first[uz(i)] = representative;
  }
  return first;
}

}  // namespace matstruct
