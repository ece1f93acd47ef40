#include "preserve/seams.h"

#include <algorithm>

#include "base/index.h"
#include "base/tolerances.h"
#include "extract/dual.h"

namespace matstruct {

namespace {

// Neighbours nearer to each other than this share of the spacing get no sphere between them.
constexpr double kNearest = 0.15;
// A seam that a sphere is on passes it as near as this, in spacings.
constexpr double kReach = 0.5;

// A sphere at its place on a seam.
struct Station {
  double position = 0;
  Index sphere = kInvalid;
};

std::vector<std::vector<Station>> stations_of(const SeamNetwork& network, const Spheres& spheres,
                                              const std::vector<Index>& in_dual) {
  std::vector<std::vector<Station>> chains(network.curves.size());
  std::vector<Index> of_node(network.nodes.size(), kInvalid);
  std::vector<std::pair<Index, Index>> of_corner;
  for (const Index s : in_dual) {
    const SphereSeed& seed = spheres.seeds[uz(s)];
    if (seed.seam != kInvalid) chains[uz(seed.seam)].push_back({seed.position, s});
    if (seed.node != kInvalid) of_node[uz(seed.node)] = s;
    if (seed.type == SphereType::kCorner) of_corner.emplace_back(seed.corner, s);
  }
  std::sort(of_corner.begin(), of_corner.end());
  for (Index n = 0; n < count(network.nodes); ++n) {
    if (network.nodes[uz(n)].corner == kInvalid) continue;
    const auto found = std::lower_bound(of_corner.begin(), of_corner.end(), std::pair{network.nodes[uz(n)].corner, 0});
    if (found != of_corner.end() && found->first == network.nodes[uz(n)].corner) of_node[uz(n)] = found->second;
  }
  for (Index n = 0; n < count(network.nodes); ++n)
    if (const SeamNode& node = network.nodes[uz(n)]; node.curve != kInvalid && of_node[uz(n)] != kInvalid)
      chains[uz(node.curve)].push_back({node.position, of_node[uz(n)]});
  for (Index c = 0; c < count(chains); ++c) {
    const SeamCurve& curve = network.curves[uz(c)];
    const double last = static_cast<double>(curve.spheres.size() - 1);
    std::vector<Station>& chain = chains[uz(c)];
    if (curve.begin != kInvalid && of_node[uz(curve.begin)] != kInvalid) chain.push_back({0, of_node[uz(curve.begin)]});
    if (curve.end != kInvalid && of_node[uz(curve.end)] != kInvalid) chain.push_back({last, of_node[uz(curve.end)]});
    std::sort(chain.begin(), chain.end(), [](const Station& a, const Station& b) {
      return std::pair(a.position, a.sphere) < std::pair(b.position, b.sphere);
    });
    if (curve.closed && !chain.empty()) chain.push_back({last + 1 + chain.front().position, chain.front().sphere});
  }
  return chains;
}

}  // namespace

SeamCheck check_seams(FinderPool& finders, const SeamNetwork& network, const Spheres& spheres, const Rpd& rpd,
                      double spacing) {
  SeamCheck check;
  if (network.curves.empty()) return check;
  const DualComplex dual = dual_complex(rpd);
  const auto chains = stations_of(network, spheres, dual.vertices);
  finders.with_one([&](ContactFinder& finder) {
    const double touch = tolerance::kSameDistance * finder.domain().diagonal;
    for (Index c = 0; c < count(chains); ++c) {
      const SeamCurve& curve = network.curves[uz(c)];
      for (std::size_t k = 0; k + 1 < chains[uz(c)].size(); ++k) {
        const Station &a = chains[uz(c)][k], &b = chains[uz(c)][k + 1];
        const Edge edge{std::min(a.sphere, b.sphere), std::max(a.sphere, b.sphere)};
        if (edge[0] == edge[1]) continue;
        ++check.pairs;
        if (std::binary_search(dual.edges.begin(), dual.edges.end(), edge)) continue;
        ++check.missing;
        const Vec3 &from = spheres.seeds[uz(a.sphere)].center, &to = spheres.seeds[uz(b.sphere)].center;
        if (distance(from, to) < kNearest * spacing) continue;
        const double position = (a.position + b.position) / 2;
        const Contacts contacts = inside_seam(finder, curve, static_cast<std::size_t>(position + 0.5)).contacts;
        if (contacts.size() < 3) continue;
        const auto ball = tangent_sphere(finder, lerp(from, to, 0.5), contacts, spacing);
        if (!ball || !is_medial(finder, *ball, touch)) continue;
        SphereSeed seed{ball->center, radius_to_surface(finder.domain(), *ball), SphereType::kSeam};
        seed.position = position;
        seed.seam = c;
        check.edits.insert.push_back(seed);
      }
    }
  });
  return check;
}

Edits propose_on_seams(FinderPool& finders, const SeamNetwork& network, const std::vector<TangentSphere>& medial,
                       const std::vector<Edge>& pairs, double spacing, const Context& context) {
  Edits edits;
  const std::vector<TangentSphere> seeds = seam_seeds(finders, medial, pairs, context);
  finders.with_one([&](ContactFinder& finder) {
    for (const TangentSphere& sphere : seeds) {
      SphereSeed seed{sphere.center, radius_to_surface(finder.domain(), sphere), SphereType::kSeam};
      if (place_on_seam(finder, network, sphere, spacing, seed)) edits.insert.push_back(seed);
    }
  });
  return edits;
}

bool place_on_seam(ContactFinder& finder, const SeamNetwork& network, const TangentSphere& sphere, double spacing,
                   SphereSeed& seed) {
  const auto place = place_on_network(finder, network, sphere, kReach * spacing);
  if (!place) return false;
  seed.seam = place->curve;
  seed.position = place->position;
  return true;
}

}  // namespace matstruct
