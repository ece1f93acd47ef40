#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include <matstruct/error.h>
#include <matstruct/metrics.h>
#include <matstruct/reconstruct.h>

#include "base/index.h"
#include "base/parallel.h"
#include "base/tolerances.h"
#include "base/union_find.h"
#include "metrics/envelope.h"
#include "query/surface_query.h"
#include "reconstruct/distance_field.h"
#include "reconstruct/homotopic.h"
#include "reconstruct/level_set.h"

namespace matstruct {

namespace {

constexpr double kMinTolerance = 0.02, kMaxTolerance = 10;  // % of the diagonal
constexpr Index kGrain = 256;
/// Samples of the envelope that must be near the surface.
constexpr Index kSamples = 100'000;
/// Longest tetrahedra at the surface, in diagonals: what is much smaller is found by the samples only.
constexpr double kLargest = 0.04;

// Relative to the tolerance.
/// The surface is drawn this far outside of the union. So it has thickness where the union has none (around spheres of
/// radius 0, as on sharp edges), cracks that are narrower than twice this are closed, and the distance of nearly all
/// its points to the envelope is known exactly.
constexpr double kLevel = 0.45;
/// Error of linear interpolation at which a tetrahedron is divided, and the length below which it is not.
constexpr double kBend = 0.4, kFinest = 1;
/// Part of the tolerance at which a deviation counts as too large: samples see less than all.
constexpr double kSafety = 0.9;
/// The margin of march().
constexpr double kMargin = 0.1;
/// Levels of fill(): the last fills tunnels with a width of 4 % of the diagonal for the default tolerance.
constexpr std::array kClosing{0.6, 1.0, 1.5, 2.5, 4.0, 6.0, 10.0, 20.0};

constexpr int kMaxChecks = 3;

struct Box {
  Vec3 low, high;
};

Box box_of_balls(const MedialMesh& mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (Index v = 0; v < count(mesh.centers); ++v) {
    const double r = mesh.radii[uz(v)];
    box.low = min(box.low, mesh.centers[uz(v)] - Vec3{r, r, r});
    box.high = max(box.high, mesh.centers[uz(v)] + Vec3{r, r, r});
  }
  return box;
}

/// A level set, and the grid points (1) that are inside of it only for the sake of its topology.
struct LevelSet {
  TriSurface surface;
  std::vector<char> filled;
};

LevelSet extract(const DistanceField& field, double tolerance) {
  std::vector<double> values = field.values();
  for (double& v : values) v -= kLevel * tolerance;
  return {march(field.places(), values, field.tets(), kMargin * tolerance), std::vector<char>(values.size(), 0)};
}

/// The level set with fill().
LevelSet filled(const DistanceField& field, double tolerance, const SurfaceTopology& given,
                const SurfaceTopology& wanted, const Context& context) {
  std::vector<double> values = field.values();
  for (double& v : values) v -= kLevel * tolerance;
  std::vector<char> inside(values.size(), 0);
  for (const Tetrahedron& tet : field.tets())
    for (const Index v : tet) inside[uz(v)] = values[uz(v)] < 0;
  std::array<double, kClosing.size()> levels{};
  for (std::size_t k = 0; k < levels.size(); ++k) levels[k] = kClosing[k] * tolerance;
  LevelSet result;
  result.filled = fill(field.tets(), field.values(), inside, given, wanted, levels, context);
  for (std::size_t v = 0; v < values.size(); ++v)
    if (result.filled[v]) values[v] = -std::numeric_limits<double>::min();  // the margin keeps the surface clear of it
  result.surface = march(field.places(), values, field.tets(), kMargin * tolerance);
  return result;
}

/// function(point) of all points, in parallel.
template <class Function>
std::vector<double> at_all(const std::vector<Vec3>& points, const Context& context, const Function& function) {
  std::vector<double> result(points.size());
  parallel_for(context, count(points), kGrain, [&](Index begin, Index end) {
    for (Index p = begin; p < end; ++p) result[uz(p)] = function(points[uz(p)]);
  });
  return result;
}

std::vector<Vec3> vertices_and_centroids(const TriSurface& surface) {
  std::vector<Vec3> result = surface.vertices;
  for (const auto& [i, j, k] : surface.triangles)
    result.push_back((surface.vertices[uz(i)] + surface.vertices[uz(j)] + surface.vertices[uz(k)]) / 3);
  return result;
}

/// What keeps a surface from being within the tolerance.
struct Deviation {
  double to_envelope = 0, from_envelope = 0;
  double hidden_share = 0;
  std::vector<Vec3> far;  ///< points of either side that are too far from the other
};

class Checker {
 public:
  Checker(const MedialTree& tree, const Envelope& envelope, double tolerance, const Context& context)
      : tree_(tree), envelope_(envelope), tolerance_(tolerance), context_(context) {}

