// Array access with 32-bit ids without a cast at every use.
#pragma once

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

}  // namespace matstruct
