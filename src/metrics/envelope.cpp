#include "metrics/envelope.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/index.h"
#include "base/parallel.h"
#include "base/random.h"
#include "metrics/primitive_boundary.h"

namespace matstruct {

namespace {

constexpr std::uint64_t kSeed = 1, kStage = 0x656e76656c6f7065;
/// Points tried on each primitive to estimate how much of it is exposed.
constexpr Index kPilots = 16;
/// Steps of walk_out(); a handful is the rule.
constexpr int kMaxSteps = 30;
/// Trials of approach(), and the step (relative to the distance) below which it gives up.
constexpr int kApproachTrials = 40;
constexpr double kShortestStep = 1.0 / 1024;
constexpr Index kGrain = 256;

/// A primitive of any size with the spheres that span larger primitives with it.
struct Candidate {
  PrimitiveBoundary boundary;
  std::vector<Ball> neighbors;

  /// False if the point is inside a larger primitive that has this one as a part: then one of that primitive's balls
  /// reaches further in the direction of the normal.
  bool exposed(const BoundaryPoint& point, double tolerance) const {
    const double support = dot(point.normal, point.position) + tolerance;
    return std::none_of(neighbors.begin(), neighbors.end(),
                        [&](const Ball& ball) { return dot(point.normal, ball.center) + ball.radius > support; });
  }
};

std::vector<Candidate> candidates_of(const MedialMesh& mesh) {
  const auto ball = [&](Index v) { return Ball{mesh.centers[uz(v)], mesh.radii[uz(v)]}; };
  std::vector<Candidate> result;
  result.reserve(mesh.centers.size() + mesh.edges.size() + mesh.faces.size());
  for (Index v = 0; v < count(mesh.centers); ++v) result.push_back({PrimitiveBoundary::of_ball(ball(v)), {}});

  std::vector<std::pair<Edge, std::size_t>> edges;
  for (const auto& [i, j] : mesh.edges) {
    result[uz(i)].neighbors.push_back(ball(j));
    result[uz(j)].neighbors.push_back(ball(i));
    edges.push_back({ordered_edge(i, j), result.size()});
    result.push_back({PrimitiveBoundary::of_cone(ball(i), ball(j)), {}});
  }
  std::sort(edges.begin(), edges.end());
  const auto add_opposite = [&](Index i, Index j, Index opposite) {
    const std::pair<Edge, std::size_t> key{ordered_edge(i, j), 0};
    const auto edge = std::lower_bound(edges.begin(), edges.end(), key);
    if (edge != edges.end() && edge->first == key.first) result[edge->second].neighbors.push_back(ball(opposite));
  };
  for (const auto& [i, j, k] : mesh.faces) {
    add_opposite(i, j, k);
    add_opposite(j, k, i);
    add_opposite(k, i, j);
    result.push_back({PrimitiveBoundary::of_slab(ball(i), ball(j), ball(k)), {}});
  }
  return result;
}

/// k-th point of a primitive: the R2 low-discrepancy sequence (Roberts 2018) from a random start.
BoundaryPoint point_of(const Candidate& candidate, Index primitive, Index k) {
  constexpr double kPlastic = 1.32471795724474602596;  // root of x^3 = x + 1
  KeyedRandom random(kSeed, kStage, static_cast<std::uint64_t>(primitive));
  const double u = random.uniform() + k / kPlastic, v = random.uniform() + k / (kPlastic * kPlastic);
  return candidate.boundary.point(u - std::floor(u), v - std::floor(v));
}

/// How many points to try on each primitive, so that about `samples` of them are exposed, spread by area, and about one
/// on each primitive. Of each primitive the exposed share is estimated from a few points.
std::vector<Index> allot(const std::vector<Candidate>& primitives, Index samples, double tolerance,
                         const Context& context) {
  std::vector<Index> exposed(primitives.size(), 0);
  parallel_for(context, count(primitives), kGrain, [&](Index begin, Index end) {
    for (Index p = begin; p < end; ++p)
      for (Index k = 0; k < kPilots && primitives[uz(p)].boundary.exists(); ++k)
        exposed[uz(p)] += primitives[uz(p)].exposed(point_of(primitives[uz(p)], p, k), tolerance) ? 1 : 0;
  });
  const auto exposed_area = [&](std::size_t p) { return primitives[p].boundary.area() * exposed[p] / kPilots; };
  double total = 0;
  for (std::size_t p = 0; p < primitives.size(); ++p) total += exposed_area(p);

  std::vector<Index> tries(primitives.size(), 0);
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    if (!primitives[p].boundary.exists()) continue;
    const double wanted = total > 0 ? samples * exposed_area(p) / total : 0;
    const double share = std::max(static_cast<double>(exposed[p]), 0.5) / kPilots;
    tries[p] = static_cast<Index>(std::lround(std::max(1.0, wanted) / share));
  }
  return tries;
}

/// The points of the balls that are furthest out along the axes. They are on the envelope whatever the mesh.
EnvelopeSamples extreme_points(const MedialMesh& mesh) {
  EnvelopeSamples result;
  for (const Vec3& axis :
       {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
    std::size_t best = 0;
    const auto extent = [&](std::size_t v) { return dot(mesh.centers[v], axis) + mesh.radii[v]; };
    for (std::size_t v = 1; v < mesh.centers.size(); ++v)
      if (extent(v) > extent(best)) best = v;
    result.points.push_back(mesh.centers[best] + axis * mesh.radii[best]);
    result.normals.push_back(axis);
    result.weights.push_back(0);
  }
  return result;
}

EnvelopeSamples sample_envelope(const MedialMesh& mesh, const MedialTree& tree, Index samples, double tolerance,
                                const Context& context) {
  const std::vector<Candidate> primitives = candidates_of(mesh);
  const std::vector<Index> tries = allot(primitives, samples, tolerance, context);
  std::vector<Index> ends(tries.size());
  std::partial_sum(tries.begin(), tries.end(), ends.begin());
  const auto primitive_of = [&](Index s) {
    return static_cast<Index>(std::upper_bound(ends.begin(), ends.end(), s) - ends.begin());
  };
  const auto tried = [&](Index p, Index s) { return point_of(primitives[uz(p)], p, s - (ends[uz(p)] - tries[uz(p)])); };

  std::vector<char> kept(uz(ends.back()), 0);
  parallel_for(context, count(kept), kGrain, [&](Index begin, Index end) {
    for (Index s = begin; s < end; ++s) {
      const Index p = primitive_of(s);
      const BoundaryPoint point = tried(p, s);
      kept[uz(s)] = primitives[uz(p)].exposed(point, tolerance) && !tree.covers(point.position, tolerance);
    }
  });

  EnvelopeSamples result = extreme_points(mesh);
  for (Index s = 0; s < count(kept); ++s) {
    if (!kept[uz(s)]) continue;
    const Index p = primitive_of(s);
    const BoundaryPoint point = tried(p, s);
    result.points.push_back(point.position);
    result.normals.push_back(point.normal);
    result.weights.push_back(primitives[uz(p)].boundary.area() / tries[uz(p)]);
  }
  return result;
}

/// Point of the ball's boundary in the direction of `x`; any if that is the centre.
Vec3 way_out(const Vec3& x, const Ball& ball) {
  const Vec3 outward = x == ball.center ? Vec3{0, 0, 1} : normalized(x - ball.center);
  return ball.center + outward * ball.radius;
}

MedialTree tree_of_points(const std::vector<Vec3>& points) {
  std::vector<MedialPrimitive> primitives(points.size());
  for (Index p = 0; p < count(points); ++p) primitives[uz(p)] = {p, p, p};
  return MedialTree(points, std::vector<double>(points.size(), 0), std::move(primitives));
}

}  // namespace

Envelope::Envelope(const MedialMesh& mesh, Index samples, double tolerance, const Context& context)
    : tolerance_(tolerance),
      tree_(mesh.centers, mesh.radii, maximal_primitives(mesh)),
      samples_(sample_envelope(mesh, tree_, samples, tolerance, context)),
      sample_tree_(tree_of_points(samples_.points)) {}

double Envelope::distance(const Vec3& x) const {
  const MedialHit deepest = tree_.closest(x);
  if (deepest.distance >= -tolerance_) return std::abs(deepest.distance);
  const auto straight_out = walk_out(way_out(x, deepest.ball));
  // No point of the envelope is nearer than the depth.
  if (straight_out && matstruct::distance(x, *straight_out) <= -deepest.distance + tolerance_) return -deepest.distance;

  const Vec3 sample = sample_tree_.closest(x).ball.center;
  Vec3 nearest = sample;
  for (const auto& y : {straight_out, walk_out(way_out(sample, deepest.ball))})
    if (y && distance2(x, *y) < distance2(x, nearest)) nearest = *y;
  return matstruct::distance(x, approach(x, nearest));
}

/// A point of the envelope near `y`: as long as `y` is inside the union, moves it out of the primitive in which it is
/// deepest by the shortest way. Nothing if that takes too long.
std::optional<Vec3> Envelope::walk_out(Vec3 y) const {
  for (int step = 0; step < kMaxSteps; ++step) {
    const MedialHit deepest = tree_.closest(y);
    if (deepest.distance >= -tolerance_) return y;
    y = way_out(y, deepest.ball);
  }
  return std::nullopt;
}

/// Slides the point `y` of the envelope nearer to `x`: steps towards `x` and walks out again, with shorter steps when
/// that does not help.
Vec3 Envelope::approach(const Vec3& x, Vec3 y) const {
  double step = 0.5;
  for (int trial = 0; trial < kApproachTrials && step >= kShortestStep; ++trial) {
    const auto next = walk_out(lerp(y, x, step));
    if (next && distance2(x, *next) < distance2(x, y))
      y = *next;
    else
      step /= 2;
  }
  return y;
}

}  // namespace matstruct
