// Isotropic remeshing (Botsch & Kobbelt 2004) on a complex of sheets: split long edges, collapse short ones, flip,
// smooth, project. Each edit looks at the star that it changes, before and after, and is refused if the star gets
// worse.
#include "extract/remesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "base/index.h"
#include "base/parallel.h"
#include "extract/sheet_complex.h"

namespace matstruct {

namespace {

// Edges longer and shorter than these shares of their wanted length are split and collapsed.
constexpr double kLong = 4.0 / 3, kShort = 4.0 / 5;
// Edges of curves that are shorter than this share of the target are collapsed where that makes triangles better.
constexpr double kShortOnCurve = 0.6;
// How fast the wanted edge length may grow from short curve edges into a sheet, per length.
constexpr double kGrowth = 0.4;
// Shares of the target: how far a face may be off the axis, and a lost sphere stick out of what replaces it.
constexpr double kDeviation = 0.02, kStickingOut = 0.03;
// No edit makes a triangle of less quality than this, unless one as bad was there.
constexpr double kCollapseQuality = 0.35, kSmoothQuality = 0.5;
// A flip has to improve the worse of the two triangles by this.
constexpr double kFlipGain = 0.02;
// Cosines: between a triangle's normals before and after an edit, and between the triangles of a quadrilateral to flip.
constexpr double kFold = 0.7, kFlat = 0.8;
// A triangle of less quality has no normal to go by.
constexpr double kNoNormal = 0.02;
// The oracle may answer as far from the guess as this share of the target; moves shorter than the second are left out.
constexpr double kReach = 0.15, kStill = 0.01;
constexpr int kSmoothingSteps = 3;
constexpr char kSettled = 1, kMoved = 2;
constexpr Index kGrain = 32;

using Corners = std::array<Ball, 3>;

/// A face as it would be after an edit.
struct Changed {
  Index face = kInvalid;
  Corners corners;
  double allowed = 0;  // deviation from the axis
  double deviation = 0;
};

/// Quality of some triangles, and how much farther off the axis than allowed they are.
struct Patch {
  double worst = 1, sum = 0;
  double excess = 0, greatest_excess = 0;
};

Vec3 normal_of(const Corners& t) {
  return cross(t[1].center - t[0].center, t[2].center - t[0].center);
}

double quality_of(const Corners& t) {
  return triangle_shape(t[0].center, t[1].center, t[2].center);
}

bool turned(const Vec3& before, const Vec3& after, double least_cosine) {
  return dot(before, after) < least_cosine * norm(before) * norm(after);
}

bool turned_over(const Corners& before, const Corners& after) {
  return quality_of(before) > kNoNormal && turned(normal_of(before), normal_of(after), kFold);
}

class Remesher {
 public:
  Remesher(const StratifiedMesh& input, const AxisOracle& axis, const RemeshOptions& options, const Context& context)
      : input_(input), axis_(axis), target_(options.target), context_(context), complex_(input) {
    for (Index v = 0; v < count(input.mesh.centers); ++v) {
      balls_.push_back({input.mesh.centers[uz(v)], input.mesh.radii[uz(v)]});
      types_.push_back(input.mesh.types[uz(v)]);
      origin_.push_back(v);
    }
    deviation_.resize(input.mesh.faces.size());
    parallel_for(context, complex_.faces(), kGrain, [&](Index begin, Index end) {
      for (Index f = begin; f < end; ++f) deviation_[uz(f)] = deviation(corners(f));
    });
    for (Index v = 0; v < complex_.vertices(); ++v) {
      const std::vector<Index>& around = complex_.faces_of(v);
      double sum = 0;
      for (const Index f : around) sum += deviation_[uz(f)];
      const double mean = around.empty() ? 0 : sum / static_cast<double>(around.size());
      allowed_.push_back(std::max(kDeviation * target_, mean));
    }
  }

  void round() {
    update_sizes();
    split_long_edges();
    collapse_short_edges();
    flip_edges();
    smooth();
  }

  RemeshResult result() const;

 private:
  // ---- geometry

