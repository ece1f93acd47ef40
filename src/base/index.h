// Array access with 32-bit ids without a cast at every use, and edges as they are sorted and looked up.
#pragma once

#include <algorithm>
#include <cstddef>

#include <matstruct/types.h>

namespace matstruct {

constexpr std::size_t uz(Index i) {
  return static_cast<std::size_t>(i);
}
template <class Container>
constexpr Index count(const Container& c) {
  return static_cast<Index>(c.size());
}

/// The edge between two vertices, lower id first.
constexpr Edge ordered_edge(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace matstruct
