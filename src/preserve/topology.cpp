#include "preserve/topology.h"

#include <optional>

#include "base/index.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/tolerances.h"
#include "spheres/shrink.h"

namespace matstruct {

namespace {

// How far a pin candidate is drawn from a polygon's corner towards its middle, off the sharp edges.
constexpr double kInset = 0.2;
// Candidates tried per violation, farthest first.
constexpr std::size_t kTries = 8;
// Pins keep this share of the spacing away from concave edges, and from the contact of the component's own sphere:
// spheres that touch the surface at one point tie there. A component without other points comes of such a tie, and one
// of its spheres has to go.
constexpr double kFromContact = 1e-3;
// A new sphere must bring the power distance at its pin below this share of the present one.
constexpr double kGain = 0.5;
// A component whose nearest surface point is within this share of the spacing of the sphere (as a tangent length) lies
// across a narrow gap from the sphere's own contact. The pin that helps is the point right across: spheres on both
// sides with contacts opposite each other part the gap between them, however narrow it is.
constexpr double kAcrossGap = 0.2;
// Rounds before candidates are drawn at random.
constexpr int kPatience = 4;
constexpr std::uint64_t kRandomStage = 0x70706f;

struct Candidate {
  double power = 0;  // of the offending sphere
  Vec3 point;
  Index triangle = kInvalid;
};

// Collects the surface points of offending components.
class CandidateFinder {
 public:
  CandidateFinder(const Domain& domain, const RpdEngine& engine, double clearance)
      : domain_(domain), engine_(engine), clearance2_(clearance * clearance) {}

  std::vector<Candidate> find(const Violation& v) {
    candidates_.clear();
    nearest_ = {};
    self_ = v.spheres[0];
    for (const Index r : v.records) {
      if (v.spheres[1] == kInvalid)
        add_cell(engine_.diagram().cells[uz(r)]);
      else if (v.spheres[2] == kInvalid)
        add_facet(engine_.diagram().facets[uz(r)]);
      else
        add_edge(engine_.diagram().edges[uz(r)]);
    }
    if (candidates_.empty()) add_nearest(v);
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
      return std::tuple(-a.power, a.point.x, a.point.y, a.point.z) <
             std::tuple(-b.power, b.point.x, b.point.y, b.point.z);
    });
    return candidates_;
  }

  /// The surface point of the last cell asked about that is nearest to its sphere's centre.
  const Candidate& nearest() const { return nearest_; }

  /// Whether the last component asked about is where the sphere itself touches the surface.
  bool at_contact() const { return nearest_.triangle != kInvalid && nearest_.power <= clearance2_; }

 private:
  void add(const Vec3& x, Index triangle) {
    const WeightedPoint& s = engine_.spheres()[uz(self_)];
    const double power = distance2(x, s.center) - s.weight;
    if (power > clearance2_ && !near_concave_edge(x, triangle)) candidates_.push_back({power, x, triangle});
  }

