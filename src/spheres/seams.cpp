#include "spheres/seams.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/index.h"
#include "base/tolerances.h"
#include "geometry/primitives.h"

namespace matstruct {

namespace {

// A step that turns the seam by more than this cosine allows is halved, down to this share of the spacing.
constexpr double kLeastTurnCosine = 0.94, kLeastStep = 1.0 / 1024;
// A seam that comes this near to one with the same contacts, in spacings, is the same.
constexpr double kSameSeam = 0.15;
// A step must gain this share of its length along the seam.
constexpr double kLeastGain = 0.3;
// Cap on the steps of one curve, in diagonals.
constexpr double kLongestSeam = 50;
// A seam whose radius runs out within this many steps ends at the corner that lies there, to this share of the way, if
// all its contacts reach that corner.
constexpr double kCornerSteps = 1.5, kCornerMiss = 0.3;

class SeamTracer {
 public:
  SeamTracer(ContactFinder& finder, const SeamOptions& options, SeamNetwork& network, const Context& context)
      : finder_(finder),
        context_(context),
        spacing_(options.spacing),
        touch_(tolerance::kSameDistance * finder.domain().diagonal),
        network_(network),
        ways_(network.nodes.size()),
        next_node_(count(network.nodes)),
        first_node_(next_node_),
        first_curve_(network.curves.size()) {}

  void add_corners() {
    const Domain& domain = finder_.domain();
    std::vector<bool> done(domain.surface.vertices.size(), false);
    for (const FeatureLine& line : domain.features.lines) {
      if (line.kind != EdgeKind::kConvex || line.closed) continue;
      for (const Index v : {line.vertices.front(), line.vertices.back()}) {
        if (done[uz(v)]) continue;
        done[uz(v)] = true;
        const Vec3& place = domain.surface.vertices[uz(v)];
        add_node({{place, 0, finder_.find(place, 0, 0)}, v});
      }
    }
  }

  void trace_from(const TangentSphere& seed) {
    TangentSphere whole = seed;
    whole.contacts = finder_.find(seed.center, seed.radius, touch_);
    if (whole.contacts.size() < 3 || known(whole)) return;
    const std::vector<SeamDirection> ways = ways_of(whole, false);
    if (!is_inside_seam(ways)) {
      add_node({whole, kInvalid});
      return;
    }
    SeamCurve forward = march(whole, ways[0], kInvalid);
    if (!forward.closed) {
      SeamCurve backward = march(whole, ways[1], kInvalid);
      std::reverse(backward.spheres.begin(), backward.spheres.end());
      backward.spheres.insert(backward.spheres.end(), forward.spheres.begin() + 1, forward.spheres.end());
      forward.spheres = std::move(backward.spheres);
      forward.begin = backward.end;
    }
    network_.curves.push_back(std::move(forward));
  }

  // Leaves every node along every way that no curve has come in by.
  void explore() {
    for (; next_node_ < count(network_.nodes); ++next_node_) {
      context_.check();
      for (std::size_t w = 0; w < ways_[uz(next_node_)].size(); ++w) {
        if (ways_[uz(next_node_)][w].used) continue;
        ways_[uz(next_node_)][w].used = true;
        const SeamDirection way = ways_[uz(next_node_)][w].way;
        SeamCurve curve = march(network_.nodes[uz(next_node_)].sphere, way, next_node_);
        if (curve.spheres.size() > 1) network_.curves.push_back(std::move(curve));
      }
    }
  }

  // Finds the curves that pass through the new nodes.
  void place_nodes() {
    for (; first_node_ < count(network_.nodes); ++first_node_) {
      SeamNode& node = network_.nodes[uz(first_node_)];
      if (node.corner != kInvalid) continue;
      const auto place = place_on_network(finder_, network_, node.sphere, kSameSeam * spacing_, first_node_);
      if (place) node.curve = place->curve, node.position = place->position;
    }
  }

  // Seams between the same two nodes need spheres of their own, however short: else one edge would stand for both.
  void space_evenly() {
    std::map<Edge, int> between;
    for (const SeamCurve& curve : network_.curves) ++between[ends_of(curve)];
    for (std::size_t k = first_curve_; k < network_.curves.size(); ++k) {
      SeamCurve& curve = network_.curves[k];
      int least = curve.closed ? 3 : 1;
      if (curve.begin != kInvalid && curve.end != kInvalid) {
        if (between[ends_of(curve)] > 1 || ends_hide_seam(curve)) least = 2;
        if (curve.begin == curve.end) least = 3;
      }
      space_evenly(curve, least);
    }
  }

