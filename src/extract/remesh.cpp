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
constexpr Index kGrain = 32;

using Corners = std::array<Ball, 3>;

/// What an edit changes: triangles with their quality and how far they are off the axis.
struct Patch {
  double worst = 1, sum = 0;        // quality
  double excess = 0, farthest = 0;  // deviation from the axis beyond the tolerance, and at most
  void add(double quality, double deviation, double tolerated) {
    worst = std::min(worst, quality);
    sum += quality;
    excess += std::max(0.0, deviation - tolerated);
    farthest = std::max(farthest, deviation);
  }
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
    const Ball middle = ball_at(t[0], t[1], t[2], {1.0 / 3, 1.0 / 3, 1.0 / 3});
    return std::abs(axis_.distance(middle.center) - middle.radius);
  }
  double tolerated() const { return kDeviation * target_; }
  void add(Patch& patch, Index f) const { patch.add(quality_of(corners(f)), deviation_[uz(f)], tolerated()); }
  Patch star(Index v) const {
    Patch patch;
    for (const Index f : complex_.faces_of(v)) add(patch, f);
    return patch;
  }

  // ---- edits

  double wanted(Index a, Index b) const { return (size_[uz(a)] + size_[uz(b)]) / 2; }
  void update_sizes();
  std::optional<Ball> project(const Vec3& guess, Index near, Index sheet) const;
  std::optional<Ball> middle_of(const Edge& e) const;
  void split_long_edges();
  bool split(const Edge& e, const Ball& middle);
  void collapse_short_edges();
  bool collapse(Index gone, Index kept);
  bool covered(Index gone, Index kept, const std::vector<Corners>& after) const;
  void flip_edges();
  bool flip(Index a, Index b);
  void smooth();
  std::vector<std::vector<Index>> independent_sets() const;
  bool slides(Index v) const;
  Vec3 relaxed(Index v) const;
  bool move(Index v);

  const StratifiedMesh& input_;
  const AxisOracle& axis_;
  double target_;
  const Context& context_;
  SheetComplex complex_;
  std::vector<Ball> balls_;        // per vertex
  std::vector<SphereType> types_;  // per vertex
  std::vector<Index> origin_;      // per vertex: itself or a vertex of the input nearby
  std::vector<double> size_;       // per vertex: wanted edge length
  std::vector<double> deviation_;  // per face
  Index splits_ = 0, collapses_ = 0, flips_ = 0, moves_ = 0;
};

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

std::optional<Ball> Remesher::project(const Vec3& guess, Index near, Index sheet) const {
  std::optional<Ball> ball = axis_.on_sheet(guess, near, sheet);
  if (ball && distance(ball->center, guess) > kReach * target_) ball.reset();
  return ball;
}

// ---- splits

