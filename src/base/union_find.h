// Disjoint sets over 0..n-1 with path halving; the representative of a set is its least element.
#pragma once

#include <numeric>
#include <vector>

#include <matstruct/types.h>

namespace matstruct {

class UnionFind {
 public:
  explicit UnionFind(Index n) : parent_(static_cast<std::size_t>(n)) { std::iota(parent_.begin(), parent_.end(), 0); }

  Index find(Index a) {
    while (at(a) != a) {
      at(a) = at(at(a));
      a = at(a);
    }
    return a;
  }
  /// Merges the two sets; false if they were one already.
  bool unite(Index a, Index b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    if (a < b)
      at(b) = a;
    else
      at(a) = b;
    return true;
  }

 private:
  Index& at(Index a) { return parent_[static_cast<std::size_t>(a)]; }
  std::vector<Index> parent_;
};

}  // namespace matstruct
