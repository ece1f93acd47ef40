// A point outside the power cell of s is cut off from it by one of the cell's facets, and the sphere beyond that facet
// is nearer: a walk to nearer neighbours ends at the nearest sphere of all.
#include "spheres/power_owners.h"

#include <limits>

#include "base/index.h"
#include "base/parallel.h"

namespace matstruct {

namespace {

constexpr Index kGrain = 1024;

double power_distance(const Vec3& x, const WeightedPoint& s) {
  return distance2(x, s.center) - s.weight;
}

Index nearest_of_all(const Vec3& x, std::span<const WeightedPoint> spheres) {
  Index best = kInvalid;
  double least = std::numeric_limits<double>::infinity();
  for (Index s = 0; s < count(spheres); ++s)
    if (const double d = power_distance(x, spheres[uz(s)]); d < least) least = d, best = s;
  return best;
}

Index walk(const Vec3& x, std::span<const WeightedPoint> spheres, const SphereNeighbors& neighbors, Index from) {
  double least = power_distance(x, spheres[uz(from)]);
  for (bool moved = true; moved;) {
    moved = false;
    const Index here = from;
    for (Index k = neighbors.start[uz(here)]; k < neighbors.start[uz(here) + 1]; ++k) {
      const Index next = neighbors.list[uz(k)];
      const double d = power_distance(x, spheres[uz(next)]);
      if (d < least) least = d, from = next, moved = true;
    }
  }
  return from;
}

}  // namespace

void update_owners(std::span<const Vec3> points, std::span<const WeightedPoint> spheres,
                   const SphereNeighbors& neighbors, const Context& context, std::vector<Index>& owners) {
  const auto visible = [&](Index s) {
    return s >= 0 && s + 1 < count(neighbors.start) && neighbors.start[uz(s)] < neighbors.start[uz(s) + 1];
  };
  Index any = 0;
  while (any < count(spheres) && !visible(any)) ++any;
  const bool alone = any == count(spheres);  // one visible sphere at most, or none that the triangulation knows
  owners.resize(points.size(), kInvalid);
  parallel_for(context, count(points), kGrain, [&](Index begin, Index end) {
    Index last = any;
    for (Index k = begin; k < end; ++k) {
      const Vec3& x = points[uz(k)];
      Index& owner = owners[uz(k)];
      owner = alone ? nearest_of_all(x, spheres) : walk(x, spheres, neighbors, visible(owner) ? owner : last);
      last = owner;
    }
  });
}

}  // namespace matstruct
