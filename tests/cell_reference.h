// The paper's way to the contacts of cells, as a reference: sample every restricted power cell by volume, project every
// sample, cluster the feet. Noisy where a cell reaches over a seam by a hundredth of its volume: chance decides then,
// and two references that differ in their random numbers only do not agree.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/random.h"
#include "base/union_find.h"
#include "sampled_model.h"
#include "spheres/cell_contacts.h"
#include "spheres/contacts.h"
#include "spheres/point_grid.h"

namespace matstruct::reference {

inline constexpr int kCenterSamples = 200;  ///< around a sphere's centre
inline constexpr int kJudgeFactor = 10;     ///< samples in a cell in dispute, in those of the references
inline constexpr int kMostTries = 300;      ///< per sample
inline constexpr double kNear = 0.02;       ///< radius around a sphere's centre, in spacings

inline Vec3 random_in_tet(const Domain& domain, Index tet, KeyedRandom& random) {
  std::array<double, 3> cut{random.uniform(), random.uniform(), random.uniform()};
  std::sort(cut.begin(), cut.end());
  const std::array<double, 4> weights{cut[0], cut[1] - cut[0], cut[2] - cut[1], 1 - cut[2]};
  Vec3 x;
  for (std::size_t k = 0; k < 4; ++k) x += domain.solid.vertices[uz(domain.solid.tets[uz(tet)][k])] * weights[k];
  return x;
}

inline bool owns(const CellModel& model, Index sphere, const Vec3& x) {
  const auto& spheres = model.engine.spheres();
  const auto power = [&](Index s) { return distance2(x, spheres[uz(s)].center) - spheres[uz(s)].weight; };
  const double own = power(sphere);
  const auto [start, list] = model.neighbors();
  for (Index k = start[uz(sphere)]; k < start[uz(sphere) + 1]; ++k)
    if (power(list[uz(k)]) < own) return false;
  return true;
}

/// Uniform samples of one cell, by rejection from the tets of its pieces.
inline std::vector<VolumeSample> sample_cell(const CellModel& model, Index sphere, const std::vector<RpdCell>& pieces,
                                             int wanted, std::uint64_t seed) {
  std::vector<VolumeSample> samples;
  double volume = 0;
  for (const RpdCell& piece : pieces) volume += piece.volume;
  KeyedRandom random(seed, 77, static_cast<std::uint64_t>(sphere));
  for (int tries = 0; volume > 0 && count(samples) < wanted && tries < kMostTries * wanted;) {
    double share = random.uniform() * volume;
    std::size_t k = 0;
    while (k + 1 < pieces.size() && share >= pieces[k].volume) share -= pieces[k++].volume;
    for (bool found = false; !found && tries < kMostTries * wanted; ++tries) {
      const Vec3 x = random_in_tet(model.domain, pieces[k].tet, random);
      if (!owns(model, sphere, x)) continue;
      found = true;
      samples.push_back(project_sample(model.domain, x, kInvalid));
      samples.back().weight = 1;
    }
  }
  return samples;
}

/// Uniform samples of the solid within `radius` of a sphere's centre.
inline std::vector<VolumeSample> sample_near(const CellModel& model, Index sphere, double radius, int wanted,
                                             std::uint64_t seed) {
  std::vector<VolumeSample> samples;
  KeyedRandom random(seed, 78, static_cast<std::uint64_t>(sphere));
  const auto coordinate = [&] { return radius * (2 * random.uniform() - 1); };
  for (int tries = 0; count(samples) < wanted && tries < kMostTries * wanted; ++tries) {
    const Vec3 off{coordinate(), coordinate(), coordinate()}, x = model.spheres.seeds[uz(sphere)].center + off;
    if (norm(off) > radius || !model.domain.query.inside(x)) continue;
    samples.push_back(project_sample(model.domain, x, kInvalid));
    samples.back().weight = 1;
  }
  return samples;
}

/// Clusters the samples of one cell as cell_contacts() does with the links of link_samples().
class CellClusters {
 public:
  CellClusters(const CellModel& model, const std::vector<Index>& patches, double reach,
               std::vector<VolumeSample> samples)
      : samples_(std::move(samples)), sets_(count(samples_)) {
    std::vector<Index> all;
    for (VolumeSample& s : samples_) {
      s.patch = patches[uz(s.triangle)];
      all.push_back(count(all));
    }
    join_directions(samples_, all, ContactOptions{}.same_direction, sets_);
    join_feet(model.domain, reach);
  }