 private:
  struct Way {
    SeamDirection way;
    bool used = false;
  };

  std::vector<SeamDirection> ways_of(const TangentSphere& sphere, bool corner) const {
    std::vector<Vec3> directions;
    for (const Contact& c : sphere.contacts) directions.push_back(direction(finder_.domain(), sphere.center, c));
    std::vector<SeamDirection> ways = seam_directions(directions);
    if (corner)  // into the solid only
      std::erase_if(ways, [&](const SeamDirection& w) { return dot(directions[uz(w.contacts[0])], w.direction) >= 0; });
    return ways;
  }

  static Edge ends_of(const SeamCurve& curve) {
    return {std::min(curve.begin, curve.end), std::max(curve.begin, curve.end)};
  }

  // Whether both ends have contacts that the seam between them has not.
  bool ends_hide_seam(const SeamCurve& curve) const {
    if (curve.spheres.size() < 3) return false;
    const TangentSphere &a = curve.spheres.front(), &b = curve.spheres.back();
    return a.radius > 0 && b.radius > 0 &&
           shared_contacts(finder_, a.center, a.contacts, b.center, b.contacts).size() >
               curve.spheres[1].contacts.size();
  }

  static bool is_inside_seam(const std::vector<SeamDirection>& ways) {
    return ways.size() == 2 && ways[0].contacts == ways[1].contacts;
  }

  Index add_node(const SeamNode& node) {
    for (Index k = 0; k < count(network_.nodes); ++k)
      if (distance(network_.nodes[uz(k)].sphere.center, node.sphere.center) <= touch_) return k;
    network_.nodes.push_back(node);
    ways_.emplace_back();
    for (const SeamDirection& way : ways_of(node.sphere, node.corner != kInvalid)) ways_.back().push_back({way});
    return count(network_.nodes) - 1;
  }

  // Marks the way by which a curve with the given contacts, going in `going`, has come in.
  void arrive(Index node, const Contacts& contacts, const Vec3& going) {
    const TangentSphere& sphere = network_.nodes[uz(node)].sphere;
    Way* best = nullptr;
    double best_cosine = 0;
    for (Way& way : ways_[uz(node)]) {
      Index shared = 0;
      for (const Contact& c : contacts) {
        const Contact there = finder_.follow(c, sphere.center);
        for (const Index k : way.way.contacts) shared += finder_.same(there, sphere.contacts[uz(k)]);
      }
      const double cosine = -dot(way.way.direction, going);
      if (shared >= 3 && cosine > best_cosine) best = &way, best_cosine = cosine;
    }
    if (best) best->used = true;
  }

  bool known(const TangentSphere& sphere) {
    return std::any_of(network_.nodes.begin(), network_.nodes.end(),
                       [&](const SeamNode& node) { return distance(node.sphere.center, sphere.center) <= touch_; }) ||
           place_on_network(finder_, network_, sphere, 0.5 * spacing_).has_value();
  }

  // The corner in which the seam runs out just ahead, or kInvalid.
  Index corner_ahead(const TangentSphere& at, const Vec3& going, double step) {
    const double fall = dot(direction(finder_.domain(), at.center, at.contacts[0]), going);
    if (fall <= 0 || at.radius <= 0) return kInvalid;
    const double left = at.radius / fall;
    if (left > kCornerSteps * step) return kInvalid;
    for (Index k = 0; k < count(network_.nodes); ++k) {
      const Vec3& corner = network_.nodes[uz(k)].sphere.center;
      if (network_.nodes[uz(k)].corner == kInvalid || distance(corner, at.center + going * left) > kCornerMiss * left)
        continue;
      if (std::all_of(at.contacts.begin(), at.contacts.end(),
                      [&](const Contact& c) { return finder_.follow(c, corner).distance <= touch_; }))
        return k;
    }
    return kInvalid;
  }

  // The direction of the seam at a sphere on it, on the side of `going`.
  Vec3 tangent(const TangentSphere& sphere, const Vec3& going) const {
    const Domain& domain = finder_.domain();
    const Vec3 first = direction(domain, sphere.center, sphere.contacts[0]);
    Vec3 best;
    for (std::size_t i = 1; i < sphere.contacts.size(); ++i)
      for (std::size_t j = 1; j < i; ++j) {
        const Vec3 u = cross(direction(domain, sphere.center, sphere.contacts[i]) - first,
                             direction(domain, sphere.center, sphere.contacts[j]) - first);
        if (norm2(u) > norm2(best)) best = u;
      }
    best = normalized(best);
    return dot(best, going) < 0 ? -best : best;
  }

