// A solid with its first spheres, their power diagram and volume samples.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <matstruct/io.h>

#include "base/index.h"
#include "rpd/rpd.h"
#include "spheres/cell_contacts.h"
#include "spheres/cell_sampling.h"
#include "spheres/initial_spheres.h"
#include "spheres/power_owners.h"
#include "spheres/volume_samples.h"

namespace matstruct {

struct SampledModel {
  Domain domain;
  Spheres spheres;
  std::unique_ptr<RpdEngine> engine;  // refers to `domain`: the model must not be moved
  VolumeSamples samples;
  std::vector<Index> owners;
  double reach = 0;  // of links

  SampledModel(const TetMesh& solid, const Options& options, Context& context)
      : domain(prepare_domain(solid, options, context)), spheres(initial_spheres(domain, options, context)) {
    engine = std::make_unique<RpdEngine>(domain);
    engine->compute(weighted_points(spheres), context);
    reach = link_reach(target_spacing(domain, options));
    samples = volume_samples(domain, {target_spacing(domain, options)}, context);
    find_owners(context);
  }
  SampledModel(const SampledModel&) = delete;
  SampledModel& operator=(const SampledModel&) = delete;

  SphereNeighbors neighbors() const { return {engine->neighbors().start, engine->neighbors().list}; }
  void find_owners(const Context& context) {
    std::vector<Vec3> points;
    for (const VolumeSample& s : samples.samples) points.push_back(s.point);
    update_owners(points, engine->spheres(), neighbors(), context, owners);
  }
  /// Completes the cells of sheet spheres to at least 48 samples.
  Index add_to_poor_cells(const Context& context) {
    std::vector<bool> wanted;
    for (const SphereSeed& s : spheres.seeds) wanted.push_back(s.type == SphereType::kSheet && !s.guard);
    return add_cell_samples(domain, engine->spheres(), neighbors(), wanted, {.reach = reach}, context, samples, owners);
  }
  CellContacts contacts(const ContactOptions& options = {}) const {
    return cell_contacts(samples, owners, count(spheres.seeds), options);
  }
};

}  // namespace matstruct
