// Distances of many points to the primitives of a tree. The signed distance to a primitive changes at most as much as
// one moves: of the primitives, only those that are near enough to the middle of a group of points can be the nearest
// of one of them. So the groups are halved, and with them the lists of candidates.
#include <algorithm>
#include <limits>
#include <numeric>

#include "base/index.h"
#include "base/parallel.h"
#include "base/tolerances.h"
#include "metrics/medial_tree.h"

namespace matstruct {

namespace {

/// Points that start with a search of the tree together, and that are no longer halved.
constexpr std::size_t kGroup = 2048, kLeaf = 32;

struct Candidate {
  double distance;
  Index primitive;
};

struct Extent {
  Vec3 center;
  double reach;  ///< no point is further from the centre
  int axis;      ///< the longest
};

Extent extent_of(const std::vector<Vec3>& points, std::span<const Index> ids) {
  Vec3 low = points[uz(ids.front())], high = low;
  for (const Index p : ids) {
    low = min(low, points[uz(p)]);
    high = max(high, points[uz(p)]);
  }
  const Vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  return {(low + high) / 2, norm(size) / 2, axis};
}

/// Puts the lesser half along the axis first.
std::size_t halve(const std::vector<Vec3>& points, std::span<Index> ids, int axis) {
  const std::size_t middle = ids.size() / 2;
  std::nth_element(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(middle), ids.end(), [&](Index p, Index q) {
    const double a = points[uz(p)][axis], b = points[uz(q)][axis];
    return a < b || (a == b && p < q);
  });
  return middle;
}

void add_groups(const std::vector<Vec3>& points, std::span<Index> ids, std::vector<std::span<Index>>& groups) {
  if (ids.size() <= kGroup) {
    if (!ids.empty()) groups.push_back(ids);
    return;
  }
  const std::size_t middle = halve(points, ids, extent_of(points, ids).axis);
  add_groups(points, ids.first(middle), groups);
  add_groups(points, ids.subspan(middle), groups);
}

}  // namespace

std::vector<double> MedialTree::distances(const std::vector<Vec3>& points, const Context& context) const {
  std::vector<double> result(points.size(), std::numeric_limits<double>::infinity());
  std::vector<Index> ids(points.size());
  std::iota(ids.begin(), ids.end(), 0);
  std::vector<std::span<Index>> groups;
  add_groups(points, ids, groups);
  parallel_for(context, count(groups), 1, [&](Index begin, Index end) {
    for (Index g = begin; g < end; ++g) {
      const Extent extent = extent_of(points, groups[uz(g)]);
      const double bound = closest(extent.center).distance + 2 * extent.reach;
      std::vector<Index> candidates;
      traverse(extent.center, bound, [&](const Primitive& p) {
        if (lower_bound(p, extent.center) < bound) candidates.push_back(static_cast<Index>(&p - primitives_.data()));
        return true;
      });
      share(points, groups[uz(g)], candidates, result);
    }
  });
  return result;
}

void MedialTree::share(const std::vector<Vec3>& points, std::span<Index> ids, const std::vector<Index>& candidates,
                       std::vector<double>& result) const {
  const Extent extent = extent_of(points, ids);
  // The list begins with those that were nearest to the middle of a larger group, and so probably near here too.
  double least = std::numeric_limits<double>::infinity();
  std::vector<Candidate> near;
  for (const Index c : candidates) {
    const Primitive& primitive = primitives_[uz(c)];
    if (lower_bound(primitive, extent.center) > least + 2 * extent.reach) continue;
    near.push_back({hit(primitive, extent.center).distance, c});
    least = std::min(least, near.back().distance);
  }
  std::erase_if(near, [&](const Candidate& c) { return c.distance > least + 2 * extent.reach; });
  std::sort(near.begin(), near.end(), [](const Candidate& a, const Candidate& b) {
    return a.distance < b.distance || (a.distance == b.distance && a.primitive < b.primitive);
  });
  if (ids.size() > kLeaf && near.size() > 1) {
    std::vector<Index> nearer;
    for (const Candidate& candidate : near) nearer.push_back(candidate.primitive);
    const std::size_t middle = halve(points, ids, extent.axis);
    share(points, ids.first(middle), nearer, result);
    share(points, ids.subspan(middle), nearer, result);
    return;
  }
  for (const Index p : ids) {
    const Vec3& x = points[uz(p)];
    const double moved = norm(x - extent.center) * tolerance::kPruneSlack;
    double& best = result[uz(p)];
    for (const Candidate& candidate : near) {
      if (candidate.distance - moved > best) break;
      const Primitive& primitive = primitives_[uz(candidate.primitive)];
      if (lower_bound(primitive, x) < best) best = std::min(best, hit(primitive, x).distance);
    }
  }
}

}  // namespace matstruct