  bool near_concave_edge(const Vec3& x, Index triangle) const {
    const Triangle& corners = domain_.surface.triangles[uz(triangle)];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index e = domain_.features.triangle_edges[uz(triangle)][k];
      if (e == kInvalid || domain_.features.edges[uz(e)].kind != EdgeKind::kConcave) continue;
      const Vec3& a = domain_.surface.vertices[uz(corners[(k + 1) % 3])];
      const Vec3& b = domain_.surface.vertices[uz(corners[(k + 2) % 3])];
      if (norm2(cross(x - a, b - a)) < clearance2_ * norm2(b - a)) return true;
    }
    return false;
  }

  // The component's surface point nearest to its sphere's centre.
  void note_nearest(Index triangle) {
    const WeightedPoint& s = engine_.spheres()[uz(self_)];
    const SurfaceHit hit = domain_.query.closest_on(triangle, s.center);
    const double power = hit.distance2 - s.weight;
    if (nearest_.triangle == kInvalid || power < nearest_.power) nearest_ = {power, hit.point, triangle};
  }

  // The boundary polygons of the piece: their middles, and their corners moved inwards.
  void add_cell(const RpdCell& cell) {
    if (!touches_surface(cell.tet, cell.facets)) return;
    engine_.piece(cell.tet, cell.sphere, clipper_);
    for (int f = 0; f < 4; ++f) {
      const Index triangle = domain_.tet_triangles[uz(cell.tet)][uz(f)];
      if (triangle == kInvalid || !(cell.facets >> f & 1)) continue;
      note_nearest(triangle);
      clipper_.polygon(f, polygon_);
      Vec3 middle;
      for (const int v : polygon_) middle += clipper_.vertices()[uz(v)].point / static_cast<double>(polygon_.size());
      add(middle, triangle);
      for (const int v : polygon_) add(lerp(clipper_.vertices()[uz(v)].point, middle, kInset), triangle);
    }
  }

  // Where the facet meets the surface.
  void add_facet(const RpdFacet& facet) {
    if (touches_surface(facet.tet, facet.facets))
      add_on_bisectors(facet.tet, facet.spheres[0], {facet.spheres[1], kInvalid});
  }

  void add_edge(const RpdEdge& edge) {
    if (touches_surface(edge.tet, edge.facets))
      add_on_bisectors(edge.tet, edge.spheres[0], {edge.spheres[1], edge.spheres[2]});
  }

  // Piece vertices on the surface that lie on the bisectors with all of `others`.
  void add_on_bisectors(Index tet, Index self, const Edge& others) {
    engine_.piece(tet, self, clipper_);
    for (const PieceVertex& v : clipper_.vertices()) {
      Index triangle = kInvalid;
      int matches = 0;
      for (const std::int32_t p : v.planes) {
        if (p < kFirstBisector)
          triangle = std::max(triangle, domain_.tet_triangles[uz(tet)][uz(p)]);
        else
          matches += clipper_.sphere_of_plane(p) == others[0] || clipper_.sphere_of_plane(p) == others[1];
      }
      if (triangle != kInvalid && matches == (others[1] == kInvalid ? 1 : 2)) add(v.point, triangle);
    }
  }

  // A component inside the solid: surface points nearest to its pieces' corners.
  void add_nearest(const Violation& v) {
    for (const Index r : v.records) {
      const auto [tet, sphere] = place(v, r);
      engine_.piece(tet, sphere, clipper_);
      for (const PieceVertex& vertex : clipper_.vertices()) {
        const SurfaceHit hit = domain_.query.closest(vertex.point);
        add(hit.point, hit.triangle);
      }
    }
  }

  std::pair<Index, Index> place(const Violation& v, Index r) const {
    if (v.spheres[1] == kInvalid) return {engine_.diagram().cells[uz(r)].tet, v.spheres[0]};
    if (v.spheres[2] == kInvalid) return {engine_.diagram().facets[uz(r)].tet, v.spheres[0]};
    return {engine_.diagram().edges[uz(r)].tet, v.spheres[0]};
  }

  bool touches_surface(Index tet, std::uint8_t facets) const {
    for (int f = 0; f < 4; ++f)
      if ((facets >> f & 1) && domain_.tet_triangles[uz(tet)][uz(f)] != kInvalid) return true;
    return false;
  }

  const Domain& domain_;
  const RpdEngine& engine_;
  double clearance2_;
  Clipper clipper_;
  Index self_ = kInvalid;
  std::vector<int> polygon_;
  std::vector<Candidate> candidates_;
  Candidate nearest_;
};

// The sphere shrunk from a candidate if it takes the pin away from the present owner. On smooth surfaces a ball may
// climb away from its pin to one that is there already; a smaller smooth angle keeps it at the pin.
std::optional<SphereSeed> sphere_at(const Domain& domain, const Candidate& c, double smooth_angle) {
  const Pin pin{c.point, domain.triangle_normals[uz(c.triangle)], c.triangle};
  for (const double angle : {smooth_angle, smooth_angle / 4, 0.0}) {
    const ShrunkSphere s = shrink_sphere(domain, pin, angle);
    if (s.converged && distance2(c.point, s.center) - s.radius * s.radius < kGain * c.power)
      return SphereSeed{s.center, s.radius, SphereType::kSheet, kInvalid, kInvalid, 0};
  }
  return std::nullopt;
}

