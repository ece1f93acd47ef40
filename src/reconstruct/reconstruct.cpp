#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
#include "reconstruct/level_set.h"
#include "reconstruct/tet_grid.h"

namespace matstruct {

namespace {

constexpr double kMinTolerance = 0.02, kMaxTolerance = 10;  // % of the diagonal
constexpr Index kGrain = 256;
/// Samples of the envelope that must be near the surface.
constexpr Index kSamples = 200'000;
/// Tetrahedra near the surface are at most this long (in diagonals): what is smaller may be seen by no vertex and is
/// found by the samples only.
constexpr double kLargest = 0.04;
/// Relative to the tolerance: a tetrahedron is divided if the distance at the middle of an edge is off by more than
/// kBend, unless it is shorter than kFine.
constexpr double kBend = 0.25, kFine = 0.6;
/// No point of a tetrahedron is further than this, times its longest edge, from its vertices and the middles of edges.
constexpr double kReach = 0.35;
/// Relative to the tolerance: no ball is smaller. Around spheres of radius 0 alone, as near sharp edges, the solid has
/// no thickness; a surface around it must have some.
constexpr double kThinnest = 0.5;
/// Part of the tolerance at which a deviation counts as too large: samples see less than all.
constexpr double kSafety = 0.9;
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

std::vector<double> at_least(std::vector<double> radii, double least) {
  for (double& r : radii) r = std::max(r, least);
  return radii;
}

/// The signed distance to the union of the primitives, sampled at the points of a grid.
class Field {
 public:
  Field(const MedialMesh& mesh, const Box& box, double tolerance, double largest, const Context& context)
      : tree_(mesh.centers, at_least(mesh.radii, kThinnest * tolerance), maximal_primitives(mesh)),
        tolerance_(tolerance),
        largest_(largest),
        context_(context) {
    const Vec3 extent = box.high - box.low;
    const double side = 1.1 * std::max({extent.x, extent.y, extent.z}) + 4 * tolerance;
    unit_ = side / TetGrid::kSize;
    origin_ = (box.low + box.high) / 2 - Vec3{side, side, side} / 2;
  }

  const TetGrid& grid() const { return grid_; }
  Vec3 place(const GridPoint& at) const { return origin_ + Vec3{double(at[0]), double(at[1]), double(at[2])} * unit_; }
  const std::vector<double>& values() const { return values_; }
  double length(const Tetrahedron& tet) const { return unit_ * grid_.size(tet); }

  /// Refines where the surface may be until the distance is nearly linear in each tetrahedron there.
  void refine() {
    while (seen_ < count(grid_.tets())) {
      context_.check();
      evaluate();
      // Midpoints are made in order, and evaluated in parallel.
      const std::vector<Tetrahedron> tets(grid_.tets().begin() + seen_, grid_.tets().end());
      std::vector<std::array<Index, 6>> midpoints(tets.size());
      for (std::size_t t = 0; t < tets.size(); ++t)
        if (may_cross(tets[t])) midpoints[t] = midpoints_of(tets[t]);
      evaluate();
      for (std::size_t t = 0; t < tets.size(); ++t)
        if (may_cross(tets[t]) && must_split(tets[t], midpoints[t])) grid_.mark(tets[t]);
      seen_ = grid_.refine(count(grid_.tets()));
    }
  }
  /// Divides the tetrahedra around the points until they are no longer than `size`; false if they are already.
  bool divide_around(const std::vector<Vec3>& points, double size) {
    bool divided = false;
    for (;;) {
      bool marked = false;
      for (const Vec3& x : points) marked |= grid_.mark_around((x - origin_) / unit_, size / unit_);
      if (!marked) return divided;
      seen_ = grid_.refine(seen_);
      divided = true;
    }
  }
  double distance(const Vec3& x) const { return tree_.closest(x).distance; }

 private:
  void evaluate() {
    const Index first = count(values_);
    values_.resize(grid_.points().size());
    parallel_for(context_, count(values_) - first, kGrain, [&](Index begin, Index end) {
      for (Index p = first + begin; p < first + end; ++p) values_[uz(p)] = distance(place(grid_.points()[uz(p)]));
    });
  }
  /// The distance changes at most as much as one moves.
  bool may_cross(const Tetrahedron& tet) const {
    const double reach = length(tet);
    return std::all_of(tet.begin(), tet.end(), [&](Index p) { return std::abs(values_[uz(p)]) <= reach; });
  }
  std::array<Index, 6> midpoints_of(const Tetrahedron& tet) {
    std::array<Index, 6> result{};
    std::size_t k = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) result[k++] = grid_.midpoint(tet[i], tet[j]);
    return result;
  }
  bool must_split(const Tetrahedron& tet, const std::array<Index, 6>& midpoints) const {
    double low = std::numeric_limits<double>::infinity(), high = -low, bend = 0;
    const auto see = [&](Index p) {
      low = std::min(low, values_[uz(p)]);
      high = std::max(high, values_[uz(p)]);
    };
    std::size_t k = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      see(tet[i]);
      for (std::size_t j = i + 1; j < 4; ++j) {
        const Index middle = midpoints[k++];
        see(middle);
        bend = std::max(bend, std::abs(values_[uz(middle)] - (values_[uz(tet[i])] + values_[uz(tet[j])]) / 2));
      }
    }
    const double nearest = low > 0 ? low : (high < 0 ? -high : 0), size = length(tet);
    if (size > largest_) return nearest <= kReach * size;
    return bend > kBend * tolerance_ && nearest <= 2 * bend && size > kFine * tolerance_;
  }

