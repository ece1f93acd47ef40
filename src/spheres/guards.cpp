#include "spheres/guards.h"

#include <cmath>
#include <map>
#include <numeric>

#include "base/index.h"
#include "base/parallel.h"
#include "base/tolerances.h"
#include "spheres/feature_spheres.h"
#include "spheres/shrink.h"

namespace matstruct {

namespace {

// Largest radius of a guard, in spacings; in distances from an end of its line that has a sphere of its own, or in
// lengths of the line where the end has none; in radii of the medial spheres there.
constexpr double kRadiusPerSpacing = 0.15, kRadiusPerDistance = 0.3, kRadiusPerMedialRadius = 0.3;
// The first guard's distance from an end that has a sphere of its own, in spacings and in lengths of the line.
constexpr double kFirstPerSpacing = 0.1, kFirstPerLength = 0.1;
// Growth of the radii from that of a guard at an end that several lines share, per length of the line: guards near one
// end are alike on all its lines, and none reaches past it to the walls on the other side.
constexpr double kGrowth = 0.15;
// Step to the next guard, in radii of the smaller one: below 2, so that they overlap.
constexpr double kStep = 1.4;
// Radii of guards do not go below this, in spacings: thin walls would have thousands of guards, and as many spheres of
// other lines against them.
constexpr double kSmallestPerSpacing = 2e-2;

struct LinePoint {
  Vec3 point;
  Index edge = kInvalid;  // sharp edge
  double position = 0;
};

// Arc-length parametrisation of a line.
class Walk {
 public:
  Walk(const Domain& domain, const FeatureLine& line) : domain_(domain), line_(line) {
    for (std::size_t k = 0; k < line.edges.size(); ++k) {
      const double k0 = static_cast<double>(k);
      arc_.push_back(arc_.back() + distance(point_on_line(domain, line, k0), end_of(k)));
    }
  }
  double length() const { return arc_.back(); }
  LinePoint at(double length) const {
    const auto above = std::upper_bound(arc_.begin() + 1, arc_.end() - 1, length);
    const auto k = static_cast<std::size_t>(above - arc_.begin()) - 1;
    const double t = (length - arc_[k]) / (arc_[k + 1] - arc_[k]);
    const double position = static_cast<double>(k) + t;
    return {point_on_line(domain_, line_, position), line_.edges[k], position};
  }

 private:
  const Vec3& end_of(std::size_t k) const {
    return domain_.surface.vertices[uz(line_.vertices[(k + 1) % line_.vertices.size()])];
  }
  const Domain& domain_;
  const FeatureLine& line_;
  std::vector<double> arc_{0};
};

// Radius of the least of the medial spheres at a point of a concave edge along its two face normals and half-way.
double medial_radius(const Domain& domain, const LinePoint& p) {
  const SharpEdge& edge = domain.features.edges[uz(p.edge)];
  const Vec3 n0 = domain.triangle_normals[uz(edge.triangles[0])], n1 = domain.triangle_normals[uz(edge.triangles[1])];
  double least = domain.diagonal;
  for (const Vec3& n : {n0, n1, normalized(n0 + n1)}) {
    const ShrunkSphere s = shrink_sphere(domain, {p.point, n, edge.triangles[0]}, 0);
    if (s.converged) least = std::min(least, s.radius);
  }
  return least;
}

SphereSeed guard(const LinePoint& p, Index line, double radius) {
  SphereSeed seed{p.point, 0, SphereType::kSheet, line, kInvalid, p.position, radius};
  seed.guard = true;
  return seed;
}

// Guards of one line. An end is `kept` if a corner sphere sits there: guards stay clear of it. A guard at any other end
// is left to guard_spheres(), since several lines may share it; `ends` limits the radii there.
class LineGuards {
 public:
  LineGuards(const Domain& domain, Index l, double spacing, std::array<bool, 2> kept)
      : domain_(domain),
        l_(l),
        spacing_(spacing),
        kept_(kept),
        walk_(domain, domain.features.lines[uz(l)]),
        ends_{domain.diagonal, domain.diagonal} {}
  void limit(const std::array<double, 2>& ends) { ends_ = ends; }

  /// At even steps from end to end. A guard left over next to one of them would swallow it.
  std::vector<SphereSeed> inner() const {
    const bool closed = domain_.features.lines[uz(l_)].closed;
    const double length = walk_.length();
    const double gap = std::min(kFirstPerSpacing * spacing_, kFirstPerLength * length);
    const double begin = kept_[0] ? gap : 0, end = kept_[1] ? length - gap : length;
    std::vector<double> steps{begin};
    while (steps.back() < end) steps.push_back(steps.back() + step_from(steps.back()));
    const double scale = (end - begin) / (steps.back() - begin);
    if (!kept_[1]) steps.pop_back();
    if (!kept_[0] && !closed) steps.erase(steps.begin());
    std::vector<SphereSeed> guards;
    for (const double step : steps) {
      const double s = begin + scale * (step - begin);
      guards.push_back(guard(walk_.at(s), l_, radius_at(s)));
    }
    return guards;
  }

  double radius_at(double s) const {
    const double length = walk_.length();
    double r = std::min(kRadiusPerSpacing * spacing_, kRadiusPerMedialRadius * medial_radius(domain_, walk_.at(s)));
    // The floor comes first: a guard must not hold the corner at the end of a line, however short.
    r = std::min(std::max(r, kSmallestPerSpacing * spacing_), kRadiusPerDistance * length);
    if (kept_[0]) r = std::min(r, kRadiusPerDistance * s);
    if (kept_[1]) r = std::min(r, kRadiusPerDistance * (length - s));
    return std::min({r, ends_[0] + kGrowth * s, ends_[1] + kGrowth * (length - s)});
  }
  LinePoint end_point(int side) const { return walk_.at(side == 0 ? 0 : walk_.length()); }
  double end_radius(int side) const { return radius_at(side == 0 ? 0 : walk_.length()); }