// Of the first candidates' spheres the greatest: small ones near sharp edges would call for ever finer sampling around
// them.
std::optional<SphereSeed> best_sphere(const Domain& domain, const std::vector<Candidate>& candidates,
                                      double smooth_angle) {
  std::optional<SphereSeed> best;
  for (std::size_t k = 0; k < std::min(kTries, candidates.size()); ++k)
    if (const auto s = sphere_at(domain, candidates[k], smooth_angle); s && (!best || s->radius > best->radius))
      best = s;
  return best;
}

// The other components of a disconnected cell.
Violation rest_of_cell(const Rpd& rpd, const Violation& v) {
  Violation cell = std::move(whole_cells(rpd, {v.spheres[0]}, v.kind).front());
  std::erase_if(cell.records,
                [&](Index r) { return std::find(v.records.begin(), v.records.end(), r) != v.records.end(); });
  return cell;
}

// The latest sheet sphere of a violation: the one to be given up, or kInvalid.
Index latest_sheet_sphere(const Spheres& spheres, const Violation& v) {
  Index latest = kInvalid;
  for (const Index s : v.spheres)
    if (s != kInvalid && spheres.seeds[uz(s)].type == SphereType::kSheet && !spheres.seeds[uz(s)].guard)
      latest = std::max(latest, s);
  return latest;
}

}  // namespace

Edits propose_for_topology(const Domain& domain, const RpdEngine& engine, const Spheres& spheres,
                           const std::vector<Violation>& violations, const TopologyOptions& options, int round,
                           const Context& context) {
  const double across = kAcrossGap * options.spacing;
  const double touch = tolerance::kTouch * domain.diagonal;
  std::vector<std::optional<SphereSeed>> proposed(violations.size());
  std::vector<Index> given_up(violations.size(), kInvalid);
  // Where the component itself has no pin that helps: one anywhere in the cells that meet there.
  const auto around = [&](CandidateFinder& finder, const Violation& v) {
    std::optional<SphereSeed> best;
    for (const Index s : v.spheres) {
      if (s == kInvalid) continue;
      for (const Violation& cell : whole_cells(engine.diagram(), {s}, v.kind))
        if (const auto b = best_sphere(domain, finder.find(cell), options.smooth_angle);
            b && (!best || b->radius > best->radius))
          best = b;
    }
    return best;
  };
  parallel_for(context, count(violations), 4, [&](Index begin, Index end) {
    CandidateFinder finder(domain, engine, kFromContact * options.spacing);
    for (Index v = begin; v < end; ++v) {
      const bool in_parts = violations[uz(v)].kind == ViolationKind::kCellDisconnected;
      std::vector<Candidate> candidates = finder.find(violations[uz(v)]);
      // The greatest component need not be the sphere's own: it keeps that of its contact and gives up the others. In a
      // slit narrower than the clearance both components seem to be at the contact: its own is the nearer one.
      if (in_parts && finder.at_contact()) {
        const double power = finder.nearest().power;
        candidates = finder.find(rest_of_cell(engine.diagram(), violations[uz(v)]));
        if (finder.nearest().triangle != kInvalid && finder.nearest().power < power - touch * touch)
          candidates = finder.find(violations[uz(v)]);
      }
      if (candidates.empty()) {
        given_up[uz(v)] = latest_sheet_sphere(spheres, violations[uz(v)]);
        continue;
      }
      if (round >= kPatience && round % 2 == 1) {
        KeyedRandom random(options.seed, kRandomStage + static_cast<std::uint64_t>(round),
                           static_cast<std::uint64_t>(v));
        for (std::size_t k = candidates.size(); k > 1; --k) std::swap(candidates[k - 1], candidates[random.next() % k]);
      }
      const bool gap = in_parts && finder.nearest().power > 0 && finder.nearest().power < across * across;
      if (gap) proposed[uz(v)] = sphere_at(domain, finder.nearest(), 0);
      if (!proposed[uz(v)]) proposed[uz(v)] = best_sphere(domain, candidates, options.smooth_angle);
      if (!proposed[uz(v)]) proposed[uz(v)] = around(finder, violations[uz(v)]);
    }
  });
  Edits edits;
  for (const auto& p : proposed)
    if (p) edits.insert.push_back(*p);
  for (const Index s : given_up)
    if (s != kInvalid) edits.remove.push_back(s);
  return edits;
}

}  // namespace matstruct