  MedialTree tree_;
  double tolerance_, largest_;
  const Context& context_;
  TetGrid grid_;
  Index seen_ = 0;  // the first tetrahedra, of which it is known whether they must be split
  Vec3 origin_;
  double unit_ = 1;
  std::vector<double> values_;  // at the grid's points
};

TriSurface extract(const Field& field, double tolerance) {
  std::vector<Vec3> places;
  places.reserve(field.grid().points().size());
  for (const GridPoint& at : field.grid().points()) places.push_back(field.place(at));
  return march(places, field.values(), field.grid().tets(), 0.1 * tolerance);
}

/// Distances of all points, in parallel.
template <class Function>
std::vector<double> at_all(const std::vector<Vec3>& points, const Context& context, const Function& function) {
  std::vector<double> result(points.size());
  parallel_for(context, count(points), kGrain, [&](Index begin, Index end) {
    for (Index p = begin; p < end; ++p) result[uz(p)] = function(points[uz(p)]);
  });
  return result;
}

std::vector<Vec3> centroids(const TriSurface& surface) {
  std::vector<Vec3> result;
  for (const auto& [i, j, k] : surface.triangles)
    result.push_back((surface.vertices[uz(i)] + surface.vertices[uz(j)] + surface.vertices[uz(k)]) / 3);
  return result;
}

std::vector<double> samples_to_surface(const Envelope& envelope, const TriSurface& surface, const Context& context) {
  const SurfaceQuery query(surface);
  return at_all(envelope.samples().points, context,
                [&](const Vec3& x) { return std::sqrt(query.closest(x).distance2); });
}

/// Points of either side that are further than `limit` from the other.
std::vector<Vec3> deviations(const Field& field, const Envelope& envelope, const TriSurface& surface, double limit,
                             const Context& context) {
  std::vector<Vec3> far;
  const auto add = [&](const std::vector<Vec3>& points, const std::vector<double>& distances) {
    for (std::size_t p = 0; p < points.size(); ++p)
      if (distances[p] > limit) far.push_back(points[p]);
  };
  const std::vector<Vec3> centers = centroids(surface);
  add(centers, at_all(centers, context, [&](const Vec3& x) { return std::abs(field.distance(x)); }));
  add(envelope.samples().points, samples_to_surface(envelope, surface, context));
  return far;
}

double greatest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
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
  result.tolerance = tolerance_percent / 100 * result.diagonal;
  const double tolerance = result.tolerance;

  context.report("reconstructing", 0);
  Field field(mesh, box, tolerance, kLargest * result.diagonal, context);
  const Envelope envelope(mesh, kSamples, tolerance::kOnEnvelope * result.diagonal, context);
  std::size_t far_before = std::numeric_limits<std::size_t>::max();
  for (int check = 0;; ++check) {
    context.report("reconstructing", double(check) / kMaxChecks);
    field.refine();
    result.surface = extract(field, tolerance);
    const std::vector<Vec3> far = deviations(field, envelope, result.surface, kSafety * tolerance, context);
    // Walls of cracks that are closed by kThinnest are missed for good.
    if (far.empty() || far.size() >= far_before || check == kMaxChecks) break;
    far_before = far.size();
    if (!field.divide_around(far, kFine * tolerance / (2 << check))) break;
  }
  const auto to_envelope = [&](const Vec3& x) { return envelope.distance(x); };
  result.to_envelope = std::max(greatest(at_all(result.surface.vertices, context, to_envelope)),
                                greatest(at_all(centroids(result.surface), context, to_envelope)));
  result.from_envelope = greatest(samples_to_surface(envelope, result.surface, context));
  const Betti betti = betti_numbers(mesh);
  result.expected = {betti.b0 + betti.b2, betti.b1};
  result.topology = surface_topology(result.surface);
  return result;
}

}  // namespace matstruct