  const Vec3& at(Index v) const { return balls_[uz(v)].center; }
  double length(Index a, Index b) const { return distance(at(a), at(b)); }
  Corners corners(Index f) const {
    const auto& [a, b, c] = complex_.corners(f);
    return {balls_[uz(a)], balls_[uz(b)], balls_[uz(c)]};
  }
  Corners corners_with(Index f, Index v, const Ball& ball) const {
    Corners result = corners(f);
    for (std::size_t k = 0; k < 3; ++k)
      if (complex_.corners(f)[k] == v) result[k] = ball;
    return result;
  }
  double deviation(const Corners& t) const {
    double greatest = 0;
    for (const auto& w :
         {std::array<double, 3>{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}}) {
      const Ball middle = ball_at(t[0], t[1], t[2], w);
      greatest = std::max(greatest, std::abs(axis_.distance(middle.center) - middle.radius));
    }
    return greatest;
  }
  double allowed(Index f) const {
    const auto& [a, b, c] = complex_.corners(f);
    return (allowed_[uz(a)] + allowed_[uz(b)] + allowed_[uz(c)]) / 3;
  }

  // ---- patches

  Changed with_corner(Index f, Index v, const Ball& ball, double allowed_there) const {
    return {f, corners_with(f, v, ball), allowed(f) + (allowed_there - allowed_[uz(v)]) / 3, 0};
  }
  Patch patch_of(const std::vector<Index>& faces) const;
  static Patch quality_of_all(const std::vector<Changed>& changed);
  void measure_deviation(std::vector<Changed>& changed, Patch& patch) const;
  void keep_deviations(const std::vector<Changed>& changed) {
    for (const Changed& c : changed) deviation_[uz(c.face)] = c.deviation;
  }

  // ---- edits

  double wanted(Index a, Index b) const { return (size_[uz(a)] + size_[uz(b)]) / 2; }
  void update_sizes();
  Index sheet_at(Index v) const { return complex_.sheet(complex_.faces_of(v).front()); }
  /// What the oracle answered, unless that is too far from the guess.
  std::optional<Ball> near(const std::optional<Ball>& answer, const Vec3& guess) const {
    return answer && distance(answer->center, guess) <= kReach * target_ ? answer : std::nullopt;
  }
  std::optional<Ball> middle_of(const Edge& e) const;
  void split_long_edges();
  bool split(const Edge& e, const Ball& middle);
  void collapse_short_edges();
  bool collapse(Index gone, Index kept);
  bool covered(Index gone, const Ball& instead, const std::vector<Changed>& after) const;
  void flip_edges();
  bool flip(Index a, Index b);
  void smooth();
  std::vector<std::vector<Index>> independent_sets() const;
  bool slides(Index v) const;
  bool on_border(Index v) const;
  /// Whether a vertex goes along a known seam or medial curve: there an even spacing comes before good triangles.
  bool spaced(Index v) const { return complex_.freedom(v) == Freedom::kCurve && axis_.on_curve && !on_border(v); }
  std::vector<Vec3> aims(Index v) const;
  Vec3 axis_at(Index v) const;
  bool move(Index v);
  bool move_to(Index v, const Vec3& guess);

