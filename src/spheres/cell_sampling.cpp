// Hit-and-run (R. L. Smith 1984): from a point of a convex body take a random direction, and go to a random point of
// the chord. The points tend to the uniform distribution. A cell of the restricted diagram is a convex power cell
// without what is outside the solid: a point outside shortens the chord to its side (shrinkage of slice sampling, R. M.
// Neal 2003), and the next is drawn. Every second direction is that of the foot: cells are columns across the sheet,
// often thin ones, and random directions alone would stay on one side of it for long.
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

// Projections to find a first point of a cell, each by a little more than the way to the half-space.
constexpr int kMostProjections = 200;
constexpr double kOvershoot = 1.01;
// Points outside the solid on one chord after which another direction is taken.
constexpr int kMostTrials = 8;
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
  CellWalk(const Domain& domain, std::span<const WeightedPoint> spheres, const SphereNeighbors& neighbors, Index sphere)
      : domain_(domain), spheres_(spheres), own_(spheres[uz(sphere)]) {
    const auto begin = static_cast<std::size_t>(neighbors.start[uz(sphere)]);
    const auto end = static_cast<std::size_t>(neighbors.start[uz(sphere) + 1]);
    others_ = neighbors.list.subspan(begin, end - begin);
  }

  /// A point of the power cell: the sphere's centre, or where projections on the half-spaces that it violates, the
  /// worst one first, lead from there (S. Agmon 1954). Nothing if it is outside the solid or not found.
  std::optional<VolumeSample> start() const {
    Vec3 x = own_.center;
    for (int k = 0; k < kMostProjections; ++k) {
      Vec3 worst;  // the way to the half-space farthest from x
      for (const Index other : others_) {
        const Vec3 normal = 2 * (own_.center - spheres_[uz(other)].center);
        if (const double e = excess(x, other); e < 0 && e * e > norm2(worst) * norm2(normal))
          worst = normal * (-e / norm2(normal));
      }
      if (worst == Vec3{}) break;
      x += worst * kOvershoot;
    }
    for (const Index other : others_)
      if (excess(x, other) < 0) return std::nullopt;
    if (!domain_.query.inside(x)) return std::nullopt;
    return project_sample(domain_, x, kInvalid);
  }

  /// The next point after one of the cell, on a line in direction d; the same one if the walk is stuck.
  VolumeSample step(const VolumeSample& from, const Vec3& d, KeyedRandom& random) const {
    auto [low, high] = chord(from.point, d);
    for (int trial = 0; trial < kMostTrials; ++trial) {
      const double t = low + (high - low) * random.uniform();
      const VolumeSample next = project_sample(domain_, from.point + t * d, from.triangle);
      if (domain_.query.signed_distance(next.point, next.triangle) < 0) return next;
      (t < 0 ? low : high) = t;
    }
    return from;
  }

 private:
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
      const CellWalk walk(domain, spheres, neighbors, s);
      std::optional<VolumeSample> first = walk.start();
      if (!first && h.last != kInvalid) first = samples.samples[uz(h.last)];
      if (!first) continue;
      VolumeSample at = *first;
      KeyedRandom random(options.seed, kStage, static_cast<std::uint64_t>(s));
      for (Index k = 0; k < options.least; ++k) {
        at = walk.step(walk.step(at, random_direction(random), random), at.normal, random);
        at.weight = h.samples > 0 ? h.weight / h.samples : 1;
        added[uz(s)].push_back(at);
      }
    }
  });
  for (Index s = 0; s < n; ++s)
    for (const VolumeSample& sample : added[uz(s)]) {
      samples.samples.push_back(sample);
      owners.push_back(s);
    }
  if (count(samples.samples) > before) link_samples(domain, options.reach, context, samples);
  return count(samples.samples) - before;
}

}  // namespace matstruct
