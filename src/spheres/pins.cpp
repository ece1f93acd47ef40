// Dart throwing on a dense sample: R. Cook, "Stochastic sampling in computer graphics", 1986, restricted to a finite
// set of candidates as in D. Cline et al., "Dart throwing on surfaces", 2009, so that it ends with every candidate
// covered.
#include "spheres/pins.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/index.h"
#include "base/parallel.h"
#include "base/random.h"

namespace matstruct {
namespace {

// Candidates in a square of side `spacing`: about 25 in the disk that a pin claims.
constexpr double kCandidatesPerSquare = 8;
constexpr Index kGrain = 1024;

/// Stages of the random numbers.
enum Stage : std::uint64_t { kOffset = 0x70696e73, kPosition, kOrder };

/// The triangle of every candidate. A triangle gets its share of candidates up to rounding, by systematic sampling: the
/// areas laid end to end are cut at equal steps from one random offset.
std::vector<Index> share_candidates(const Domain& domain, double per_area, std::uint64_t seed) {
  const TriSurface& surface = domain.surface;
  std::vector<Index> triangles;
  double sum = KeyedRandom(seed, kOffset, 0).uniform();
  for (Index t = 0; t < count(surface.triangles); ++t) {
    const auto& [a, b, c] = surface.triangles[uz(t)];
    const Vec3& origin = surface.vertices[uz(a)];
    const Vec3 normal = cross(surface.vertices[uz(b)] - origin, surface.vertices[uz(c)] - origin);
    sum += 0.5 * norm(normal) * per_area;
    const double whole = std::floor(sum);
    triangles.insert(triangles.end(), static_cast<std::size_t>(whole), t);
    sum -= whole;
  }
  return triangles;
}

/// Uniform in the triangle: the square of two random numbers, folded along its diagonal.
Pin random_pin(const Domain& domain, Index triangle, KeyedRandom random) {
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const auto& [a, b, c] = domain.surface.triangles[uz(triangle)];
  const auto& p = domain.surface.vertices;
  const Vec3 point = p[uz(a)] + (p[uz(b)] - p[uz(a)]) * u + (p[uz(c)] - p[uz(a)]) * v;
  return {point, domain.triangle_normals[uz(triangle)], triangle};
}

/// Points, found by place: a hash table over the cells of a grid. Cells that share a slot only cost some more
/// distances.
class PointGrid {
 public:
  PointGrid(double cell, Index capacity) : cell_(cell) {
    std::size_t slots = 64;
    while (slots < 2 * uz(capacity)) slots *= 2;
    heads_.assign(slots, kInvalid);
  }

  void add(const Vec3& p) {
    const std::size_t slot = slot_of(cell_of(p.x), cell_of(p.y), cell_of(p.z));
    points_.push_back(p);
    next_.push_back(heads_[slot]);
    heads_[slot] = count(points_) - 1;
  }

  /// True if a point lies nearer to `p` than the cell size.
  bool covers(const Vec3& p) const {
    const std::int64_t x = cell_of(p.x), y = cell_of(p.y), z = cell_of(p.z);
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          if (slot_covers(slot_of(x + dx, y + dy, z + dz), p)) return true;
        }
      }
    }
    return false;
  }

 private:
  std::int64_t cell_of(double x) const { return static_cast<std::int64_t>(std::floor(x / cell_)); }
  std::size_t slot_of(std::int64_t x, std::int64_t y, std::int64_t z) const {
    std::uint64_t hash = static_cast<std::uint64_t>(x) * 0x8da6b343u + static_cast<std::uint64_t>(y) * 0xd8163841u +
                         static_cast<std::uint64_t>(z) * 0xcb1ab31fu;
    hash ^= hash >> 17;
    return hash & (heads_.size() - 1);
  }
  bool slot_covers(std::size_t slot, const Vec3& p) const {
    for (Index i = heads_[slot]; i != kInvalid; i = next_[uz(i)]) {
      if (distance2(points_[uz(i)], p) < cell_ * cell_) return true;
    }
    return false;
  }

  double cell_;
  std::vector<Index> heads_;  ///< last point of a slot
  std::vector<Index> next_;   ///< #points, the one added before in the same slot
  std::vector<Vec3> points_;
};