  const StratifiedMesh& input_;
  const AxisOracle& axis_;
  double target_;
  const Context& context_;
  SheetComplex complex_;
  std::vector<Ball> balls_;        // per vertex
  std::vector<SphereType> types_;  // per vertex
  std::vector<Index> origin_;      // per vertex: itself or a vertex of the input nearby
  std::vector<double> size_;       // per vertex: wanted edge length
  std::vector<double> allowed_;    // per vertex: deviation that faces around it may have
  std::vector<double> deviation_;  // per face
  Index splits_ = 0, collapses_ = 0, flips_ = 0, moves_ = 0;
};

Patch Remesher::patch_of(const std::vector<Index>& faces) const {
  Patch patch;
  for (const Index f : faces) {
    const double quality = quality_of(corners(f)), excess = std::max(0.0, deviation_[uz(f)] - allowed(f));
    patch.worst = std::min(patch.worst, quality);
    patch.sum += quality;
    patch.excess += excess;
    patch.greatest_excess = std::max(patch.greatest_excess, excess);
  }
  return patch;
}

Patch Remesher::quality_of_all(const std::vector<Changed>& changed) {
  Patch patch;
  for (const Changed& c : changed) {
    const double quality = quality_of(c.corners);
    patch.worst = std::min(patch.worst, quality);
    patch.sum += quality;
  }
  return patch;
}

// Apart from the quality, since it costs a query per face and most edits are refused before.
void Remesher::measure_deviation(std::vector<Changed>& changed, Patch& patch) const {
  for (Changed& c : changed) {
    c.deviation = deviation(c.corners);
    const double excess = std::max(0.0, c.deviation - c.allowed);
    patch.excess += excess;
    patch.greatest_excess = std::max(patch.greatest_excess, excess);
  }
}

// The wanted length is the target, or less near curves with shorter edges: least of the curve edges' lengths grown with
// the distance along edges (Dijkstra).
void Remesher::update_sizes() {
  size_.assign(uz(complex_.vertices()), target_);
  using Item = std::pair<double, Index>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  for (Index v = 0; v < complex_.vertices(); ++v) {
    const std::vector<Index>& around = complex_.curve_neighbors(v);
    if (around.empty()) continue;
    double sum = 0;
    for (const Index w : around) sum += length(v, w);
    size_[uz(v)] = std::min(target_, sum / static_cast<double>(around.size()));
    queue.push({size_[uz(v)], v});
  }
  while (!queue.empty()) {
    const auto [size, v] = queue.top();
    queue.pop();
    if (size > size_[uz(v)] || size >= target_) continue;
    for (const Index w : complex_.neighbors(v)) {
      const double grown = size + kGrowth * length(v, w);
      if (grown >= size_[uz(w)]) continue;
      size_[uz(w)] = grown;
      queue.push({grown, w});
    }
  }
}

// ---- splits

std::optional<Ball> Remesher::middle_of(const Edge& e) const {
  const auto& [a, b] = e;
  const Vec3 guess = lerp(at(a), at(b), 0.5);
  if (!complex_.is_curve_edge(a, b)) {
    const Index inner = complex_.freedom(a) == Freedom::kSheet ? a : b;
    return near(axis_.on_sheet(guess, origin_[uz(inner)], complex_.sheet(complex_.faces_of_edge(a, b).front())), guess);
  }
  const bool fixed = complex_.freedom(a) == Freedom::kFixed && complex_.freedom(b) == Freedom::kFixed;
  if (fixed || !axis_.on_curve) return std::nullopt;
  return near(axis_.on_curve(guess, {origin_[uz(a)], origin_[uz(b)]}), guess);
}

void Remesher::split_long_edges() {
  std::vector<std::pair<double, Edge>> long_edges;
  for (const Edge& e : complex_.edges()) {
    const double wanted_length = complex_.is_curve_edge(e[0], e[1]) ? target_ : wanted(e[0], e[1]);
    const double ratio = length(e[0], e[1]) / wanted_length;
    if (ratio > kLong) long_edges.push_back({-ratio, e});
  }
  std::sort(long_edges.begin(), long_edges.end());
  // A split moves no vertex and leaves other edges as they are, so all projections can be made at once.
  std::vector<std::optional<Ball>> middles(long_edges.size());
  parallel_for(context_, count(long_edges), kGrain, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) middles[uz(k)] = middle_of(long_edges[uz(k)].second);
  });
  for (std::size_t k = 0; k < long_edges.size(); ++k)
    if (middles[k] && split(long_edges[k].second, *middles[k])) ++splits_;
}

bool Remesher::split(const Edge& e, const Ball& middle) {
  const auto& [a, b] = e;
  const std::vector<Index> faces = complex_.faces_of_edge(a, b);
  const double allowed_there = (allowed_[uz(a)] + allowed_[uz(b)]) / 2;
  const Index first_new = complex_.faces();
  // A face keeps its end a, the new one beside it has b (SheetComplex::split).
  std::vector<Changed> changed;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    changed.push_back(with_corner(faces[k], b, middle, allowed_there));
    changed.push_back(with_corner(faces[k], a, middle, allowed_there));
    for (std::size_t half = 2 * k; half < changed.size(); ++half)
      if (turned_over(corners(faces[k]), changed[half].corners)) return false;
    changed.back().face = first_new + static_cast<Index>(k);
  }
  Patch after;
  measure_deviation(changed, after);
  if (after.greatest_excess > patch_of(faces).greatest_excess) return false;

  types_.push_back(complex_.is_curve_edge(a, b) && faces.size() >= 3 ? SphereType::kSeam : SphereType::kSheet);
  complex_.split(a, b);
  balls_.push_back(middle);
  origin_.push_back(origin_[uz(complex_.freedom(a) == Freedom::kFixed ? b : a)]);
  size_.push_back(wanted(a, b));
  allowed_.push_back(allowed_there);
  deviation_.resize(deviation_.size() + faces.size());
  keep_deviations(changed);
  return true;
}

