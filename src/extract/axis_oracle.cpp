#include "extract/axis_oracle.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
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

namespace {

// The ball of two of the contacts that is nearest to the guess, among those that are empty.
std::optional<Ball> ball_of_pair(ContactFinder& finder, const Vec3& guess, const Contacts& contacts, double reach,
                                 double depth) {
  std::optional<Ball> best;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto ball = tangent_sphere(finder, guess, {contacts[i], contacts[j]}, reach);
      if (!ball || (best && distance(ball->center, guess) >= distance(best->center, guess))) continue;
      if (is_medial(finder, *ball, depth)) best = Ball{ball->center, ball->radius};
    }
  return best;
}

}  // namespace

AxisOracle contact_oracle(FinderPool& finders, const std::vector<TangentSphere>& spheres, double target) {
  const Domain& domain = finders.domain();
  const double touch = tolerance::kSameDistance * domain.diagonal;
  AxisOracle oracle;
  oracle.distance = [&domain](const Vec3& x) { return std::sqrt(domain.query.closest(x).distance2); };
  oracle.on_sheet = [&finders, &spheres, target, touch](const Vec3& guess, Index near_vertex, Index) {
    return finders.with_one([&](ContactFinder& finder) {
      return ball_of_pair(finder, guess, spheres[uz(near_vertex)].contacts, target, touch);
    });
  };
  oracle.on_curve = [&finders, &spheres, target, touch](const Vec3& guess, const Edge& near) {
    return finders.with_one([&](ContactFinder& finder) -> std::optional<Ball> {
      const TangentSphere &a = spheres[uz(near[0])], &b = spheres[uz(near[1])];
      Contacts shared;
      for (const Contact& c : a.contacts) {
        const Contact there = finder.follow(c, guess);
        if (std::any_of(b.contacts.begin(), b.contacts.end(),
                        [&](const Contact& o) { return finder.same(finder.follow(o, guess), there); }))
          shared.push_back(there);
      }
      if (shared.size() < 3) return std::nullopt;
      const auto ball = tangent_sphere(finder, guess, shared, target);
      if (!ball || !is_medial(finder, *ball, touch)) return std::nullopt;
      return Ball{ball->center, ball->radius};
    });
  };
  return oracle;
}

}  // namespace matstruct
