// Top-down construction with the surface area heuristic: binned for large sets (Wald, "On fast construction of
// SAH-based bounding volume hierarchies", 2007), an exact sweep for small ones. A wide node is made by splitting the
// largest of its ranges until there are eight.
#include "query/box_tree.h"

#include <algorithm>
#include <limits>

#include "base/index.h"

namespace matstruct {
namespace {

constexpr Index kBins = 16;
constexpr Index kSweepSize = 64;  // sets up to this size get the exact sweep
// Levels after which sets are halved instead, so that no input makes a tree deeper than this + 31 levels, and so that a
// walk never stacks more than 7 * (24 + 31) + 8 entries.
constexpr int kMaxSahDepth = 24;
static_assert((BoxTree::kWidth - 1) * (kMaxSahDepth + 31) + BoxTree::kWidth <= BoxTree::kMaxStack);

double half_area(const Box& b) {
  const Vec3 d = b.hi - b.lo;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

/// A run of the order array and its box.
struct Range {
  Index begin = 0, end = 0;
  Box box;
  Index size() const { return end - begin; }
};

class Builder {
 public:
  Builder(std::span<const Box> boxes, Index leaf_size) : boxes_(boxes), leaf_size_(leaf_size) {
    tree_.order.resize(boxes.size());
    centers_.resize(boxes.size());
    for (Index i = 0; i < count(boxes); ++i) {
      tree_.order[uz(i)] = i;
      centers_[uz(i)] = (boxes[uz(i)].lo + boxes[uz(i)].hi) * 0.5;
    }
  }

  BoxTree build() {
    if (!boxes_.empty()) add_node(range_of(0, count(boxes_)), 0);
    return std::move(tree_);
  }

 private:
  Range range_of(Index begin, Index end) const {
    Range range{begin, end, {}};
    for (Index i = begin; i < end; ++i) range.box.add(boxes_[uz(tree_.order[uz(i)])]);
    return range;
  }
  double leaf_count(Index boxes) const { return (boxes + leaf_size_ - 1) / leaf_size_; }

  Index add_node(const Range& whole, int depth) {
    const Index id = count(tree_.nodes);
    tree_.nodes.emplace_back();
    const std::vector<Range> parts = divide(whole, depth);
    for (Index k = 0; k < count(parts); ++k) {
      const Range& part = parts[uz(k)];
      const Index child = part.size() <= leaf_size_ ? ~add_leaf(part) : add_node(part, depth + 1);
      BoxTree::Node& node = tree_.nodes[uz(id)];
      node.child[uz(k)] = child;
      for (int axis = 0; axis < 3; ++axis) {
        node.lo[uz(axis)][uz(k)] = part.box.lo[axis];
        node.hi[uz(axis)][uz(k)] = part.box.hi[axis];
      }
    }
    tree_.nodes[uz(id)].children = count(parts);
    return id;
  }

  Index add_leaf(const Range& part) {
    tree_.leaves.push_back({part.begin, part.size()});
    return count(tree_.leaves) - 1;
  }

  /// Up to eight ranges: the largest one that is no leaf is split until there are enough.
  std::vector<Range> divide(const Range& whole, int depth) {
    std::vector<Range> parts{whole};
    while (parts.size() < BoxTree::kWidth) {
      Index largest = kInvalid;
      double largest_area = -1;
      for (Index k = 0; k < count(parts); ++k) {
        const double area = half_area(parts[uz(k)].box);
        if (parts[uz(k)].size() > leaf_size_ && area > largest_area) largest = k, largest_area = area;
      }
      if (largest == kInvalid) break;
      const Range part = parts[uz(largest)];
      const Index middle = split(part, depth);
      parts[uz(largest)] = range_of(part.begin, middle);
      parts.push_back(range_of(middle, part.end));
    }
    return parts;
  }

  /// Reorders a range and returns where its second part begins; both parts are non-empty.
  Index split(const Range& range, int depth) {
    if (depth >= kMaxSahDepth) return split_at(range, longest_axis(range), range.size() / 2);
    return range.size() <= kSweepSize ? split_by_sweep(range) : split_by_bins(range);
  }

  int longest_axis(const Range& range) const {
    const Vec3 d = range.box.hi - range.box.lo;
    return d.x >= d.y && d.x >= d.z ? 0 : (d.y >= d.z ? 1 : 2);
  }

  void sort_along(const Range& range, int axis) {
    std::sort(tree_.order.begin() + range.begin, tree_.order.begin() + range.end, [&](Index a, Index b) {
      const double ca = centers_[uz(a)][axis], cb = centers_[uz(b)][axis];
      return ca != cb ? ca < cb : a < b;
    });
  }

  Index split_at(const Range& range, int axis, Index left_size) {
    sort_along(range, axis);
    return range.begin + left_size;
  }

  Index split_by_sweep(const Range& range) {
    const Index n = range.size();
    double best = Box::kHuge;
    int best_axis = 0;
    Index best_left = n / 2;
    std::array<double, kSweepSize> right_cost{};
    for (int axis = 0; axis < 3; ++axis) {
      sort_along(range, axis);
      Box box;
      for (Index i = n - 1; i > 0; --i) {
        box.add(boxes_[uz(tree_.order[uz(range.begin + i)])]);
        right_cost[uz(i)] = half_area(box) * leaf_count(n - i);
      }
      box = {};
      for (Index i = 1; i < n; ++i) {
        box.add(boxes_[uz(tree_.order[uz(range.begin + i - 1)])]);
        const double cost = half_area(box) * leaf_count(i) + right_cost[uz(i)];
        if (cost < best) best = cost, best_axis = axis, best_left = i;
      }
    }
    return split_at(range, best_axis, best_left);
  }

  struct Bin {
    Box box;
    Index size = 0;
  };

  Index split_by_bins(const Range& range) {
    Box span;
    for (Index i = range.begin; i < range.end; ++i) span.add(centers_[uz(tree_.order[uz(i)])]);
    double best = Box::kHuge;
    int best_axis = 0;
    Index best_bin = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(span.hi[axis] > span.lo[axis])) continue;
      const auto [cost, bin] = best_bin_of(range, span, axis);
      if (cost < best) best = cost, best_axis = axis, best_bin = bin;
    }
    if (best == Box::kHuge) return split_at(range, 0, range.size() / 2);
    const auto middle = std::partition(tree_.order.begin() + range.begin, tree_.order.begin() + range.end,
                                       [&](Index i) { return bin_of(i, span, best_axis) < best_bin; });
    return static_cast<Index>(middle - tree_.order.begin());
  }