// ---- collapses

void Remesher::collapse_short_edges() {
  for (Index v = 0; v < complex_.vertices(); ++v) {
    if (!complex_.vertex_alive(v) || complex_.freedom(v) == Freedom::kFixed) continue;
    const bool on_curve = complex_.freedom(v) == Freedom::kCurve;
    std::vector<std::pair<double, Index>> near;
    for (const Index w : on_curve ? complex_.curve_neighbors(v) : complex_.neighbors(v)) {
      const double limit = on_curve ? kShortOnCurve * target_ : kShort * wanted(v, w);
      if (length(v, w) < limit) near.push_back({length(v, w), w});
    }
    std::sort(near.begin(), near.end());
    for (const auto& [unused, w] : near)
      if (collapse(v, w)) {
        ++collapses_;
        break;
      }
  }
}

// Whether the sphere of `gone` sticks out of what takes its place, `instead` and the triangles and curve edges at it,
// by no more than the tolerance. A primitive holds a ball (c, r) up to the least of |c - c(w)| + r - r(w) over its
// balls, taken here at their point nearest to c.
bool Remesher::covered(Index gone, const Ball& instead, const std::vector<Changed>& after) const {
  const Ball& ball = balls_[uz(gone)];
  const auto holds = [&](const Ball& a, const Ball& b, const Ball& c) {
    const PrimitiveHit hit = closest_on_triangle(ball.center, a.center, b.center, c.center);
    return hit.distance + ball.radius - ball_at(a, b, c, hit.weights).radius <= kStickingOut * target_;
  };
  const std::vector<Index>& along = complex_.curve_neighbors(gone);
  return std::any_of(after.begin(), after.end(),
                     [&](const Changed& c) { return holds(c.corners[0], c.corners[1], c.corners[2]); }) ||
         std::any_of(along.begin(), along.end(), [&](Index w) { return holds(balls_[uz(w)], instead, instead); });
}

bool Remesher::collapse(Index gone, Index kept) {
  if (!complex_.can_collapse(gone, kept)) return false;
  std::vector<Changed> changed;
  for (const Index f : complex_.faces_of(gone)) {
    const Triangle& t = complex_.corners(f);
    if (std::find(t.begin(), t.end(), kept) != t.end()) continue;
    for (const Index w : t)
      if (w != gone && length(w, kept) > kLong * std::max(wanted(w, kept), length(w, gone))) return false;
    changed.push_back(with_corner(f, gone, balls_[uz(kept)], allowed_[uz(kept)]));
    if (turned_over(corners(f), changed.back().corners)) return false;
  }
  const Patch before = patch_of(complex_.faces_of(gone));
  Patch after = quality_of_all(changed);
  if (after.worst < std::min(before.worst, kCollapseQuality)) return false;
  const bool better = after.sum * count(complex_.faces_of(gone)) > before.sum * count(changed);
  if (complex_.freedom(gone) == Freedom::kCurve && !better) return false;
  if (!covered(gone, balls_[uz(kept)], changed)) return false;
  measure_deviation(changed, after);
  if (after.excess > before.excess) return false;
  complex_.collapse(gone, kept);
  keep_deviations(changed);
  return true;
}

// ---- flips

void Remesher::flip_edges() {
  for (const auto& [a, b] : complex_.edges())
    if (complex_.is_edge(a, b) && flip(a, b)) ++flips_;
}

bool Remesher::flip(Index a, Index b) {
  if (!complex_.can_flip(a, b)) return false;
  const std::vector<Index> faces = complex_.faces_of_edge(a, b);
  const auto apex = [&](Index f) {
    for (const Index v : complex_.corners(f))
      if (v != a && v != b) return v;
    return kInvalid;
  };
  const Ball &pa = balls_[uz(a)], &pb = balls_[uz(b)], &pc = balls_[uz(apex(faces[0]))],
             &pd = balls_[uz(apex(faces[1]))];
  const Corners abc{pa, pb, pc}, bad{pb, pa, pd}, adc{pa, pd, pc}, bcd{pb, pc, pd};
  const double worst_before = std::min(quality_of(abc), quality_of(bad));
  if (std::min(quality_of(adc), quality_of(bcd)) < worst_before + kFlipGain) return false;
  if (worst_before > kNoNormal && turned(normal_of(abc), normal_of(bad), kFlat)) return false;
  const Vec3 up = normal_of(abc) + normal_of(bad);
  if (turned(up, normal_of(adc), kFold) || turned(up, normal_of(bcd), kFold)) return false;
  const double allowed_there = (allowed(faces[0]) + allowed(faces[1])) / 2;
  // The first face keeps a, the second b (SheetComplex::flip).
  std::vector<Changed> changed = {{faces[0], adc, allowed_there, 0}, {faces[1], bcd, allowed_there, 0}};
  Patch after;
  measure_deviation(changed, after);
  if (after.excess > patch_of(faces).excess) return false;
  complex_.flip(a, b);
  keep_deviations(changed);
  return true;
}

