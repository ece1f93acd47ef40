#include "spheres/volume_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/index.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/tolerances.h"
#include "query/triangle_point.h"
#include "spheres/contacts.h"
#include "spheres/pins.h"
#include "spheres/point_grid.h"
#include "spheres/shrink.h"

namespace matstruct {

namespace {

// Samples in a square of side `spacing`. With half as many, twice as many cells miss a contact.
constexpr double kSamplesPerSquare = 24;
// A patch between convex edges gets so many times more at most, in proportion to spacing / width.
constexpr double kDensest = 16;
// Samples this many mean distances apart lie side by side: 12 neighbours on average, so that chance leaves no gap.
constexpr double kLinkReach = 2;
// Samples on concave lines: distance of pins in spacings, step of the fan in radians.
constexpr double kFanSpacing = 1.0 / 3, kFanStep = 0.5;
// Samples of the fan at a vertex where concave lines end.
constexpr int kVertexFan = 24;
// Solid angle of that fan for the weights: an octant.
constexpr double kVertexAngle = std::numbers::pi / 2;
constexpr Index kGrain = 128;
// R2 sequence (Roberts 2018): the powers of the inverse of the plastic number.
constexpr std::array<double, 2> kR2{0.7548776662466927, 0.5698402909980532};

/// Stages of the random numbers.
enum Stage : std::uint64_t { kShare = 0x766f6c73, kOffset, kDepth, kFan };

/// A pin stands for the volume weight R^(1 + power), where R is the radius of its ball: a prism below a face (power 0,
/// weight its area), a wedge at a concave line (1), a cone at a vertex (2).
struct WeightedPin {
  Pin pin;
  double weight = 0;
  int power = 0;
};

std::array<Vec3, 3> corners_of(const Domain& domain, Index triangle) {
  const auto& [a, b, c] = domain.surface.triangles[uz(triangle)];
  const auto& p = domain.surface.vertices;
  return {p[uz(a)], p[uz(b)], p[uz(c)]};
}

double area_of(const std::array<Vec3, 3>& p) {
  return 0.5 * norm(cross(p[1] - p[0], p[2] - p[0]));
}

/// Factor of the density per triangle. The width of a patch between convex edges is twice its area over the length of
/// those edges: a strip of that width then has as many samples per spacing of its length as a wide patch has per
/// square of the spacing.
std::vector<double> density_factors(const Domain& domain, double spacing) {
  const Index n = count(domain.surface.triangles);
  const std::vector<Index> patch_of = patches(domain);
  std::vector<double> area(uz(n), 0), length(uz(n), 0);
  for (Index t = 0; t < n; ++t) {
    const std::array<Vec3, 3> p = corners_of(domain, t);
    const Index patch = patch_of[uz(t)];
    area[uz(patch)] += area_of(p);
    for (std::size_t k = 0; k < 3; ++k)
      if (is_patch_border(domain, t, k)) length[uz(patch)] += distance(p[(k + 1) % 3], p[(k + 2) % 3]);
  }
  std::vector<double> factor(uz(n), 1);
  for (Index t = 0; t < n; ++t) {
    const Index patch = patch_of[uz(t)];
    const double ratio = area[uz(patch)] > 0 ? spacing * length[uz(patch)] / (2 * area[uz(patch)]) : 1;
    factor[uz(t)] = std::clamp(ratio, 1.0, kDensest);
  }
  return factor;
}

/// Systematic sampling: a triangle gets its share of pins up to rounding, spread by a low-discrepancy sequence.
std::vector<WeightedPin> surface_pins(const Domain& domain, const SampleOptions& options) {
  const std::vector<double> factor = density_factors(domain, options.spacing);
  const double per_area = kSamplesPerSquare / (options.spacing * options.spacing);
  std::vector<WeightedPin> pins;
  double sum = KeyedRandom(options.seed, kShare, 0).uniform();
  for (Index t = 0; t < count(domain.surface.triangles); ++t) {
    const std::array<Vec3, 3> p = corners_of(domain, t);
    const double density = per_area * factor[uz(t)];
    sum += area_of(p) * density;
    KeyedRandom random(options.seed, kOffset, static_cast<std::uint64_t>(t));
    double u = random.uniform(), v = random.uniform();
    for (; sum >= 1; sum -= 1) {
      u = std::fmod(u + kR2[0], 1.0), v = std::fmod(v + kR2[1], 1.0);
      const bool fold = u + v > 1;
      const double a = fold ? 1 - u : u, b = fold ? 1 - v : v;
      const Vec3 point = p[0] + (p[1] - p[0]) * a + (p[2] - p[0]) * b;
      pins.push_back({{point, domain.triangle_normals[uz(t)], t}, 1 / density});
    }
  }
  return pins;
}

/// Fans along concave lines. A pin stands for the angle a of directions on the length l of the line, a volume of
/// R^2 a l / 2.
std::vector<WeightedPin> line_pins(const Domain& domain, const SampleOptions& options) {
  double angle_length = 0;
  for (const SharpEdge& e : domain.features.edges)
    if (e.kind == EdgeKind::kConcave)
      angle_length += (e.dihedral - std::numbers::pi) *
                      distance(domain.surface.vertices[uz(e.vertices[0])], domain.surface.vertices[uz(e.vertices[1])]);
  const std::vector<Pin> fan = sample_concave_lines(domain, kFanSpacing * options.spacing, kFanStep);
  std::vector<WeightedPin> pins;
  for (const Pin& pin : fan) pins.push_back({pin, angle_length / 2 / static_cast<double>(fan.size()), 1});
  return pins;
}

/// Fans at corners where concave lines end: random positive combinations of the normals around the vertex. A direction
/// outside the cone of normals does no harm: its sample projects elsewhere.
std::vector<WeightedPin> vertex_pins(const Domain& domain, std::uint64_t seed) {
  std::vector<bool> wanted(domain.surface.vertices.size(), false);
  for (const FeatureLine& line : domain.features.lines)
    if (line.kind == EdgeKind::kConcave && !line.closed)
      wanted[uz(line.vertices.front())] = wanted[uz(line.vertices.back())] = true;
  std::vector<std::vector<Index>> around(wanted.size());
  for (Index t = 0; t < count(domain.surface.triangles); ++t)
    for (const Index v : domain.surface.triangles[uz(t)])
      if (wanted[uz(domain.points[uz(v)])]) around[uz(domain.points[uz(v)])].push_back(t);
  std::vector<WeightedPin> pins;
  for (Index v = 0; v < count(around); ++v) {
    KeyedRandom random(seed, kFan, static_cast<std::uint64_t>(v));
    for (int k = 0; k < kVertexFan && !around[uz(v)].empty(); ++k) {
      Vec3 direction;
      for (const Index t : around[uz(v)]) direction += domain.triangle_normals[uz(t)] * -std::log1p(-random.uniform());
      const Pin pin{domain.surface.vertices[uz(v)], normalized(direction), around[uz(v)].front()};
      pins.push_back({pin, kVertexAngle / 3 / kVertexFan, 2});
    }
  }
  return pins;
}

/// The concave line on which a point of a triangle lies.
Index concave_line_at(const Domain& domain, Index triangle, const Vec3& point) {
  const std::array<Vec3, 3> p = corners_of(domain, triangle);
  const double near = tolerance::kOnLine * domain.diagonal;
  for (std::size_t k = 0; k < 3; ++k) {
    const Index sharp = domain.features.triangle_edges[uz(triangle)][k];
    if (sharp == kInvalid || domain.features.edges[uz(sharp)].kind != EdgeKind::kConcave) continue;
    const Vec3 &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
    if (distance(point, lerp(a, b, nearest_on_segment(point, a, b))) <= near)
      return domain.features.edges[uz(sharp)].line;
  }
  return kInvalid;
}

/// The sample at `share` of the way to the centre of the pin's ball. Contacts of the ball that are one smooth contact
/// with the pin count too: beyond a bisector of two facets, points project on the other one.
std::optional<VolumeSample> sample_below(const Domain& domain, const WeightedPin& from, double share) {
  const ShrunkSphere ball = shrink_sphere(domain, from.pin, 0);
  if (!ball.converged) return std::nullopt;
  VolumeSample sample =
      project_sample(domain, from.pin.point - from.pin.normal * (ball.radius * share), from.pin.triangle);
  sample.weight = from.weight * std::pow(ball.radius, from.power + 1);
  return sample;
}

double distance_to_triangle2(const Domain& domain, Index triangle, const Vec3& x) {
  return nearest_on_triangle(x, corners_of(domain, triangle), domain.surface.triangles[uz(triangle)]).distance2;
}

}  // namespace

double link_reach(double spacing) {
  return kLinkReach * spacing / std::sqrt(kSamplesPerSquare);
}

VolumeSample project_sample(const Domain& domain, const Vec3& x, Index guess) {
  const SurfaceHit hit = domain.query.closest_near(x, guess);
  VolumeSample sample{x, hit.point, domain.triangle_normals[uz(hit.triangle)], hit.triangle, kInvalid, kInvalid, 0};
  if (std::sqrt(hit.distance2) > tolerance::kSampleDepth * domain.diagonal) sample.normal = normalized(hit.point - x);
  sample.line = concave_line_at(domain, hit.triangle, hit.point);
  return sample;
}

void triangles_beside(const Domain& domain, const VolumeSample& sample, double reach, std::vector<Index>& reached) {
  reached.assign(1, sample.triangle);
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const Index t = reached[k];
    for (std::size_t side = 0; side < 3; ++side) {
      const Index next = domain.triangle_neighbors[uz(t)][side];
      if (is_patch_border(domain, t, side) || std::find(reached.begin(), reached.end(), next) != reached.end())
        continue;
      if (distance_to_triangle2(domain, next, sample.foot) <= reach * reach) reached.push_back(next);
    }
  }
  std::sort(reached.begin(), reached.end());
}

