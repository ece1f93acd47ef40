// A solid with spheres, their power diagram and volume samples.
#pragma once

#include <utility>
#include <vector>

#include "base/index.h"
#include "rpd/rpd.h"
#include "spheres/cell_contacts.h"
#include "spheres/cell_sampling.h"
#include "spheres/initial_spheres.h"
#include "spheres/power_owners.h"
#include "spheres/volume_samples.h"

namespace matstruct {

/// Spheres and their cells. Refers to `domain`, which must outlive it.
struct CellModel {
  const Domain& domain;
  Spheres spheres;
  RpdEngine engine;
  double reach;  // of links

  CellModel(const Domain& solid, Spheres all, double spacing, const Context& context)
      : domain(solid), spheres(std::move(all)), engine(domain), reach(link_reach(spacing)) {
    engine.compute(weighted_points(spheres), context);
  }

  SphereNeighbors neighbors() const { return {engine.neighbors().start, engine.neighbors().list}; }
};

/// The first spheres of a solid, and volume samples.
struct SampledModel : CellModel {
  VolumeSamples samples;
  std::vector<Index> owners;

  SampledModel(const Domain& solid, const Options& options, const Context& context)
      : CellModel(solid, initial_spheres(solid, options, context), target_spacing(solid, options), context),
        samples(volume_samples(solid, {target_spacing(solid, options)}, context)) {
    find_owners(context);
  }

  void find_owners(const Context& context) {
    std::vector<Vec3> points;
    for (const VolumeSample& s : samples.samples) points.push_back(s.point);
    update_owners(points, engine.spheres(), neighbors(), context, owners);
  }
  /// Sheet spheres that are no guards.
  std::vector<Index> sheet_spheres() const {
    std::vector<Index> ids;
    for (Index s = 0; s < count(spheres.seeds); ++s)
      if (spheres.seeds[uz(s)].type == SphereType::kSheet && !spheres.seeds[uz(s)].guard) ids.push_back(s);
    return ids;
  }
  /// Completes the cells of the spheres `poor` to at least so many samples. Does not link them.
  Index add_to_poor_cells(const std::vector<Index>& poor, Index least, const Context& context) {
    std::vector<bool> wanted(spheres.seeds.size(), false);
    for (const Index s : poor) wanted[uz(s)] = true;
    return add_cell_samples(domain, engine.spheres(), neighbors(), wanted, {.least = least}, context, samples, owners);
  }
  CellContacts contacts(const ContactOptions& options = {}) const {
    return cell_contacts(samples, owners, count(spheres.seeds), options);
  }
};

}  // namespace matstruct
