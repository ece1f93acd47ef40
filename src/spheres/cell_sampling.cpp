// Hit-and-run (R. L. Smith 1984): from a point of a convex body take a random direction, and go to a random point of
// the chord. The points tend to the uniform distribution. A cell of the restricted diagram is a convex power cell
// without what is outside the solid: a point outside shortens the chord to its side (shrinkage of slice sampling, R. M.
// Neal 2003), and the next is drawn. Cells are columns across the sheet, up to a hundred times as long as wide, and in
// directions that are random in space the walk would stay on one side for long. So most directions are those between
// two points walked before (C. ter Braak 2006): they are spread as the cell is, long where it is long.
#include "spheres/cell_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "base/index.h"
#include "base/parallel.h"
#include "base/random.h"

namespace matstruct {

namespace {

// Projections to find a first point of a cell. Where half-spaces leave a narrow cell, steps that just reach them come
// nearer and nearer and never arrive.
constexpr int kMostProjections = 200;
constexpr double kOvershoot = 1.5;
// Points outside the solid on one chord after which another direction is taken.
constexpr int kMostTrials = 8;
// Steps before the first sample, in which the walk gets to know the cell, and from one sample to the next.
constexpr int kFirstSteps = 256, kSteps = 4;
// Every so many steps the direction is random in space: those between points of a plane stay in it.
constexpr int kSpaceSteps = 4;
constexpr Index kGrain = 16;
constexpr std::uint64_t kStage = 0x63656c6c;

Vec3 random_direction(KeyedRandom& random) {
  const double z = 2 * random.uniform() - 1, angle = 2 * std::numbers::pi * random.uniform();
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// What a cell holds already.
struct Held {
  Index samples = 0;
  Index last = kInvalid;  // one of them
  double weight = 0;      // of them all
};

class CellWalk {
 public:
  CellWalk(const Domain& domain, std::span<const WeightedPoint> spheres, const SphereNeighbors& neighbors, Index sphere,
           std::uint64_t seed)
      : domain_(domain),
        spheres_(spheres),
        own_(spheres[uz(sphere)]),
        random_(seed, kStage, static_cast<std::uint64_t>(sphere)) {
    const auto begin = static_cast<std::size_t>(neighbors.start[uz(sphere)]);
    const auto end = static_cast<std::size_t>(neighbors.start[uz(sphere) + 1]);
    others_ = neighbors.list.subspan(begin, end - begin);
  }

  /// Starts at a point of the cell: where projections of the sphere's centre lead, or at `known`, if any, if they lead
  /// nowhere. False if there is neither.
  bool start(const Vec3* known) {
    std::optional<Vec3> first = projected_center();
    if (!first && known) first = *known;
    if (!first) return false;
    at_ = *first;
    walk(kFirstSteps);
    return true;
  }

  VolumeSample next() {
    walk(kSteps);
    const VolumeSample sample = project_sample(domain_, at_, near_);
    near_ = sample.triangle;
    return sample;
  }

 private:
  /// Projections on the half-spaces that the point violates, the worst one first (S. Agmon 1954), and on the surface.
  std::optional<Vec3> projected_center() const {
    Vec3 x = own_.center;
    for (int k = 0; k < kMostProjections; ++k) {
      Vec3 way = way_to_cell(x);
      if (way == Vec3{}) {
        if (domain_.query.inside(x)) return x;
        way = domain_.query.closest(x).point - x;
      }
      x += way * kOvershoot;
    }
    return std::nullopt;
  }
  /// The way to the half-space farthest from x; zero in the power cell.
  Vec3 way_to_cell(const Vec3& x) const {
    Vec3 worst;
    for (const Index other : others_) {
      const Vec3 normal = 2 * (own_.center - spheres_[uz(other)].center);
      if (const double e = excess(x, other); e < 0 && e * e > norm2(worst) * norm2(normal))
        worst = normal * (-e / norm2(normal));
    }
    return worst;
  }

  void walk(int steps) {
    for (int k = 0; k < steps; ++k) {
      step(k % kSpaceSteps == 0 ? random_direction(random_) : walked_direction());
      walked_.push_back(at_);
    }
  }
  /// To a point on the line through the present one, which stays if the solid is hard to hit.
  void step(const Vec3& direction) {
    auto [low, high] = chord(at_, direction);
    for (int trial = 0; trial < kMostTrials; ++trial) {
      const double t = low + (high - low) * random_.uniform();
      const Vec3 x = at_ + t * direction;
      if (inside(x)) {
        at_ = x;
        return;
      }
      (t < 0 ? low : high) = t;
    }
  }
  /// Between two points walked, not of the first half: those may be near the start.
  Vec3 walked_direction() {
    const std::size_t skipped = walked_.size() / 2;
    const auto any = [&] {
      return walked_[skipped +
                     static_cast<std::size_t>(random_.uniform() * static_cast<double>(walked_.size() - skipped))];
    };
    const Vec3 first = any(), between = any() - first;
    return between == Vec3{} ? random_direction(random_) : normalized(between);
  }
  /// Most steps stay in a ball that is known to be inside.
  bool inside(const Vec3& x) {
    if (distance2(x, ball_center_) < ball_radius_ * ball_radius_) return true;
    const double d = domain_.query.signed_distance(x, near_);
    if (d < 0) ball_center_ = x, ball_radius_ = -d;
    return d < 0;
  }
  double excess(const Vec3& x, Index other) const {
    const WeightedPoint& s = spheres_[uz(other)];
    return distance2(x, s.center) - s.weight - distance2(x, own_.center) + own_.weight;
  }
  /// Parameters between which x + t d is in the power cell, not farther than the solid is wide.
  std::pair<double, double> chord(const Vec3& x, const Vec3& d) const {
    double low = -domain_.diagonal, high = domain_.diagonal;
    for (const Index other : others_) {
      const double slope = 2 * dot(d, own_.center - spheres_[uz(other)].center);
      if (slope == 0) continue;
      const double t = -excess(x, other) / slope;  // the excess falls along a negative slope
      if (slope < 0)
        high = std::min(high, std::max(0.0, t));
      else
        low = std::max(low, std::min(0.0, t));
    }
    return {low, high};
  }

  const Domain& domain_;
  std::span<const WeightedPoint> spheres_;
  const WeightedPoint& own_;
  std::span<const Index> others_;
  KeyedRandom random_;
  Vec3 at_;
  std::vector<Vec3> walked_;
  Index near_ = kInvalid;  // triangle near the way
  Vec3 ball_center_;       // inside the solid, of the last query
  double ball_radius_ = 0;
};

}  // namespace

Index add_cell_samples(const Domain& domain, std::span<const WeightedPoint> spheres, const SphereNeighbors& neighbors,
                       const std::vector<bool>& wanted, const CellSamplingOptions& options, const Context& context,
                       VolumeSamples& samples, std::vector<Index>& owners) {
  const Index n = count(spheres), before = count(samples.samples);
  std::vector<Held> held(uz(n));
  for (Index k = 0; k < before; ++k) {
    Held& h = held[uz(owners[uz(k)])];
    ++h.samples, h.last = k, h.weight += samples.samples[uz(k)].weight;
  }
  std::vector<std::vector<VolumeSample>> added(uz(n));
  parallel_for(context, n, kGrain, [&](Index begin, Index end) {
    for (Index s = begin; s < end; ++s) {
      const Held& h = held[uz(s)];
      if (!wanted[uz(s)] || h.samples >= options.least || neighbors.start[uz(s)] == neighbors.start[uz(s) + 1])
        continue;
      CellWalk walk(domain, spheres, neighbors, s, options.seed);
      if (!walk.start(h.last == kInvalid ? nullptr : &samples.samples[uz(h.last)].point)) continue;
      for (Index k = 0; k < options.least; ++k) {
        VolumeSample& sample = added[uz(s)].emplace_back(walk.next());
        sample.weight = h.samples > 0 ? h.weight / h.samples : 1;
      }
    }
  });
  for (Index s = 0; s < n; ++s)
    for (const VolumeSample& sample : added[uz(s)]) {
      samples.samples.push_back(sample);
      owners.push_back(s);
    }
  return count(samples.samples) - before;
}

}  // namespace matstruct
