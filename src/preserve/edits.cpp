#include "preserve/edits.h"

#include "base/index.h"

namespace matstruct {

void leave_out_copies(const Spheres& spheres, double spacing, Edits& edits) {
  constexpr double kCopy = 0.01;  // in spacings
  const double near = kCopy * spacing;
  std::erase_if(edits.insert, [&](const SphereSeed& proposed) {
    for (std::size_t s = 0; s < spheres.seeds.size(); ++s)
      if (spheres.alive[s] && !spheres.seeds[s].guard &&
          distance2(spheres.seeds[s].center, proposed.center) < near * near)
        return true;
    return false;
  });
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
