// Regular triangulation of medial spheres, kept up to date under insertion and removal; the candidates for clipping.
#pragma once

#include <memory>
#include <vector>

#include <matstruct/types.h>

#include "geometry/power_predicates.h"

namespace matstruct {

/// Wraps CGAL's regular triangulation. A sphere is hidden if its power cell in all of space is empty; of several
/// spheres with one centre all but the heaviest (the least id among equals) are hidden too.
class PowerTriangulation {
 public:
  PowerTriangulation();
  ~PowerTriangulation();
  PowerTriangulation(PowerTriangulation&&) noexcept;
  PowerTriangulation& operator=(PowerTriangulation&&) noexcept;

  /// Changes the set: removes ids `removed`, then inserts ids `inserted` (new ids, read from `spheres`). Spheres that
  /// were hidden only by a removed one appear again. Cost in proportion to the change (expected n log n
  /// for n new spheres), apart from neighbors().
  void update(const std::vector<WeightedPoint>& spheres, const std::vector<Index>& inserted,
              const std::vector<Index>& removed);

  /// Neighbours of each sphere in the triangulation, ascending, as CSR: those of s are
  /// list[start[s]] .. list[start[s + 1]]. Hidden and removed spheres have none.
  struct Neighbors {
    std::vector<Index> start, list;
  };
  const Neighbors& neighbors() const;
  /// Whether sphere s has a power cell. Size: number of ids known.
  const std::vector<bool>& visible() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace matstruct