  Index order(const ContactOptions& options = {}) {
    std::map<Index, double> weights;  // of clusters
    double all = 0;
    for (Index k = 0; k < count(samples_); ++k) {
      weights[sets_.find(k)] += samples_[uz(k)].weight;
      all += samples_[uz(k)].weight;
    }
    return static_cast<Index>(std::count_if(weights.begin(), weights.end(), [&](const auto& cluster) {
      return cluster.second >= options.least_share * all;
    }));
  }

 private:
  /// Of two sets on one patch, some of whose feet are within reach of each other on the surface, makes one.
  void join_feet(const Domain& domain, double reach) {
    std::map<std::pair<Index, Index>, std::vector<Index>> held;  // by patch and set
    for (Index k = 0; k < count(samples_); ++k) held[{samples_[uz(k)].patch, sets_.find(k)}].push_back(k);
    for (auto one = held.begin(); one != held.end(); ++one) {
      std::vector<Vec3> feet;
      for (const Index k : one->second) feet.push_back(samples_[uz(k)].foot);
      const PointGrid grid(feet, reach);
      for (auto other = std::next(one); other != held.end() && other->first.first == one->first.first; ++other)
        if (sets_.find(one->second[0]) != sets_.find(other->second[0]) &&
            any_beside(domain, reach, other->second, one->second, grid))
          sets_.unite(one->second[0], other->second[0]);
    }
  }
  bool any_beside(const Domain& domain, double reach, const std::vector<Index>& of, const std::vector<Index>& others,
                  const PointGrid& grid_of_others) const {
    std::vector<Index> beside;
    for (const Index k : of) {
      bool found = false;
      beside.clear();
      grid_of_others.for_each_near(samples_[uz(k)].foot, reach, [&](Index o) {
        if (found) return;
        if (beside.empty()) triangles_beside(domain, samples_[uz(k)], reach, beside);
        found = std::binary_search(beside.begin(), beside.end(), samples_[uz(others[uz(o)])].triangle);
      });
      if (found) return true;
    }
    return false;
  }

  std::vector<VolumeSample> samples_;
  UnionFind sets_;
};

/// Contact orders of the spheres `wanted`, by the samples sample(sphere) of each.
template <class Sample>
std::vector<Index> orders_of(const CellModel& model, const std::vector<Index>& wanted, double reach, Sample sample,
                             const Context& context) {
  const std::vector<Index> patch_of = patches(model.domain);
  std::vector<Index> orders(wanted.size());
  parallel_for(context, count(wanted), 1, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k)
      orders[uz(k)] = CellClusters(model, patch_of, reach, sample(wanted[uz(k)])).order();
  });
  return orders;
}

/// By `per_cell` samples in each cell.
inline std::vector<Index> orders_of_cells(const CellModel& model, const std::vector<Index>& wanted, int per_cell,
                                          std::uint64_t seed, const Context& context) {
  std::vector<std::vector<RpdCell>> pieces(model.spheres.seeds.size());
  for (const RpdCell& cell : model.engine.diagram().cells) pieces[uz(cell.sphere)].push_back(cell);
  const auto sample = [&](Index s) { return sample_cell(model, s, pieces[uz(s)], per_cell, seed); };
  return orders_of(model, wanted, model.reach, sample, context);
}

/// By samples around the centres: the sub-volumes that meet there, whatever else the cell reaches.
inline std::vector<Index> orders_of_centers(const CellModel& model, const std::vector<Index>& wanted, double spacing,
                                            const Context& context) {
  const auto radius = [&](Index s) { return kNear * std::min(spacing, model.spheres.seeds[uz(s)].radius); };
  const auto sample = [&](Index s) { return sample_near(model, s, radius(s), kCenterSamples, 4); };
  return orders_of(model, wanted, kNear * spacing, sample, context);
}

