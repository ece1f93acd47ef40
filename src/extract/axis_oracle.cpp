#include "extract/axis_oracle.h"

#include <cmath>

#include "base/tolerances.h"
#include "spheres/shrink.h"

namespace matstruct {

AxisOracle shrinking_oracle(const Domain& domain, double smooth_angle) {
  AxisOracle oracle;
  oracle.distance = [&domain](const Vec3& x) { return std::sqrt(domain.query.closest(x).distance2); };
  oracle.on_sheet = [&domain, smooth_angle](const Vec3& guess, Index, Index) -> std::optional<Ball> {
    const SurfaceHit foot = domain.query.closest(guess);
    if (foot.distance2 < std::pow(tolerance::kSmallestRadius * domain.diagonal, 2)) return std::nullopt;
    // The direction from the guess, not the triangle's normal: on a concave line it is one of the fan.
    const ShrunkSphere s =
        shrink_sphere(domain, {foot.point, normalized(foot.point - guess), foot.triangle}, smooth_angle);
    if (!s.converged) return std::nullopt;
    return Ball{s.center, s.radius};
  };
  return oracle;
}

}  // namespace matstruct
