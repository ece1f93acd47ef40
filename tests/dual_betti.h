// The dual complex as a simplicial one, and its Betti numbers.
#pragma once

#include <map>

#include <matstruct/metrics.h>

#include "base/index.h"
#include "extract/dual.h"

namespace matstruct {

/// With vertices numbered from 0.
inline SimplicialComplex complex_of(const DualComplex& dual) {
  std::map<Index, Index> number;
  for (const Index v : dual.vertices) number.emplace(v, count(number));
  const auto renumbered = [&](auto simplices) {
    for (auto& simplex : simplices)
      for (Index& v : simplex) v = number.at(v);
    return simplices;
  };
  return {count(dual.vertices), renumbered(dual.edges), renumbered(dual.triangles), renumbered(dual.tets)};
}

inline Betti betti_of(const DualComplex& dual) {
  return betti_numbers(complex_of(dual));
}

}  // namespace matstruct