// ---- smoothing

bool Remesher::on_border(Index v) const {
  return complex_.freedom(v) == Freedom::kCurve &&
         complex_.faces_of_edge(v, complex_.curve_neighbors(v)[0]).size() == 1;
}

// Whether a vertex moves when smoothed.
bool Remesher::slides(Index v) const {
  return complex_.vertex_alive(v) && (complex_.freedom(v) == Freedom::kSheet || spaced(v) || on_border(v));
}

// Greedy colouring: no two vertices of a set are neighbours, so that they can move at once.
std::vector<std::vector<Index>> Remesher::independent_sets() const {
  std::vector<std::vector<Index>> sets;
  std::vector<Index> color(uz(complex_.vertices()), kInvalid);
  for (Index v = 0; v < complex_.vertices(); ++v) {
    if (!slides(v)) continue;
    std::vector<bool> taken(sets.size() + 1, false);
    for (const Index w : complex_.neighbors(v))
      if (color[uz(w)] != kInvalid) taken[uz(color[uz(w)])] = true;
    const auto free = std::find(taken.begin(), taken.end(), false);
    color[uz(v)] = static_cast<Index>(free - taken.begin());
    if (uz(color[uz(v)]) == sets.size()) sets.emplace_back();
    sets[uz(color[uz(v)])].push_back(v);
  }
  return sets;
}

void Remesher::smooth() {
  const std::vector<std::vector<Index>> sets = independent_sets();
  // Vertices that did not move and around which nothing has moved since would not move now.
  std::vector<char> settled(uz(complex_.vertices()), 0);
  for (int step = 0; step < kSmoothingSteps; ++step)
    for (const std::vector<Index>& set : sets) {
      parallel_for(context_, count(set), kGrain, [&](Index begin, Index end) {
        for (Index k = begin; k < end; ++k) {
          const Index v = set[uz(k)];
          if (!settled[uz(v)]) settled[uz(v)] = move(v) ? kMoved : kSettled;
        }
      });
      for (const Index v : set) {
        if (settled[uz(v)] != kMoved) continue;
        ++moves_;
        settled[uz(v)] = 0;
        for (const Index w : complex_.neighbors(v)) settled[uz(w)] = 0;
      }
    }
}

// Where a vertex might go: on a curve the middle between its neighbours; in a sheet the mean of its triangles'
// centroids, weighted with their area in units of the wanted length, and the mean of its neighbours.
std::vector<Vec3> Remesher::aims(Index v) const {
  if (complex_.freedom(v) == Freedom::kCurve)
    return {lerp(at(complex_.curve_neighbors(v)[0]), at(complex_.curve_neighbors(v)[1]), 0.5)};
  Vec3 centroids, neighbors;
  double weights = 0;
  for (const Index f : complex_.faces_of(v)) {
    const auto& [a, b, c] = complex_.corners(f);
    const double size = (size_[uz(a)] + size_[uz(b)] + size_[uz(c)]) / 3;
    const double weight = triangle_area(at(a), at(b), at(c)) / (size * size);
    const Vec3 sum = at(a) + at(b) + at(c);
    centroids += sum * (weight / 3);
    weights += weight;
    neighbors += (sum - at(v)) / (2 * static_cast<double>(complex_.faces_of(v).size()));
  }
  if (!(weights > 0)) return {neighbors};
  return {centroids / weights, neighbors};
}

// The direction of the curve, or the normal of the sheet, at a vertex.
Vec3 Remesher::axis_at(Index v) const {
  if (complex_.freedom(v) == Freedom::kCurve)
    return normalized(at(complex_.curve_neighbors(v)[1]) - at(complex_.curve_neighbors(v)[0]));
  Vec3 up;
  for (const Index f : complex_.faces_of(v)) {
    const Vec3 normal = normal_of(corners(f));
    up += dot(normal, up) < 0 ? -normal : normal;
  }
  return normalized(up);
}

