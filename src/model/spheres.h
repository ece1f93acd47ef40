// The medial spheres of a computation. Ids are positions and never change; removed spheres stay as dead entries.
#pragma once

#include <vector>

#include <matstruct/types.h>

#include "geometry/power_predicates.h"

namespace matstruct {

/// A sphere to be added, and where it comes from. Internal units (Domain).
struct SphereSeed {
  Vec3 center;
  double radius = 0;
  SphereType type = SphereType::kSheet;
  Index line = kInvalid;    ///< feature line of a kSharpEdge sphere or a guard
  Index corner = kInvalid;  ///< surface vertex of a kCorner sphere
  double position = 0;      ///< along `line`: k + t is at parameter t of the line's k-th edge; along `seam` likewise
  double reach = 0;         ///< the weight in the power diagram is radius^2 + reach^2
  Index seam = kInvalid;    ///< curve of the seam network (spheres/seams.h) that it lies on
  Index node = kInvalid;    ///< node of that network that it is
  bool guard = false;       ///< helper on a concave line, no medial sphere (spheres/guards.h)
};

struct Spheres {
  std::vector<SphereSeed> seeds;  ///< by id
  std::vector<bool> alive;        ///< #seeds

  Index add(const SphereSeed& seed) {
    seeds.push_back(seed);
    alive.push_back(true);
    return static_cast<Index>(seeds.size()) - 1;
  }
};

inline std::vector<Index> dead_ids(const Spheres& spheres) {
  std::vector<Index> dead;
  for (std::size_t s = 0; s < spheres.alive.size(); ++s)
    if (!spheres.alive[s]) dead.push_back(static_cast<Index>(s));
  return dead;
}

/// Weighted points of all spheres, dead ones included, so that ids agree.
inline std::vector<WeightedPoint> weighted_points(const Spheres& spheres) {
  std::vector<WeightedPoint> points;
  points.reserve(spheres.seeds.size());
  for (const SphereSeed& s : spheres.seeds) points.push_back({s.center, s.radius * s.radius + s.reach * s.reach});
  return points;
}

}  // namespace matstruct
