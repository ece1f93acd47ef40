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
// Seams found bring spheres together that were apart, and with them more seams. Cap on the repetitions.
constexpr int kMaxPasses = 4;

// Spheres of the network from the given node and curve on, with their contacts, junctions once; not the corners, which
// are there.
struct SeamSpheres {
  std::vector<SphereSeed> seeds;
  std::vector<TangentSphere> spheres;
  SphereSeed& add(const Domain& domain, const TangentSphere& sphere, SphereType type) {
    spheres.push_back(sphere);
    return seeds.emplace_back(SphereSeed{sphere.center, radius_to_surface(domain, sphere), type});
  }
};

SeamSpheres seam_spheres(const Domain& domain, const SeamNetwork& network, std::size_t first_node,
                         std::size_t first_curve) {
  SeamSpheres result;
  for (std::size_t n = first_node; n < network.nodes.size(); ++n)
    if (network.nodes[n].corner == kInvalid)
      result.add(domain, network.nodes[n].sphere, SphereType::kJunction).node = static_cast<Index>(n);
  for (std::size_t c = first_curve; c < network.curves.size(); ++c) {
    const SeamCurve& curve = network.curves[c];
    const std::size_t first = curve.begin == kInvalid ? 0 : 1, last = curve.end == kInvalid ? 0 : 1;
    for (std::size_t k = first; k + last < curve.spheres.size(); ++k) {
      SphereSeed& seed = result.add(domain, curve.spheres[k], SphereType::kSeam);
      seed.position = static_cast<double>(k);
      seed.seam = static_cast<Index>(c);
    }
  }
  return result;
}

}  // namespace

std::vector<Index> crowding_seams(FinderPool& finders, const Spheres& spheres, const std::vector<TangentSphere>& medial,
                                  const SeamNetwork& network, std::size_t first_curve, double spacing) {
  const double room = kRoom * spacing;
  std::vector<Vec3> centers;
  for (const TangentSphere& s : medial) centers.push_back(s.center);
  const PointGrid grid(centers, 2 * room);
  std::vector<bool> crowds(medial.size(), false);
  return finders.with_one([&](ContactFinder& finder) {
    for (std::size_t c = first_curve; c < network.curves.size(); ++c) {
      const SeamCurve& curve = network.curves[c];
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
            crowds[uz(s)] =
                crowds[uz(s)] ||
                shared_contacts(finder, sphere.center, sphere.contacts, end->center, end->contacts).size() >=
                    std::min<std::size_t>(2, sphere.contacts.size());
        });
      }
    }
    std::vector<Index> result;
    for (Index s = 0; s < count(medial); ++s)
      if (crowds[uz(s)]) result.push_back(s);
    return result;
  });
}

std::vector<Edge> meeting_pairs(const Spheres& spheres, const Rpd& rpd) {
  std::vector<Edge> pairs;
  for (const RpdFacet& f : rpd.facets)
    if (!spheres.seeds[uz(f.spheres[0])].guard && !spheres.seeds[uz(f.spheres[1])].guard) pairs.push_back(f.spheres);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

std::vector<Index> spheres_of_bumps(const Spheres& spheres, const std::vector<TangentSphere>& medial,
                                    const Rpd& diagram, double height) {
  const auto is_larger = [&](Index a, Index b) {
    return medial[uz(a)].radius != medial[uz(b)].radius ? medial[uz(a)].radius > medial[uz(b)].radius : a < b;
  };
  std::vector<Edge> pairs = meeting_pairs(spheres, diagram);
  for (auto& [large, small] : pairs)
    if (is_larger(small, large)) std::swap(large, small);
  // By the smaller one, the largest first: what may hold a sphere is judged before it.
  std::sort(pairs.begin(), pairs.end(),
            [&](const Edge& a, const Edge& b) { return a[1] != b[1] ? is_larger(a[1], b[1]) : a[0] < b[0]; });
  std::vector<bool> is_bump(medial.size(), false);
  for (const auto& [large, small] : pairs) {
    const TangentSphere &holds = medial[uz(large)], &held = medial[uz(small)];
    if (is_bump[uz(large)] || spheres.seeds[uz(small)].type != SphereType::kSheet || on_medial_curve(held)) continue;
    if (distance(holds.center, held.center) + held.radius <= holds.radius + height) is_bump[uz(small)] = true;
  }
  std::vector<Index> result;
  for (Index s = 0; s < count(is_bump); ++s)
    if (is_bump[uz(s)]) result.push_back(s);
  return result;
}

void drop_bumps(double height, const std::vector<TangentSphere>& medial, Spheres& spheres, RpdEngine& engine,
                Context& context) {
  const Edits bumps{.insert = {}, .remove = spheres_of_bumps(spheres, medial, engine.diagram(), height)};
  engine.update(weighted_points(spheres), {}, apply_edits(spheres, bumps, 0).removed, context);
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
  SeamNetwork& network = stage.network;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const std::size_t first_node = network.nodes.size(), first_curve = network.curves.size();
    const std::vector<TangentSphere> seeds =
        seam_seeds(finders, stage.medial, meeting_pairs(spheres, engine.diagram()), context);
    finders.with_one([&](ContactFinder& finder) { trace_seams(finder, seeds, {spacing}, network, context); });
    Edits edits;
    edits.remove = crowding_seams(finders, spheres, stage.medial, network, first_curve, spacing);
    const SeamSpheres placed = seam_spheres(domain, network, first_node, first_curve);
    if (placed.seeds.empty()) break;
    edits.insert = placed.seeds;
    const AppliedEdits applied = apply_edits(spheres, edits, 0);
    stage.medial.insert(stage.medial.end(), placed.spheres.begin(), placed.spheres.end());
    engine.update(weighted_points(spheres), applied.inserted, applied.removed, context);
  }
  return stage;
}

}  // namespace matstruct