  Index bin_of(Index i, const Box& span, int axis) const {
    const double t = (centers_[uz(i)][axis] - span.lo[axis]) / (span.hi[axis] - span.lo[axis]);
    return std::min(kBins - 1, static_cast<Index>(t * kBins));
  }

  /// Least cost, and the first bin of the right part; the cost is infinite if no bin border separates the set.
  std::pair<double, Index> best_bin_of(const Range& range, const Box& span, int axis) const {
    std::array<Bin, kBins> bins;
    for (Index i = range.begin; i < range.end; ++i) {
      const Index id = tree_.order[uz(i)];
      Bin& bin = bins[uz(bin_of(id, span, axis))];
      bin.box.add(boxes_[uz(id)]);
      ++bin.size;
    }
    std::array<double, kBins> right_cost{};
    Bin sum;
    for (Index b = kBins - 1; b > 0; --b) {
      sum.box.add(bins[uz(b)].box);
      sum.size += bins[uz(b)].size;
      right_cost[uz(b)] = sum.size > 0 ? half_area(sum.box) * leaf_count(sum.size) : Box::kHuge;
    }
    sum = {};
    std::pair<double, Index> best{Box::kHuge, 0};
    for (Index b = 1; b < kBins; ++b) {
      sum.box.add(bins[uz(b - 1)].box);
      sum.size += bins[uz(b - 1)].size;
      if (sum.size == 0) continue;
      best = std::min(best, {half_area(sum.box) * leaf_count(sum.size) + right_cost[uz(b)], b});
    }
    return best;
  }

  std::span<const Box> boxes_;
  Index leaf_size_;
  std::vector<Vec3> centers_;
  BoxTree tree_;
};

}  // namespace

BoxTree build_box_tree(std::span<const Box> boxes, Index leaf_size) {
  return Builder(boxes, leaf_size).build();
}

}  // namespace matstruct