/// Candidates in random order.
std::vector<Index> shuffled(Index n, std::uint64_t seed) {
  std::vector<std::pair<std::uint64_t, Index>> keyed;
  keyed.reserve(uz(n));
  for (Index i = 0; i < n; ++i) keyed.emplace_back(KeyedRandom(seed, kOrder, static_cast<std::uint64_t>(i)).next(), i);
  std::sort(keyed.begin(), keyed.end());
  std::vector<Index> order;
  order.reserve(uz(n));
  for (const auto& [key, i] : keyed) order.push_back(i);
  return order;
}

/// The direction at `share` in [0, 1] of the way from the one to the other face normal of a concave edge.
Vec3 fan_normal(const Domain& domain, const SharpEdge& edge, double share) {
  const auto& p = domain.surface.vertices;
  const Vec3 from = domain.triangle_normals[uz(edge.triangles[0])], to = domain.triangle_normals[uz(edge.triangles[1])];
  Vec3 side = normalized(cross(p[uz(edge.vertices[1])] - p[uz(edge.vertices[0])], from));
  if (dot(side, to) < 0) side = -side;
  const double turn = angle_between(from, to) * share;
  return normalized(from * std::cos(turn) + side * std::sin(turn));
}

/// Pins at equal arc lengths, as many to a stretch of `spacing` as a fan has directions, each with another direction of
/// the fan (golden ratio sequence). A whole fan at one point would give spheres that touch the edge at that very point:
/// their power distances tie along the edge, and rounding would share it out at random.
void sample_line(const Domain& domain, const FeatureLine& line, double spacing, double fan_step,
                 std::vector<Pin>& pins) {
  const auto& p = domain.surface.vertices;
  const auto end_of = [&](Index k) { return p[uz(line.vertices[uz(k % count(line.vertices))])]; };
  double length = 0, widest = 0;
  for (Index k = 0; k < count(line.edges); ++k) {
    length += distance(end_of(k), end_of(k + 1));
    const auto [t0, t1] = domain.features.edges[uz(line.edges[uz(k)])].triangles;
    widest = std::max(widest, angle_between(domain.triangle_normals[uz(t0)], domain.triangle_normals[uz(t1)]));
  }
  const double directions = std::ceil(widest / fan_step) + 1;
  const double stretch = length / (directions * std::max(1.0, std::ceil(length / spacing)));
  double next = 0.5 * stretch;  // arc length of the next pin, counted from the start of edge k
  double share = 0;
  for (Index k = 0; k < count(line.edges); ++k) {
    const double edge_length = distance(end_of(k), end_of(k + 1));
    const SharpEdge& edge = domain.features.edges[uz(line.edges[uz(k)])];
    for (; next < edge_length; next += stretch) {
      pins.push_back({lerp(end_of(k), end_of(k + 1), next / edge_length), fan_normal(domain, edge, share),
                      edge.triangles[share < 0.5 ? 0 : 1]});
      share = std::fmod(share + std::numbers::phi - 1, 1.0);
    }
    next -= edge_length;
  }
}

}  // namespace

std::vector<Pin> sample_surface(const Domain& domain, double spacing, std::uint64_t seed, const Context& context) {
  const std::vector<Index> triangles = share_candidates(domain, kCandidatesPerSquare / (spacing * spacing), seed);
  std::vector<Pin> candidates(triangles.size());
  parallel_for(context, count(triangles), kGrain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      candidates[uz(i)] = random_pin(domain, triangles[uz(i)], {seed, kPosition, static_cast<std::uint64_t>(i)});
    }
  });
  std::vector<Pin> pins;
  PointGrid grid(spacing, count(candidates) / static_cast<Index>(kCandidatesPerSquare));
  for (const Index i : shuffled(count(candidates), seed)) {
    if (grid.covers(candidates[uz(i)].point)) continue;
    grid.add(candidates[uz(i)].point);
    pins.push_back(candidates[uz(i)]);
  }
  return pins;
}

std::vector<Pin> sample_concave_lines(const Domain& domain, double spacing, double fan_step) {
  std::vector<Pin> pins;
  for (const FeatureLine& line : domain.features.lines) {
    if (line.kind == EdgeKind::kConcave) sample_line(domain, line, spacing, fan_step, pins);
  }
  return pins;
}

}  // namespace matstruct