  // Follows a seam from `start` to its end. The first sphere of the result is `start` itself.
  SeamCurve march(const TangentSphere& start, const SeamDirection& way, Index node) {
    SeamCurve curve{{start}, node, kInvalid, false};
    TangentSphere at{start.center, start.radius, {}};
    for (const Index k : way.contacts) at.contacts.push_back(start.contacts[uz(k)]);
    Vec3 going = way.direction;
    double step = spacing_;
    const auto steps = static_cast<std::size_t>(kLongestSeam * finder_.domain().diagonal / spacing_);
    while (step >= kLeastStep * spacing_ && curve.spheres.size() < steps) {
      const Index corner = corner_ahead(at, going, step);
      const double length =
          corner == kInvalid ? step : 0.9 * distance(at.center, network_.nodes[uz(corner)].sphere.center);
      auto next = tangent_sphere(finder_, at.center + going * length, at.contacts, length);
      if (!next || !advances(at, *next, going, length)) {
        step /= 2;
        continue;
      }
      if (intruder(finder_, *next, touch_)) {
        const auto junction = shrunk_to_next_contact(finder_, *next, touch_, 2 * length);
        // A step may end just beyond a junction, not deep enough in what makes it one to be noticed.
        const double past = curve.spheres.size() > 1 ? kLeastStep * spacing_ : touch_;
        if (!junction || dot(junction->center - at.center, going) < -past ||
            distance(junction->center, at.center) > 2 * length) {
          step /= 2;
          continue;
        }
        finish_at_junction(curve, at, *junction, going);
        return curve;
      }
      if (corner != kInvalid && corner != node) {
        curve.spheres.push_back(network_.nodes[uz(corner)].sphere);
        curve.end = corner;
        arrive(corner, next->contacts, going);
        return curve;
      }
      if (place_on_network(finder_, network_, *next, kSameSeam * spacing_)) return curve;
      if (closes(curve, *next, going, length)) {
        curve.closed = true;
        return curve;
      }
      going = tangent(*next, next->center - at.center);
      at = *next;
      curve.spheres.push_back(*std::move(next));
      step = std::min(spacing_, 2 * step);
    }
    return curve;
  }

  bool advances(const TangentSphere& at, const TangentSphere& next, const Vec3& going, double length) const {
    const Vec3 moved = next.center - at.center;
    if (dot(moved, going) < kLeastGain * length || next.radius <= 0) return false;
    if (dot(tangent(next, moved), going) < kLeastTurnCosine) return false;
    return inside(finder_, next);
  }

  void finish_at_junction(SeamCurve& curve, const TangentSphere& at, const TangentSphere& junction, const Vec3& going) {
    TangentSphere whole = junction;
    whole.contacts = finder_.find(junction.center, junction.radius, touch_);
    if (is_inside_seam(ways_of(whole, false))) return;
    curve.end = add_node({whole, kInvalid});
    if (curve.spheres.size() > 1 && dot(junction.center - at.center, going) < 0) curve.spheres.pop_back();
    const Vec3& end = network_.nodes[uz(curve.end)].sphere.center;
    if (curve.spheres.size() == 1) {
      // The ends alone do not tell which of their contacts are the seam's.
      auto middle = tangent_sphere(finder_, lerp(at.center, end, 0.5), at.contacts, distance(at.center, end));
      if (middle && is_medial(finder_, *middle, touch_)) curve.spheres.push_back(*std::move(middle));
    }
    curve.spheres.push_back(network_.nodes[uz(curve.end)].sphere);
    arrive(curve.end, at.contacts, going);
  }

  // Whether the curve, begun inside a seam, comes back to its first sphere with the next one.
  bool closes(const SeamCurve& curve, const TangentSphere& next, const Vec3& going, double length) {
    if (curve.begin != kInvalid || curve.spheres.size() < 3) return false;
    const TangentSphere& first = curve.spheres.front();
    const Vec3 ahead = first.center - curve.spheres.back().center;
    return norm(ahead) <= 1.5 * length && dot(ahead, going) > 0 &&
           shared_contacts(finder_, first.center, first.contacts, next.center, next.contacts).size() >= 3;
  }

