// Which simplices hold which of their faces, as arrays.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "base/index.h"

namespace matstruct {

/// For each of a number of elements the simplices that list it, ascending.
class Incidence {
 public:
  /// `simplices` list elements below `size`, each at most once. O(size + simplices).
  template <std::size_t N>
  Incidence(std::size_t size, const std::vector<std::array<Index, N>>& simplices)
      : start_(size + 1, 0), ids_(N * simplices.size()) {
    for (const auto& simplex : simplices)
      for (const Index s : simplex) ++start_[uz(s) + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (Index id = 0; id < count(simplices); ++id)
      for (const Index s : simplices[uz(id)]) ids_[next[uz(s)]++] = id;
  }
  std::span<const Index> of(Index s) const { return {ids_.data() + start_[uz(s)], ids_.data() + start_[uz(s) + 1]}; }

 private:
  std::vector<std::size_t> start_;
  std::vector<Index> ids_;
};

/// #F x 3: of each face the ids of its edges, opposite its corners. Every one of them must be in the sorted `edges`.
inline std::vector<Triangle> edges_of_faces(const std::vector<Edge>& edges, const std::vector<Triangle>& faces) {
  const auto id = [&](Index a, Index b) {
    return static_cast<Index>(std::lower_bound(edges.begin(), edges.end(), Edge{a, b}) - edges.begin());
  };
  std::vector<Triangle> result;
  result.reserve(faces.size());
  for (const auto& [a, b, c] : faces) result.push_back({id(b, c), id(a, c), id(a, b)});
  return result;
}

}  // namespace matstruct
