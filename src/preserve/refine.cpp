#include "preserve/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "base/index.h"
#include "base/parallel.h"
#include "base/tolerances.h"
#include "metrics/medial_tree.h"
#include "preserve/seams.h"
#include "spheres/sheets.h"
#include "spheres/shrink.h"

namespace matstruct {

namespace {

constexpr Index kGrain = 128;
// Spheres of one call keep this share of the spacing from each other, and from the corners of their own simplex.
constexpr double kApart = 0.4;
// A sphere covers its pin if it misses it by less than this share of the allowed deviation.
constexpr double kCovers = 0.5;

struct Proposal {
  double deviation = 0;
  TangentSphere sphere;
};

// How far the envelope of the ball at the middle is from the surface there.
double deviation_at(ContactFinder& finder, const Vec3& middle, double radius, const TangentSphere& sphere) {
  double deviation = radius - std::sqrt(finder.domain().query.closest(middle).distance2);
  for (const Contact& c : sphere.contacts)
    deviation = std::max(deviation, std::abs(distance(c.point, middle) - radius));
  return deviation;
}

std::optional<Proposal> propose(ContactFinder& finder, std::span<const TangentSphere* const> corners,
                                const RefineOptions& options) {
  Vec3 middle;
  double radius = 0;
  for (const TangentSphere* c : corners) {
    middle += c->center / static_cast<double>(corners.size());
    radius += c->radius / static_cast<double>(corners.size());
  }
  for (const TangentSphere* c : corners)
    if (distance(c->center, middle) < kApart * options.spacing) return {};
  auto sphere = common_ball(finder, corners, tolerance::kInSheet * options.spacing);
  if (!sphere || !inside(finder, *sphere)) return {};
  const double deviation = deviation_at(finder, middle, radius, *sphere);
  if (deviation <= options.deviation) return {};
  return Proposal{deviation, *std::move(sphere)};
}

}  // namespace

Edits propose_refinement(FinderPool& finders, const ThinMesh& thin, const std::vector<TangentSphere>& medial,
                         const SeamNetwork& network, const RefineOptions& options, const Context& context) {
  const MedialMesh& mesh = thin.mesh;
  const Index edges = count(mesh.edges), faces = count(mesh.faces);
  std::vector<std::optional<Proposal>> found(uz(edges + faces));
  const auto sphere_of = [&](Index vertex) { return &medial[uz(thin.spheres[uz(vertex)])]; };
  finders.for_each(context, edges + faces, kGrain, [&](ContactFinder& finder, Index k) {
    if (k < edges) {
      const Edge& e = mesh.edges[uz(k)];
      const std::array<const TangentSphere*, 2> ends{sphere_of(e[0]), sphere_of(e[1])};
      if (ends[0]->radius > 0 || ends[1]->radius > 0) found[uz(k)] = propose(finder, ends, options);
    } else {
      const Triangle& f = mesh.faces[uz(k - edges)];
      const std::array<const TangentSphere*, 3> corners{sphere_of(f[0]), sphere_of(f[1]), sphere_of(f[2])};
      found[uz(k)] = propose(finder, corners, options);
    }
  });
  std::vector<Proposal> proposals;
  for (auto& p : found)
    if (p) proposals.push_back(*std::move(p));
  std::stable_sort(proposals.begin(), proposals.end(),
                   [](const Proposal& a, const Proposal& b) { return a.deviation > b.deviation; });
  Edits edits;
  finders.with_one([&](ContactFinder& finder) {
    for (const Proposal& p : proposals) {
      SphereSeed& seed = edits.insert.emplace_back(SphereSeed{p.sphere.center, p.sphere.radius, SphereType::kSheet});
      if (p.sphere.contacts.size() < 3) continue;
      seed.type = SphereType::kSeam;
      place_on_seam(finder, network, p.sphere, options.spacing, seed);
    }
  });
  return edits;
}

Edits propose_coverage(const Domain& domain, const MedialMesh& mesh, const std::vector<Pin>& pins, double smooth_angle,
                       const RefineOptions& options, const Context& context) {
  const MedialTree tree(mesh.centers, mesh.radii, maximal_primitives(mesh));
  std::vector<std::pair<double, SphereSeed>> found(pins.size());
  parallel_for(context, count(pins), kGrain, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      const double missed = tree.closest(pins[uz(k)].point).distance;
      if (missed <= options.deviation) continue;
      // A ball that climbs off its pin on a curved wall may miss it as well: then one that stays.
      for (const double angle : {smooth_angle, smooth_angle / 4, 0.0}) {
        const ShrunkSphere s = shrink_sphere(domain, pins[uz(k)], angle);
        if (!s.converged || distance(s.center, pins[uz(k)].point) - s.radius > kCovers * options.deviation) continue;
        found[uz(k)] = {missed, {s.center, s.radius, SphereType::kSheet}};
        break;
      }
    }
  });
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  Edits edits;
  for (const auto& [missed, seed] : found)
    if (missed > 0) edits.insert.push_back(seed);
  return edits;
}

}  // namespace matstruct
