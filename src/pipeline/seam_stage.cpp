#include "pipeline/seam_stage.h"

#include <algorithm>

#include "base/index.h"
#include "geometry/primitives.h"
#include "preserve/edits.h"
#include "spheres/initial_spheres.h"
#include "spheres/point_grid.h"

namespace matstruct {

namespace {

// Sheet spheres nearer to a seam of theirs than this share of the spacing go.
constexpr double kRoom = 0.6;

SphereSeed seed_of(const TangentSphere& s, SphereType type) {
  return {s.center, s.radius, type, kInvalid, kInvalid, 0, 0, false};
}

// Spheres of the network, junctions once; not the corners, which are there.
std::vector<SphereSeed> seam_spheres(const SeamNetwork& network) {
  std::vector<SphereSeed> seeds;
  for (const SeamNode& node : network.nodes)
    if (node.corner == kInvalid) seeds.push_back(seed_of(node.sphere, SphereType::kJunction));
  for (const SeamCurve& curve : network.curves) {
    const std::size_t first = curve.begin == kInvalid ? 0 : 1, last = curve.end == kInvalid ? 0 : 1;
    for (std::size_t k = first; k + last < curve.spheres.size(); ++k)
      seeds.push_back(seed_of(curve.spheres[k], SphereType::kSeam));
  }
  return seeds;
}

std::vector<Index> crowding(FinderPool& finders, const Spheres& spheres, const std::vector<TangentSphere>& medial,
                            const SeamNetwork& network, double room) {
  std::vector<Vec3> centers;
  for (const TangentSphere& s : medial) centers.push_back(s.center);
  const PointGrid grid(centers, 2 * room);
  std::vector<bool> crowds(medial.size(), false);
  return finders.with_one([&](ContactFinder& finder) {
    for (const SeamCurve& curve : network.curves) {
      const std::size_t n = curve.spheres.size();
      for (std::size_t k = 0; k + 1 < n + (curve.closed ? 1 : 0); ++k) {
        const TangentSphere &a = curve.spheres[k], &b = curve.spheres[(k + 1) % n];
        const Vec3 margin{room, room, room};
        grid.for_each_in_box(min(a.center, b.center) - margin, max(a.center, b.center) + margin, [&](Index s) {
          if (crowds[uz(s)] || !spheres.alive[uz(s)] || spheres.seeds[uz(s)].guard ||
              spheres.seeds[uz(s)].type != SphereType::kSheet)
            return;
          const TangentSphere& sphere = medial[uz(s)];
          if (closest_on_triangle(sphere.center, a.center, b.center, b.center).distance > room) return;
          for (const TangentSphere* end : {&a, &b})
            crowds[uz(s)] = crowds[uz(s)] || shared_contacts(finder, sphere.center, sphere.contacts, end->center,
                                                             end->contacts)
                                                     .size() >= std::min<std::size_t>(2, sphere.contacts.size());
        });
      }
    }
    std::vector<Index> result;
    for (Index s = 0; s < count(medial); ++s)
      if (crowds[uz(s)]) result.push_back(s);
    return result;
  });
}

}  // namespace

std::vector<Edge> meeting_pairs(const Spheres& spheres, const Rpd& rpd) {
  std::vector<Edge> pairs;
  for (const RpdFacet& f : rpd.facets)
    if (!spheres.seeds[uz(f.spheres[0])].guard && !spheres.seeds[uz(f.spheres[1])].guard) pairs.push_back(f.spheres);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

SeamStage place_seams(const Domain& domain, const Options& options, Spheres& spheres, RpdEngine& engine,
                      FinderPool& finders, Context& context) {
  const double spacing = target_spacing(domain, options);
  SeamStage stage;
  stage.medial = with_contacts(finders, spheres, spacing, context);
  for (std::size_t s = 0; s < stage.medial.size(); ++s) {
    spheres.seeds[s].center = stage.medial[s].center;
    spheres.seeds[s].radius = stage.medial[s].radius;
  }
  engine.compute(weighted_points(spheres), context);
  const std::vector<TangentSphere> seeds =
      seam_seeds(finders, stage.medial, meeting_pairs(spheres, engine.diagram()), context);
  stage.network =
      finders.with_one([&](ContactFinder& finder) { return trace_seams(finder, seeds, {spacing}, context); });
  const Edits edits{seam_spheres(stage.network),
                    crowding(finders, spheres, stage.medial, stage.network, kRoom * spacing)};
  const AppliedEdits applied = apply_edits(spheres, edits, 0);
  engine.update(weighted_points(spheres), applied.inserted, applied.removed, context);
  return stage;
}

}  // namespace matstruct