/// By the model's own samples.
inline std::vector<Index> orders_of_samples(const SampledModel& model, const std::vector<Index>& wanted,
                                            const Context& context) {
  std::vector<std::vector<VolumeSample>> held(model.spheres.seeds.size());
  for (std::size_t k = 0; k < model.owners.size(); ++k) held[uz(model.owners[k])].push_back(model.samples.samples[k]);
  return orders_of(
      model, wanted, model.reach, [&](Index s) { return held[uz(s)]; }, context);
}

class Clock {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Numbers of spheres.
struct Agreement {
  Index compared = 0;          ///< whose cells do not miss the solid
  Index equal = 0;             ///< ours is the first reference's contact order
  Index references_equal = 0;  ///< two references have the same: what can be asked for
  Index equal_where_sure = 0;  ///< ours is what both references have
  Index disputed = 0;          ///< ours and the first reference differ; the judge says who is right
  Index ours_right = 0, reference_right = 0;
  double our_seconds = 0;        ///< to complete cells and cluster their samples
  double reference_seconds = 0;  ///< to sample cells and cluster, once
};

inline double percent(Index part, Index whole) {
  return whole == 0 ? 100 : 100.0 * part / whole;
}

/// `ours`: contact orders of the spheres `wanted`; the references have `per_cell` samples. `judge(spheres)`: orders of
/// those in dispute.
template <class Judge>
Agreement agreement(const CellModel& model, const std::vector<Index>& wanted, const std::vector<Index>& ours,
                    int per_cell, Judge judge, const Context& context) {
  Agreement result;
  const Clock clock;
  const std::vector<Index> first = orders_of_cells(model, wanted, per_cell, 1, context);
  result.reference_seconds = clock.seconds();
  const std::vector<Index> second = orders_of_cells(model, wanted, per_cell, 2, context);
  std::vector<std::size_t> places;  // of the disputed in `wanted`
  std::vector<Index> disputed;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    if (first[k] == 0) continue;
    const bool equal = ours[k] == first[k], sure = second[k] == first[k];
    ++result.compared;
    result.equal += equal;
    result.references_equal += sure;
    result.equal_where_sure += equal && sure;
    if (!equal) places.push_back(k), disputed.push_back(wanted[k]);
  }
  const std::vector<Index> judged = judge(disputed);
  result.disputed = count(disputed);
  for (std::size_t k = 0; k < places.size(); ++k) {
    result.ours_right += ours[places[k]] == judged[k];
    result.reference_right += first[places[k]] == judged[k];
  }
  return result;
}

/// At most `most` of the spheres, evenly chosen.
inline std::vector<Index> some_of(const std::vector<Index>& spheres, Index most) {
  const Index step = std::max<Index>(1, (count(spheres) + most - 1) / most);
  std::vector<Index> some;
  for (Index k = 0; k < count(spheres); k += step) some.push_back(spheres[uz(k)]);
  return some;
}

/// Of the fixed samples, with `per_cell` in a cell at least, for the sheets of the first spheres, no more than `most`
/// of them. Ten times as many samples of the cell judge.
inline Agreement agreement_of_samples(const Domain& domain, const Options& options, int per_cell, Index most,
                                      const Context& context) {
  SampledModel model(domain, options, context);
  const std::vector<Index> wanted = some_of(model.sheet_spheres(), most);
  const Clock clock;
  model.add_to_poor_cells(wanted, per_cell, context);
  const std::vector<Index> ours = orders_of_samples(model, wanted, context);
  const double our_seconds = clock.seconds();
  const auto judge = [&](const std::vector<Index>& disputed) {
    return orders_of_cells(model, disputed, kJudgeFactor * per_cell, 3, context);
  };
  Agreement result = agreement(model, wanted, ours, per_cell, judge, context);
  result.our_seconds = our_seconds;
  return result;
}

}  // namespace matstruct::reference