  Deviation check(const DistanceField& field, const LevelSet& set) const {
    Deviation result;
    const std::vector<Vec3> ours = vertices_and_centroids(set.surface);
    const auto is_filled = [&](const Vec3& x) {
      const auto tet = field.tet_around(x);
      return tet && std::any_of(tet->begin(), tet->end(), [&](Index p) { return set.filled[uz(p)] != 0; });
    };
    see(
        ours, to_envelope(ours), [&](std::size_t p) { return is_filled(ours[p]); }, result.to_envelope, result.far);

    const EnvelopeSamples& samples = envelope_.samples();
    const SurfaceQuery query(set.surface);
    const auto distances =
        at_all(samples.points, context_, [&](const Vec3& x) { return std::sqrt(query.closest(x).distance2); });
    double hidden = 0;
    const auto is_hidden = [&](std::size_t p) {
      // The ball of radius `tolerance` that touches the envelope there from outside has no room, or is in a filled gap.
      const Vec3 center = samples.points[p] + samples.normals[p] * tolerance_;
      const bool yes = tree_.covers(center, -(1 - tolerance::kDistanceRounding) * tolerance_) || is_filled(center);
      if (yes) hidden += samples.weights[p];
      return yes;
    };
    see(samples.points, distances, is_hidden, result.from_envelope, result.far);
    const double total = std::accumulate(samples.weights.begin(), samples.weights.end(), 0.0);
    result.hidden_share = total > 0 ? hidden / total : 0;
    return result;
  }

 private:
  /// Points that are too far from the other side, if they are not excused, and the greatest distance of the rest.
  template <class Excused>
  void see(const std::vector<Vec3>& points, const std::vector<double>& distances, const Excused& excused,
           double& greatest, std::vector<Vec3>& far) const {
    for (std::size_t p = 0; p < points.size(); ++p) {
      const bool is_far = distances[p] > kSafety * tolerance_;
      if (is_far && excused(p)) continue;
      if (is_far) far.push_back(points[p]);
      greatest = std::max(greatest, distances[p]);
    }
  }
  std::vector<double> to_envelope(const std::vector<Vec3>& points) const {
    std::vector<double> result = tree_.distances(points, context_);
    parallel_for(context_, count(points), kGrain, [&](Index begin, Index end) {
      for (Index p = begin; p < end; ++p)
        if (result[uz(p)] < 0) result[uz(p)] = envelope_.distance(points[uz(p)]);
    });
    return result;
  }

  const MedialTree& tree_;
  const Envelope& envelope_;
  double tolerance_;
  const Context& context_;
};

double deepest_filling(const DistanceField& field, const LevelSet& set) {
  double depth = 0;
  for (std::size_t p = 0; p < set.filled.size(); ++p)
    if (set.filled[p]) depth = std::max(depth, field.values()[p]);
  return depth;
}

}  // namespace

SurfaceTopology surface_topology(const TriSurface& surface) {
  UnionFind pieces(count(surface.vertices));
  Index components = count(surface.vertices);
  for (const auto& [i, j, k] : surface.triangles)
    for (const Index other : {j, k})
      if (pieces.unite(i, other)) --components;
  // A triangle has three halves of edges; the Euler characteristic of a component of genus g is 2 - 2 g.
  const Index euler = count(surface.vertices) - count(surface.triangles) / 2;
  return {components, components - euler / 2};
}

Reconstruction reconstruct(const MedialMesh& mesh, double tolerance_percent, Context& context) {
  if (mesh.centers.empty()) throw Error("the medial mesh has no spheres: there is nothing to reconstruct.");
  if (!(tolerance_percent >= kMinTolerance && tolerance_percent <= kMaxTolerance))
    throw Error(fmt::format("the tolerance must be between {} and {} % of the diagonal, not {}.", kMinTolerance,
                            kMaxTolerance, tolerance_percent));
  const Box box = box_of_balls(mesh);
  Reconstruction result;
  result.diagonal = distance(box.low, box.high);
  if (!(result.diagonal > 0)) throw Error("the medial mesh has no extent: there is nothing to reconstruct.");
  const double tolerance = result.tolerance = tolerance_percent / 100 * result.diagonal;
  const Betti betti = betti_numbers(mesh);
  result.expected = {betti.b0 + betti.b2, betti.b1};

  context.report("reconstructing", 0);
  const MedialTree tree(mesh.centers, mesh.radii, maximal_primitives(mesh));
  const Envelope envelope(mesh, kSamples, tolerance::kOnEnvelope * result.diagonal, context);
  const Checker checker(tree, envelope, tolerance, context);
  DistanceField field(tree, box.low, box.high,
                      {.level = kLevel * tolerance,
                       .error = kBend * tolerance,
                       .finest = kFinest * tolerance,
                       .largest = kLargest * result.diagonal},
                      context);
  LevelSet set;
  Deviation deviation;
  for (int check = 0;; ++check) {
    context.report("reconstructing", double(check) / (kMaxChecks + 1));
    field.refine();
    set = extract(field, tolerance);
    const std::size_t far_before = deviation.far.size();
    deviation = checker.check(field, set);
    const bool better = check == 0 || deviation.far.size() < far_before;
    if (deviation.far.empty() || !better || check == kMaxChecks) break;
    if (!field.divide_around(deviation.far, kFinest * tolerance / (2 << check))) break;
  }
  result.topology = surface_topology(set.surface);
  if (result.topology != result.expected) {
    set = filled(field, tolerance, result.topology, result.expected, context);
    deviation = checker.check(field, set);
    result.topology = surface_topology(set.surface);
  }
  result.to_envelope = deviation.to_envelope;
  result.from_envelope = deviation.from_envelope;
  result.hidden_share = deviation.hidden_share;
  result.deepest_filling = deepest_filling(field, set);
  result.surface = std::move(set.surface);
  return result;
}

}  // namespace matstruct