void link_samples(const Domain& domain, double reach, const Context& context, VolumeSamples& samples) {
  const Index n = count(samples.samples);
  const std::vector<Index> patch_of = patches(domain);
  for (VolumeSample& s : samples.samples) s.patch = patch_of[uz(s.triangle)];
  std::vector<Vec3> feet;
  feet.reserve(uz(n));
  for (const VolumeSample& s : samples.samples) feet.push_back(s.foot);
  const PointGrid grid(feet, reach);
  std::vector<std::vector<Index>> later(uz(n));  // neighbours of greater id
  parallel_for(context, n, kGrain, [&](Index begin, Index end) {
    std::vector<Index> reached;
    for (Index s = begin; s < end; ++s) {
      triangles_beside(domain, samples.samples[uz(s)], reach, reached);
      grid.for_each_near(feet[uz(s)], reach, [&](Index other) {
        if (other > s && std::binary_search(reached.begin(), reached.end(), samples.samples[uz(other)].triangle))
          later[uz(s)].push_back(other);
      });
      std::sort(later[uz(s)].begin(), later[uz(s)].end());
    }
  });
  samples.start.assign(uz(n) + 1, 0);
  for (Index s = 0; s < n; ++s) {
    samples.start[uz(s) + 1] += count(later[uz(s)]);
    for (const Index other : later[uz(s)]) ++samples.start[uz(other) + 1];
  }
  for (std::size_t s = 0; s < uz(n); ++s) samples.start[s + 1] += samples.start[s];
  samples.list.resize(uz(samples.start.back()));
  std::vector<Index> next(samples.start.begin(), samples.start.end() - 1);
  for (Index s = 0; s < n; ++s)
    for (const Index other : later[uz(s)]) samples.list[uz(next[uz(other)]++)] = s;
  for (Index s = 0; s < n; ++s)
    for (const Index other : later[uz(s)]) samples.list[uz(next[uz(s)]++)] = other;
}

VolumeSamples volume_samples(const Domain& domain, const SampleOptions& options, const Context& context) {
  std::vector<WeightedPin> pins = surface_pins(domain, options);
  for (const WeightedPin& pin : line_pins(domain, options)) pins.push_back(pin);
  for (const WeightedPin& pin : vertex_pins(domain, options.seed)) pins.push_back(pin);

  std::vector<std::optional<VolumeSample>> found(pins.size());
  parallel_for(context, count(pins), kGrain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      KeyedRandom random(options.seed, kDepth, static_cast<std::uint64_t>(i));
      found[uz(i)] = sample_below(domain, pins[uz(i)], std::sqrt(random.uniform()));
    }
  });
  VolumeSamples result;
  for (const auto& sample : found)
    if (sample) result.samples.push_back(*sample);
  link_samples(domain, link_reach(options.spacing), context, result);
  return result;
}

}  // namespace matstruct