 private:
  // The step must fit the next guard too, whose radius may be smaller.
  double step_from(double s) const {
    const double r = radius_at(s);
    return kStep * std::min(r, radius_at(std::min(s + kStep * r, walk_.length())));
  }

  const Domain& domain_;
  Index l_;
  double spacing_;
  std::array<bool, 2> kept_;
  Walk walk_;
  std::array<double, 2> ends_;
};

// Whether a surface vertex has a corner sphere: an end of a convex line.
std::vector<bool> corner_vertices(const Domain& domain) {
  std::vector<bool> result(domain.surface.vertices.size(), false);
  for (const FeatureLine& line : domain.features.lines)
    if (line.kind == EdgeKind::kConvex)
      for (const Index v : line.vertices) result[uz(v)] = true;
  return result;
}

}  // namespace

std::vector<SphereSeed> guard_spheres(const Domain& domain, double spacing, const Context& context) {
  std::vector<Index> concave;
  for (Index l = 0; l < count(domain.features.lines); ++l)
    if (domain.features.lines[uz(l)].kind == EdgeKind::kConcave) concave.push_back(l);
  const auto line = [&](Index k) -> const FeatureLine& { return domain.features.lines[uz(concave[uz(k)])]; };
  const auto end_vertex = [&](Index k, int side) {
    return side == 0 ? line(k).vertices.front() : line(k).vertices.back();
  };
  const std::vector<bool> corner = corner_vertices(domain);
  const auto kept = [&](Index k, int side) { return !line(k).closed && corner[uz(end_vertex(k, side))]; };
  const auto shared = [&](Index k, int side) { return !line(k).closed && !corner[uz(end_vertex(k, side))]; };

  std::vector<std::array<SphereSeed, 2>> ends(concave.size());
  std::vector<std::vector<SphereSeed>> inner(concave.size());
  std::vector<LineGuards> guards;
  for (Index k = 0; k < count(concave); ++k)
    guards.emplace_back(domain, concave[uz(k)], spacing, std::array{kept(k, 0), kept(k, 1)});
  const auto for_each_line = [&](const auto& work) {
    parallel_for(context, count(concave), 1, [&](Index begin, Index end) {
      for (Index k = begin; k < end; ++k) work(k);
    });
  };
  for_each_line([&](Index k) {
    for (const int side : {0, 1})
      ends[uz(k)][uz(side)] = guard(guards[uz(k)].end_point(side), concave[uz(k)], guards[uz(k)].end_radius(side));
  });

  // One guard at every shared end, with the least radius that the lines there allow.
  std::map<Index, SphereSeed> at_vertex;
  for (Index k = 0; k < count(concave); ++k)
    for (const int side : {0, 1}) {
      if (!shared(k, side)) continue;
      const SphereSeed& seed = ends[uz(k)][uz(side)];
      const auto [found, fresh] = at_vertex.try_emplace(end_vertex(k, side), seed);
      if (!fresh) found->second.reach = std::min(found->second.reach, seed.reach);
    }
  for_each_line([&](Index k) {
    std::array<double, 2> radii;
    for (const int side : {0, 1})
      radii[uz(side)] = shared(k, side) ? at_vertex.at(end_vertex(k, side)).reach : domain.diagonal;
    guards[uz(k)].limit(radii);
    inner[uz(k)] = guards[uz(k)].inner();
  });

  std::vector<SphereSeed> all;
  for (const auto& of_line : inner) all.insert(all.end(), of_line.begin(), of_line.end());
  for (const auto& [v, seed] : at_vertex) all.push_back(seed);
  return all;
}

FeatureReach::FeatureReach(const Domain& domain, const std::vector<SphereSeed>& seeds)
    : least_(tolerance::kFeatureReach * domain.diagonal) {
  for (const SphereSeed& seed : seeds)
    if (seed.guard) reach_.push_back(seed.reach), centers_.push_back(seed.center);
  greatest_ = std::accumulate(reach_.begin(), reach_.end(), least_, [](double a, double b) { return std::max(a, b); });
  grid_.emplace(centers_, greatest_);
}

double FeatureReach::at(const Vec3& x) const {
  double reach = least_;
  grid_->for_each_near(x, greatest_, [&](Index g) {
    if (distance(x, centers_[uz(g)]) < reach_[uz(g)]) reach = std::max(reach, reach_[uz(g)]);
  });
  return reach;
}

SphereSeed medial_sphere_at(const Domain& domain, const SphereSeed& guard) {
  SphereSeed seed{guard.center, guard.radius};
  if (guard.line == kInvalid) return seed;
  const FeatureLine& line = domain.features.lines[uz(guard.line)];
  const auto k = std::min(static_cast<std::size_t>(guard.position), line.edges.size() - 1);
  const auto& [t0, t1] = domain.features.edges[uz(line.edges[k])].triangles;
  const Vec3 normal = normalized(domain.triangle_normals[uz(t0)] + domain.triangle_normals[uz(t1)]);
  const ShrunkSphere s = shrink_sphere(domain, {guard.center, normal, t0}, 0);
  if (s.converged) seed.center = s.center, seed.radius = s.radius;
  return seed;
}

}  // namespace matstruct