std::optional<Ball> Remesher::middle_of(const Edge& e) const {
  const auto& [a, b] = e;
  const Vec3 guess = lerp(at(a), at(b), 0.5);
  if (!complex_.is_curve_edge(a, b)) {
    const Index near = complex_.freedom(a) == Freedom::kSheet ? a : b;
    return project(guess, origin_[uz(near)], complex_.sheet(complex_.faces_of_edge(a, b).front()));
  }
  const bool fixed = complex_.freedom(a) == Freedom::kFixed && complex_.freedom(b) == Freedom::kFixed;
  if (fixed || !axis_.on_curve) return std::nullopt;
  std::optional<Ball> ball = axis_.on_curve(guess, {origin_[uz(a)], origin_[uz(b)]});
  if (ball && distance(ball->center, guess) > kReach * target_) ball.reset();
  return ball;
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
  Patch before, after;
  std::vector<double> new_deviations;
  for (const Index f : faces) {
    add(before, f);
    for (const Index end : {a, b}) {
      const Corners half = corners_with(f, end, middle);
      if (turned_over(corners(f), half)) return false;
      new_deviations.push_back(deviation(half));
      after.add(quality_of(half), new_deviations.back(), tolerated());
    }
  }
  if (after.farthest > std::max(before.farthest, tolerated())) return false;

  const bool on_curve = complex_.is_curve_edge(a, b);
  const Index first_new = complex_.faces();
  complex_.split(a, b);
  balls_.push_back(middle);
  types_.push_back(on_curve && faces.size() >= 3 ? SphereType::kSeam : SphereType::kSheet);
  origin_.push_back(origin_[uz(complex_.freedom(a) == Freedom::kFixed ? b : a)]);
  size_.push_back(wanted(a, b));
  // The old face keeps the end a, the new one has b (SheetComplex::split).
  deviation_.resize(deviation_.size() + faces.size());
  for (std::size_t k = 0; k < faces.size(); ++k) {
    deviation_[uz(faces[k])] = new_deviations[2 * k + 1];
    deviation_[uz(first_new) + k] = new_deviations[2 * k];
  }
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

// Whether the sphere of `gone` sticks out of what takes its place by no more than the tolerance. The hull of `after`
// holds a ball (c, r) up to the least of |c - c(w)| + r - r(w) over its balls; taken at their point nearest to c.
bool Remesher::covered(Index gone, Index kept, const std::vector<Corners>& after) const {
  const Ball& ball = balls_[uz(gone)];
  const auto sticks_out = [&](const Ball& a, const Ball& b, const Ball& c) {
    const PrimitiveHit hit = closest_on_triangle(ball.center, a.center, b.center, c.center);
    return hit.distance + ball.radius - ball_at(a, b, c, hit.weights).radius > kStickingOut * target_;
  };
  for (const auto& [a, b, c] : after)
    if (!sticks_out(a, b, c)) return true;
  for (const Index w : complex_.curve_neighbors(gone))
    if (w != kept && !sticks_out(balls_[uz(w)], balls_[uz(kept)], balls_[uz(kept)])) return true;
  return false;
}

bool Remesher::collapse(Index gone, Index kept) {
  if (!complex_.can_collapse(gone, kept)) return false;
  const Patch before = star(gone);
  std::vector<Index> changed;
  std::vector<Corners> after_corners;
  Patch after;
  for (const Index f : complex_.faces_of(gone)) {
    const Triangle& t = complex_.corners(f);
    if (std::find(t.begin(), t.end(), kept) != t.end()) continue;
    const Corners moved = corners_with(f, gone, balls_[uz(kept)]);
    if (turned_over(corners(f), moved)) return false;
    for (const Index w : t)
      if (w != gone && length(w, kept) > kLong * std::max(wanted(w, kept), length(w, gone))) return false;
    changed.push_back(f);
    after_corners.push_back(moved);
    after.add(quality_of(moved), 0, tolerated());
  }
  if (after.worst < std::min(before.worst, kCollapseQuality)) return false;
  if (complex_.freedom(gone) == Freedom::kCurve &&
      after.sum * count(complex_.faces_of(gone)) < before.sum * count(changed))
    return false;
  if (!covered(gone, kept, after_corners)) return false;
  std::vector<double> deviations;
  double excess = 0;
  for (const Corners& t : after_corners) {
    deviations.push_back(deviation(t));
    excess += std::max(0.0, deviations.back() - tolerated());
  }
  if (excess > before.excess) return false;
  complex_.collapse(gone, kept);
  for (std::size_t k = 0; k < changed.size(); ++k) deviation_[uz(changed[k])] = deviations[k];
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
  Patch before, after;
  for (const Index f : faces) add(before, f);
  const std::array<double, 2> deviations = {deviation(adc), deviation(bcd)};
  for (const double d : deviations) after.add(1, d, tolerated());
  if (after.excess > before.excess) return false;
  complex_.flip(a, b);  // the first face keeps a, the second b
  for (std::size_t k = 0; k < 2; ++k) deviation_[uz(faces[k])] = deviations[k];
  return true;
}

// ---- smoothing

// Whether a vertex moves when smoothed. Free borders slide with the sheet's projection if curves have none.
bool Remesher::slides(Index v) const {
  if (!complex_.vertex_alive(v) || complex_.freedom(v) == Freedom::kFixed) return false;
  return complex_.freedom(v) == Freedom::kSheet || axis_.on_curve ||
         complex_.faces_of_edge(v, complex_.curve_neighbors(v)[0]).size() == 1;
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
  for (int step = 0; step < kSmoothingSteps; ++step)
    for (const std::vector<Index>& set : sets) {
      std::vector<char> moved(set.size(), 0);
      parallel_for(context_, count(set), kGrain, [&](Index begin, Index end) {
        for (Index k = begin; k < end; ++k) moved[uz(k)] = move(set[uz(k)]) ? 1 : 0;
      });
      moves_ += static_cast<Index>(std::count(moved.begin(), moved.end(), 1));
    }
}

// Where a vertex should go: on a curve the middle between its neighbours, in a sheet the mean of its triangles'
// centroids, weighted with their area in units of the wanted length; both along the tangent only.
Vec3 Remesher::relaxed(Index v) const {
  const Vec3& x = at(v);
  if (complex_.freedom(v) == Freedom::kCurve) {
    const Vec3 &a = at(complex_.curve_neighbors(v)[0]), &b = at(complex_.curve_neighbors(v)[1]);
    const Vec3 tangent = normalized(b - a);
    return x + tangent * dot(lerp(a, b, 0.5) - x, tangent);
  }
  Vec3 sum, up;
  double weights = 0;
  for (const Index f : complex_.faces_of(v)) {
    const auto& [a, b, c] = complex_.corners(f);
    Vec3 normal = cross(at(b) - at(a), at(c) - at(a));
    const double size = (size_[uz(a)] + size_[uz(b)] + size_[uz(c)]) / 3;
    const double weight = norm(normal) / (size * size);
    sum += (at(a) + at(b) + at(c)) * (weight / 3);
    weights += weight;
    up += dot(normal, up) < 0 ? -normal : normal;
  }
  if (!(weights > 0)) return x;
  up = normalized(up);
  const Vec3 step = sum / weights - x;
  return x + step - up * dot(step, up);
}

bool Remesher::move(Index v) {
  const Vec3 guess = relaxed(v);
  if (distance(guess, at(v)) < kStill * target_) return false;
  const bool on_curve = complex_.freedom(v) == Freedom::kCurve;
  if (complex_.faces_of(v).empty() && !axis_.on_curve) return false;
  std::optional<Ball> ball = on_curve && axis_.on_curve
                                 ? axis_.on_curve(guess, {origin_[uz(v)], origin_[uz(v)]})
                                 : project(guess, origin_[uz(v)], complex_.sheet(complex_.faces_of(v).front()));
  if (!ball || distance(ball->center, guess) > kReach * target_) return false;
  const Patch before = star(v);
  Patch after;
  std::vector<double> deviations;
  std::vector<Corners> after_corners;
  for (const Index f : complex_.faces_of(v)) {
    after_corners.push_back(corners_with(f, v, *ball));
    const Corners& t = after_corners.back();
    if (turned_over(corners(f), t)) return false;
    after.add(quality_of(t), 0, tolerated());
  }
  if (after.worst < std::min(before.worst, kSmoothQuality) || after.sum < before.sum) return false;
  for (const Corners& t : after_corners) deviations.push_back(deviation(t));
  double excess = 0;
  for (const double d : deviations) excess += std::max(0.0, d - tolerated());
  if (excess > before.excess) return false;
  if (on_curve && !covered(v, kInvalid, after_corners)) return false;
  balls_[uz(v)] = *ball;
  std::size_t k = 0;
  for (const Index f : complex_.faces_of(v)) deviation_[uz(f)] = deviations[k++];
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
  }
  // The numbers ascend with the ids, so that simplices stay sorted.
  result.mesh.edges = complex_.edges();
  for (Edge& e : result.mesh.edges)
    for (Index& v : e) v = number[uz(v)];
  result.mesh.faces = complex_.triangles();
  for (Triangle& f : result.mesh.faces)
    for (Index& v : f) v = number[uz(v)];
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
