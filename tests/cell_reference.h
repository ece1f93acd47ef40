// The paper's way to the contacts of cells, as a reference: sample every restricted power cell by volume, project every
// sample, cluster the feet. Noisy where a cell reaches over a seam by a hundredth of its volume: chance decides then,
// and two references that differ in their random numbers only do not agree.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "base/parallel.h"
#include "base/random.h"
#include "sampled_model.h"

namespace matstruct::reference {

inline constexpr int kSamples = 200;        ///< per cell
inline constexpr int kJudgeSamples = 2000;  ///< per cell in dispute
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

/// Contacts of the spheres `wanted`, by the samples sample(sphere) of each.
template <class Sample>
CellContacts contacts_of(const CellModel& model, const std::vector<Index>& wanted, double reach, Sample sample,
                         const Context& context) {
  std::vector<std::vector<VolumeSample>> found(wanted.size());
  parallel_for(context, count(wanted), 8, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) found[uz(k)] = sample(wanted[uz(k)]);
  });
  VolumeSamples samples;
  std::vector<Index> owners;
  for (std::size_t k = 0; k < wanted.size(); ++k)
    for (const VolumeSample& s : found[k]) {
      samples.samples.push_back(s);
      owners.push_back(wanted[k]);
    }
  link_samples(model.domain, reach, context, samples);
  return cell_contacts(samples, owners, count(model.spheres.seeds), {});
}

/// Of the cells: `per_cell` samples in each.
inline CellContacts contacts_of_cells(const CellModel& model, const std::vector<Index>& wanted, int per_cell,
                                      std::uint64_t seed, const Context& context) {
  std::vector<std::vector<RpdCell>> pieces(model.spheres.seeds.size());
  for (const RpdCell& cell : model.engine.diagram().cells) pieces[uz(cell.sphere)].push_back(cell);
  const auto sample = [&](Index s) { return sample_cell(model, s, pieces[uz(s)], per_cell, seed); };
  return contacts_of(model, wanted, model.reach, sample, context);
}

/// Of the centres: the sub-volumes that meet there, whatever else the cell reaches.
inline CellContacts contacts_of_centers(const CellModel& model, const std::vector<Index>& wanted, double spacing,
                                        const Context& context) {
  const auto radius = [&](Index s) { return kNear * std::min(spacing, model.spheres.seeds[uz(s)].radius); };
  const auto sample = [&](Index s) { return sample_near(model, s, radius(s), kSamples, 4); };
  return contacts_of(model, wanted, kNear * spacing, sample, context);
}

/// Numbers of spheres.
struct Agreement {
  Index compared = 0;          ///< whose cells do not miss the solid
  Index equal = 0;             ///< ours is the first reference's contact order
  Index references_equal = 0;  ///< two references have the same: what can be asked for
  Index equal_where_sure = 0;  ///< ours is what both references have
  Index disputed = 0;          ///< ours and the first reference differ; the judge says who is right
  Index ours_right = 0, reference_right = 0;
};

inline double percent(Index part, Index whole) {
  return whole == 0 ? 100 : 100.0 * part / whole;
}

/// `ours`: contact orders, of all spheres; compared are those `wanted`. `judge(spheres)`: contacts of those in dispute.
template <class Judge>
Agreement agreement(const CellModel& model, const std::vector<Index>& wanted, const std::vector<Index>& ours,
                    Judge judge, const Context& context) {
  const CellContacts first = contacts_of_cells(model, wanted, kSamples, 1, context),
                     second = contacts_of_cells(model, wanted, kSamples, 2, context);
  Agreement result;
  std::vector<Index> disputed;
  for (const Index s : wanted) {
    const Index expected = contact_order(first, s);
    if (expected == 0) continue;
    const bool equal = ours[uz(s)] == expected, sure = contact_order(second, s) == expected;
    ++result.compared;
    result.equal += equal;
    result.references_equal += sure;
    result.equal_where_sure += equal && sure;
    if (!equal) disputed.push_back(s);
  }
  const CellContacts judged = judge(disputed);
  result.disputed = count(disputed);
  for (const Index s : disputed) {
    result.ours_right += ours[uz(s)] == contact_order(judged, s);
    result.reference_right += contact_order(first, s) == contact_order(judged, s);
  }
  return result;
}

/// Of the fixed samples, with as many in a cell at least as the reference has, for the first spheres' sheets. Many more
/// samples of the cell judge.
inline Agreement agreement_of_samples(const Domain& domain, const Options& options, const Context& context) {
  SampledModel model(domain, options, context);
  model.add_to_poor_cells(kSamples, context);
  const auto judge = [&](const std::vector<Index>& disputed) {
    return contacts_of_cells(model, disputed, kJudgeSamples, 3, context);
  };
  return agreement(model, model.sheet_spheres(), model.contact_orders(), judge, context);
}

}  // namespace matstruct::reference