// Of the aims, and the ways half there, along the tangent, the one with the best triangles, if better than now or if
// the spacing counts. The projection, which costs more than all of this, is made once.
bool Remesher::move(Index v) {
  const Vec3 axis = axis_at(v);
  const bool on_curve = complex_.freedom(v) == Freedom::kCurve;
  const bool spacing_counts = spaced(v);
  double best = patch_of(complex_.faces_of(v)).sum;
  std::optional<Vec3> guess;
  for (const Vec3& aim : aims(v))
    for (const double part : {1.0, 0.5}) {
      const Vec3 way = (aim - at(v)) * part;
      const Vec3 along = axis * dot(way, axis);
      const Vec3 step = on_curve ? along : way - along;
      if (norm(step) < kStill * target_) continue;
      double sum = 0;
      for (const Index f : complex_.faces_of(v)) sum += quality_of(corners_with(f, v, {at(v) + step, 0}));
      if (sum > best || (spacing_counts && !guess)) best = sum, guess = at(v) + step;
    }
  return guess && move_to(v, *guess);
}

bool Remesher::move_to(Index v, const Vec3& guess) {
  const bool on_curve = complex_.freedom(v) == Freedom::kCurve;
  std::optional<Ball> ball;
  if (on_curve && axis_.on_curve) ball = near(axis_.on_curve(guess, {origin_[uz(v)], origin_[uz(v)]}), guess);
  if (!ball && !spaced(v)) ball = near(axis_.on_sheet(guess, origin_[uz(v)], sheet_at(v)), guess);
  if (!ball) return false;
  std::vector<Changed> changed;
  for (const Index f : complex_.faces_of(v)) {
    changed.push_back(with_corner(f, v, *ball, allowed_[uz(v)]));
    if (turned_over(corners(f), changed.back().corners)) return false;
  }
  const Patch before = patch_of(complex_.faces_of(v));
  Patch after = quality_of_all(changed);
  if (after.worst < std::min(before.worst, kSmoothQuality)) return false;
  if (!spaced(v) && after.sum < before.sum) return false;
  if (on_curve && !covered(v, *ball, changed)) return false;
  measure_deviation(changed, after);
  if (after.excess > before.excess) return false;
  balls_[uz(v)] = *ball;
  keep_deviations(changed);
  return true;
}

RemeshResult Remesher::result() const {
  RemeshResult result;
  std::vector<Index> number(uz(complex_.vertices()), kInvalid);
  for (Index v = 0; v < complex_.vertices(); ++v) {
    if (!complex_.vertex_alive(v)) continue;
    number[uz(v)] = count(result.mesh.centers);
    result.mesh.centers.push_back(at(v));
    result.mesh.radii.push_back(balls_[uz(v)].radius);
    result.mesh.types.push_back(types_[uz(v)]);
    result.origin.push_back(origin_[uz(v)]);
  }
  // The numbers ascend with the ids, so that simplices stay sorted.
  result.mesh.edges = complex_.edges();
  for (Edge& e : result.mesh.edges)
    for (Index& v : e) v = number[uz(v)];
  std::vector<std::pair<Triangle, Index>> faces;
  for (Index f = 0; f < complex_.faces(); ++f) {
    if (!complex_.face_alive(f)) continue;
    Triangle t = complex_.corners(f);
    for (Index& v : t) v = number[uz(v)];
    std::sort(t.begin(), t.end());
    faces.push_back({t, complex_.sheet(f)});
  }
  std::sort(faces.begin(), faces.end());
  for (const auto& [t, sheet] : faces) {
    result.mesh.faces.push_back(t);
    result.sheet_of_face.push_back(sheet);
  }
  result.vertex_of_input.assign(number.begin(), number.begin() + count(input_.mesh.centers));
  result.splits = splits_;
  result.collapses = collapses_;
  result.flips = flips_;
  result.moves = moves_;
  return result;
}

}  // namespace

RemeshResult remesh(const StratifiedMesh& input, const AxisOracle& axis, const RemeshOptions& options,
                    const Context& context) {
  Remesher remesher(input, axis, options, context);
  for (int round = 0; round < options.rounds; ++round) {
    context.check();
    remesher.round();
  }
  return remesher.result();
}

}  // namespace matstruct
