#include "preserve/edits.h"

#include "base/index.h"

namespace matstruct {

std::vector<Index> spheres_near(const Spheres& spheres, const Vec3& center, double near) {
  std::vector<Index> found;
  for (Index s = 0; s < count(spheres.seeds); ++s)
    if (spheres.alive[uz(s)] && !spheres.seeds[uz(s)].guard &&
        distance2(spheres.seeds[uz(s)].center, center) < near * near)
      found.push_back(s);
  return found;
}

AppliedEdits apply_edits(Spheres& spheres, const Edits& edits, double closest) {
  AppliedEdits applied;
  for (const Index s : edits.remove) {
    if (!spheres.alive[uz(s)]) continue;
    spheres.alive[uz(s)] = false;
    applied.removed.push_back(s);
  }
  for (const SphereSeed& seed : edits.insert) {
    const bool crowded = std::any_of(applied.inserted.begin(), applied.inserted.end(), [&](Index s) {
      const SphereSeed& other = spheres.seeds[uz(s)];
      return other.line == seed.line && distance2(other.center, seed.center) < closest * closest;
    });
    if (!crowded) applied.inserted.push_back(spheres.add(seed));
  }
  return applied;
}

}  // namespace matstruct
