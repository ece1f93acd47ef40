// An 8-wide bounding volume hierarchy over boxes: the shape that a search for nearest things walks through.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include <matstruct/types.h>

namespace matstruct {

/// Axis-aligned box; empty as constructed.
struct Box {
  static constexpr double kHuge = std::numeric_limits<double>::infinity();
  Vec3 lo{kHuge, kHuge, kHuge};
  Vec3 hi{-kHuge, -kHuge, -kHuge};

  void add(const Vec3& p) { lo = min(lo, p), hi = max(hi, p); }
  void add(const Box& b) { lo = min(lo, b.lo), hi = max(hi, b.hi); }
};

struct BoxTree {
  static constexpr int kWidth = 8;
  /// Bound of the stack of a depth-first walk that pushes all children of a node: see kMaxSahDepth in box_tree.cpp.
  static constexpr int kMaxStack = 512;

  /// Children's boxes coordinate by coordinate, so that one loop tests all eight. Slots from `children` on are unused.
  struct alignas(64) Node {
    std::array<std::array<double, kWidth>, 3> lo, hi;
    std::array<Index, kWidth> child;  ///< a node, or the complement (~) of a leaf
    Index children = 0;
  };
  /// A run of `order`.
  struct Leaf {
    Index first = 0, size = 0;
  };

  std::vector<Node> nodes;   ///< node 0 is the root; empty only if there are no boxes
  std::vector<Leaf> leaves;  ///< each of 1 to leaf_size boxes
  std::vector<Index> order;  ///< #boxes, box ids, leaf by leaf
};

/// Builds the tree top-down by the surface area heuristic (Wald 2007), counting a leaf's cost as one whatever it holds,
/// which fills the leaves. Deterministic; O(n log n). Boxes may coincide or be flat.
BoxTree build_box_tree(std::span<const Box> boxes, Index leaf_size);

}  // namespace matstruct