  void space_evenly(SeamCurve& curve, int least_pieces) {
    std::vector<TangentSphere> chain = curve.spheres;
    if (curve.closed) chain.push_back(chain.front());
    std::vector<double> arc(1, 0);
    for (std::size_t k = 1; k < chain.size(); ++k)
      arc.push_back(arc.back() + distance(chain[k - 1].center, chain[k].center));
    const int pieces = std::max(least_pieces, static_cast<int>(std::lround(arc.back() / spacing_)));
    std::vector<TangentSphere> even(1, chain.front());
    for (int p = 1; p < pieces; ++p) {
      const double place = arc.back() * p / pieces;
      const auto k = std::min(static_cast<std::size_t>(std::upper_bound(arc.begin(), arc.end(), place) - arc.begin()),
                              chain.size() - 1);
      const double t = (place - arc[k - 1]) / (arc[k] - arc[k - 1]);
      // Contacts of a sphere inside the curve: ends may have more.
      const std::size_t inner = std::clamp<std::size_t>(t < 0.5 ? k - 1 : k, chain.size() > 2 ? 1 : 0,
                                                        std::max<std::size_t>(chain.size(), 3) - 2);
      if (chain.size() == 2) return;
      const auto sphere =
          tangent_sphere(finder_, lerp(chain[k - 1].center, chain[k].center, t), chain[inner].contacts, spacing_);
      if (!sphere || !is_medial(finder_, *sphere, touch_)) return;
      even.push_back(*sphere);
    }
    if (!curve.closed) even.push_back(chain.back());
    curve.spheres = std::move(even);
  }

  ContactFinder& finder_;
  const Context& context_;
  double spacing_, touch_;
  SeamNetwork& network_;
  std::vector<std::vector<Way>> ways_;  // per node; none for those that were there
  Index next_node_, first_node_;
  std::size_t first_curve_;
};

}  // namespace

std::vector<Index> shared_contacts(ContactFinder& finder, const Vec3& center_a, const Contacts& a, const Vec3& center_b,
                                   const Contacts& b) {
  const Vec3 middle = lerp(center_a, center_b, 0.5);
  std::vector<Contact> of_b;
  for (const Contact& c : b) of_b.push_back(finder.follow(c, middle));
  std::vector<Index> shared;
  for (Index k = 0; k < count(a); ++k) {
    const Contact there = finder.follow(a[uz(k)], middle);
    if (std::any_of(of_b.begin(), of_b.end(), [&](const Contact& c) { return finder.same(c, there); }))
      shared.push_back(k);
  }
  return shared;
}

TangentSphere inside_seam(ContactFinder& finder, const SeamCurve& curve, std::size_t k) {
  const std::size_t n = curve.spheres.size();
  if (curve.closed) return curve.spheres[k % n];
  if (n > 2) return curve.spheres[std::clamp<std::size_t>(k, 1, n - 2)];
  const std::size_t one = curve.spheres[0].radius > 0 ? 0 : 1;  // contacts at a corner have no directions
  TangentSphere inner = curve.spheres[one];
  const TangentSphere& other = curve.spheres[1 - one];
  Contacts both;
  for (const Index s : shared_contacts(finder, inner.center, inner.contacts, other.center, other.contacts))
    both.push_back(inner.contacts[uz(s)]);
  inner.contacts = std::move(both);
  return inner;
}

std::optional<SeamPlace> place_on_network(ContactFinder& finder, const SeamNetwork& network,
                                          const TangentSphere& sphere, double reach, Index end) {
  for (Index c = 0; c < count(network.curves); ++c) {
    const SeamCurve& curve = network.curves[uz(c)];
    if (end != kInvalid && (curve.begin == end || curve.end == end)) continue;
    const std::size_t n = curve.spheres.size();
    for (std::size_t k = 0; k + 1 < n + (curve.closed ? 1 : 0); ++k) {
      const TangentSphere &a = curve.spheres[k], &b = curve.spheres[(k + 1) % n];
      const PrimitiveHit hit = closest_on_triangle(sphere.center, a.center, b.center, b.center);
      if (hit.distance > reach) continue;
      const TangentSphere inner = inside_seam(finder, curve, k);
      if (shared_contacts(finder, sphere.center, sphere.contacts, inner.center, inner.contacts).size() >= 3)
        return SeamPlace{c, static_cast<double>(k) + 1 - hit.weights[0]};
    }
  }
  return {};
}

void trace_seams(ContactFinder& finder, const std::vector<TangentSphere>& seeds, const SeamOptions& options,
                 SeamNetwork& network, const Context& context) {
  SeamTracer tracer(finder, options, network, context);
  if (network.nodes.empty()) {
    tracer.add_corners();
    tracer.explore();
  }
  for (const TangentSphere& seed : seeds) {
    context.check();
    tracer.trace_from(seed);
    tracer.explore();
  }
  tracer.space_evenly();
  tracer.place_nodes();
}

}  // namespace matstruct
