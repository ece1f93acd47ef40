#include "rpd/clipper.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "base/tolerances.h"

namespace matstruct {

namespace {

constexpr double kUnit = 0x1.0p-53;
// Error of a bisector's value relative to its terms' absolute sum: three products of rounded differences and their sums
// stay below 10 u.
constexpr double kBisectorError = 16 * kUnit;
// Error of an interpolated point relative to its ends' absolute coordinates: rounding of the parameter and of one
// product and two sums per coordinate.
constexpr double kInterpolationError = 8 * kUnit;
// More than the relative rounding of a norm.
constexpr double kRoundUp = 1 + 8 * kUnit;

double norm1(const Vec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

}  // namespace

bool Clipper::clip(const std::array<Vec3, 4>& corners, const std::vector<WeightedPoint>& spheres, Index self,
                   std::span<const Index> neighbors) {
  spheres_ = &spheres;
  self_ = self;
  center_ = spheres[uz(self)].center;
  corners_ = corners;
  broken_ = measured_ = false;
  start_from_tet();
  collect_bisectors(spheres, neighbors);
  for (std::size_t n = 0; n < cuts_.size() && !vertices_.empty(); ++n) cut(cuts_[n].plane);
  return !vertices_.empty();
}

void Clipper::start_from_tet() {
  vertices_.resize(4);
  for (std::int32_t k = 0; k < 4; ++k) {
    PieceVertex& v = vertices_[uz(k)];
    for (std::int32_t p = 0, n = 0; p < 4; ++p)
      if (p != k) v.planes[uz(n)] = v.neighbors[uz(n)] = p, ++n;
    v.point = corners_[uz(k)];
    v.error = 0;
  }
  greatest_error_ = 0;
}

// The bisectors that may meet the tet, those that cut off most first: the others then miss what is left. Most are
// rejected by the tet's circumscribed ball about its middle.
void Clipper::collect_bisectors(const std::vector<WeightedPoint>& spheres, std::span<const Index> neighbors) {
  const Vec3 middle = 0.25 * (corners_[0] + corners_[1] + corners_[2] + corners_[3]);
  double reach = 0, radius2 = 0;
  for (const Vec3& c : corners_) {
    reach = std::max(reach, norm1(c - center_));
    radius2 = std::max(radius2, distance2(c, middle));
  }
  const double weight = spheres[uz(self_)].weight;
  bisectors_.clear();
  cuts_.clear();
  for (const Index other : neighbors) {
    const WeightedPoint& m = spheres[uz(other)];
    const Vec3 d = m.center - center_;
    const double length2 = norm2(d), steepness = 2 * norm1(d);
    const double constant = length2 - (m.weight - weight);
    const double rounding = kBisectorError * (length2 + std::abs(m.weight) + std::abs(weight) + steepness * reach);
    const double at_middle = constant - 2 * dot(d, middle - center_);
    const double surplus = at_middle - 2 * rounding;
    if (surplus > 0 && surplus * surplus > kRoundUp * (4 * length2) * radius2) continue;
    const Cut cut{at_middle / steepness, kFirstBisector + static_cast<int>(bisectors_.size())};
    Bisector& b = bisectors_.emplace_back();
    b.other = other;
    b.gradient = 2 * d;
    b.steepness = steepness;
    b.constant = constant;
    b.rounding = rounding;
    std::size_t place = cuts_.size();
    cuts_.push_back(cut);
    for (; place > 0 && cut.distance < cuts_[place - 1].distance; --place) cuts_[place] = cuts_[place - 1];
    cuts_[place] = cut;
  }
}

int Clipper::side(std::size_t vertex, const Bisector& b) const {
  const PieceVertex& v = vertices_[vertex];
  const WeightedPoint& other = (*spheres_)[uz(b.other)];
  if (arithmetic_ == Arithmetic::kPlain) return power_side_inexact(name(v), other);
  const double bound = b.rounding + b.steepness * v.error;
  if (values_[vertex] > bound) return 1;
  if (values_[vertex] < -bound) return -1;
  return power_side(name(v), other);
}

PowerVertex Clipper::name(const PieceVertex& v) const {
  PowerVertex result;
  std::array<bool, 4> on_facet{};
  result.spheres[0] = (*spheres_)[uz(self_)];
  for (const std::int32_t p : v.planes) {
    if (p < kFirstBisector)
      on_facet[uz(p)] = true;
    else
      result.spheres[uz(++result.k)] = (*spheres_)[uz(sphere_of_plane(p))];
  }
  for (std::size_t k = 0, n = 0; k < 4; ++k)
    if (!on_facet[k]) result.simplex[n++] = corners_[k];
  return result;
}

void Clipper::cut(int plane) {
  Bisector& b = bisectors_[uz(plane - kFirstBisector)];
  const std::size_t old_count = vertices_.size();
  values_.resize(old_count);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < old_count; ++v) {
    values_[v] = value(b, vertices_[v].point);
    least = std::min(least, values_[v]);
  }
  if (arithmetic_ == Arithmetic::kExact && least > b.rounding + b.steepness * greatest_error_) return;

  kept_.resize(old_count);
  removed_.clear();
  for (std::size_t v = 0; v < old_count; ++v) {
    kept_[v] = side(v, b) >= 0;
    if (!kept_[v]) removed_.push_back(static_cast<std::int32_t>(v));
  }
  if (removed_.empty()) return;
  if (removed_.size() == old_count) {
    vertices_.clear();
    return;
  }
  b.steepness = kRoundUp * norm(b.gradient);
  find_crossings(plane, b);
  replace_removed();
  link_crossings();
  fill_holes();
}

// A new vertex on every edge from a kept to a removed vertex.
void Clipper::find_crossings(int plane, const Bisector& b) {
  crossings_.clear();
  for (std::size_t a = 0; a < kept_.size(); ++a) {
    if (!kept_[a]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t removed = uz(vertices_[a].neighbors[k]);
      if (kept_[removed]) continue;
      Crossing& c = crossings_.emplace_back();
      c.edge = k;
      c.vertex.planes = {vertices_[a].planes[k == 0 ? 1 : 0], vertices_[a].planes[k == 2 ? 1 : 2], plane};
      c.vertex.neighbors = {kInvalid, kInvalid, static_cast<std::int32_t>(a)};
      place(c.vertex, a, removed, b);
    }
  }
}

// New vertices take the places of removed ones, then new places.
void Clipper::replace_removed() {
  for (std::size_t n = 0; n < crossings_.size(); ++n) {
    Crossing& c = crossings_[n];
    if (n < removed_.size()) {
      c.place = removed_[n];
      vertices_[uz(c.place)] = c.vertex;
    } else {
      c.place = static_cast<std::int32_t>(vertices_.size());
      vertices_.push_back(c.vertex);
    }
    vertices_[uz(c.vertex.neighbors[2])].neighbors[c.edge] = c.place;
  }
}

// The point x where the edge from vertex p (kept) to q (removed) meets the bisector. Let F be the bisector's value, of
// gradient g; true ends p', q' at most e from the computed ones; f what was computed of F at p and q, wrong by at most
// rho; x' the true point. x = p + t (q - p), t = f_p / (f_p - f_q), has |F(x)| <= rho. With y the point of parameter t
// on the true edge, of direction L = q' - p', x' = y - L F(y) / g.L and F(y) = F(x) - g.(x - y), so that
//     x - x' = (x - y) - L g.(x - y) / g.L + L F(x) / g.L,
// a projection along L, of norm |L| |g| / |g.L|, and a shift: |x - x'| <= |L| (|g| |x - y| + rho) / |g.L|. If delta =
// |g| e + rho is less than an eighth of f_p - f_q, then |g.L| >= f_p - f_q - 2 delta, and t leaves [0, 1] by no more
// than delta / (f_p - f_q), which gives the bound below. Otherwise x is only known to be on the edge.
void Clipper::place(PieceVertex& v, std::size_t kept, std::size_t removed, const Bisector& b) {
  const PieceVertex &p = vertices_[kept], &q = vertices_[removed];
  const double span = values_[kept] - values_[removed];
  const Vec3 along = q.point - p.point;
  const double end_error = std::max(p.error, q.error);
  const double length = kRoundUp * norm(along) + 2 * end_error;
  const double delta = b.rounding + b.steepness * end_error;
  if (8 * delta < span) {
    v.point = p.point + (values_[kept] / span) * along;
    v.error = length * delta / (span - 4 * delta);
  } else {
    v.point = p.point + 0.5 * along;
    v.error = length;
  }
  v.error += kInterpolationError * (norm1(p.point) + norm1(q.point));
  if (!(v.error <= tolerance::kClippedVertex)) {
    const LocatedVertex at = locate(name(v), tolerance::kClippedVertex);
    v.point = at.point;
    v.error = at.error;
  }
  greatest_error_ = std::max(greatest_error_, v.error);
}

// The new facet's edges: two new vertices that share one of the old planes are neighbours.
void Clipper::link_crossings() {
  open_.resize(bisectors_.size() + kFirstBisector, kInvalid);
  for (const Crossing& c : crossings_)
    for (std::int32_t k = 0; k < 2; ++k) {
      std::int32_t& open = open_[uz(c.vertex.planes[uz(1 - k)])];
      if (open == kInvalid) {
        open = 2 * c.place + k;
        continue;
      }
      vertices_[uz(c.place)].neighbors[uz(k)] = open / 2;
      vertices_[uz(open / 2)].neighbors[uz(open % 2)] = c.place;
      open = kInvalid;
    }
  for (const Crossing& c : crossings_)
    for (std::size_t k = 0; k < 2; ++k)
      if (std::int32_t& n = vertices_[uz(c.place)].neighbors[k]; n == kInvalid) {
        broken_ = true;
        open_[uz(c.vertex.planes[1 - k])] = kInvalid;
        n = c.place;
      }
}

// The last vertices move into what places removed vertices have left, so that there are none.
void Clipper::fill_holes() {
  for (std::size_t n = removed_.size(); n > crossings_.size(); --n) {
    const std::int32_t hole = removed_[n - 1];
    const auto last = static_cast<std::int32_t>(vertices_.size()) - 1;
    if (hole != last) {
      vertices_[uz(hole)] = vertices_[uz(last)];
      for (std::int32_t& neighbor : vertices_[uz(hole)].neighbors)
        if (neighbor == last)
          neighbor = hole;
        else
          std::replace(vertices_[uz(neighbor)].neighbors.begin(), vertices_[uz(neighbor)].neighbors.end(), last, hole);
    }
    vertices_.pop_back();
  }
}

// Facets are fans of triangles from one of their vertices (the pole) to the edges that avoid it, so that one pass over
// the edges finds all areas.
void Clipper::measure() {
  measured_ = true;
  const std::size_t plane_count = bisectors_.size() + kFirstBisector;
  poles_.assign(plane_count, kInvalid);
  areas_.assign(plane_count, {});
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(vertices_.size()); ++v)
    for (const std::int32_t p : vertices_[uz(v)].planes)
      if (poles_[uz(p)] == kInvalid) poles_[uz(p)] = v;
  planes_.clear();
  for (int p = 0; p < static_cast<int>(plane_count); ++p)
    if (poles_[uz(p)] != kInvalid) planes_.push_back(p);
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(vertices_.size()); ++v)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t w = vertices_[uz(v)].neighbors[k];
      if (w < v) continue;
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t p = uz(vertices_[uz(v)].planes[j]);
        const std::int32_t pole = poles_[p];
        if (j == k || pole == v || pole == w) continue;
        const Vec3& origin = vertices_[uz(pole)].point;
        const Vec3 twice = cross(vertices_[uz(v)].point - origin, vertices_[uz(w)].point - origin);
        areas_[p] += (dot(twice, areas_[p]) < 0 ? -0.5 : 0.5) * twice;
      }
    }
}

const std::vector<int>& Clipper::planes() {
  if (!measured_) measure();
  return planes_;
}

Vec3 Clipper::area_vector(int plane) {
  if (!measured_) measure();
  return areas_[uz(plane)];
}

double Clipper::volume() {
  Vec3 middle;
  for (const PieceVertex& v : vertices_) middle += v.point;
  middle = middle / static_cast<double>(vertices_.size());
  double sum = 0;
  for (const int p : planes()) sum += std::abs(dot(areas_[uz(p)], vertices_[uz(poles_[uz(p)])].point - middle));
  return sum / 3;
}

void Clipper::polygon(int plane, std::vector<int>& polygon) const {
  polygon.clear();
  const auto on_plane = [&](const PieceVertex& v) {
    return v.planes[0] == plane || v.planes[1] == plane || v.planes[2] == plane;
  };
  int start = 0;
  while (!on_plane(vertices_[uz(start)])) ++start;
  int previous = kInvalid, current = start;
  do {
    polygon.push_back(current);
    const PieceVertex& v = vertices_[uz(current)];
    int next = kInvalid;
    for (std::size_t k = 0; k < 3; ++k)
      if (v.planes[k] != plane && v.neighbors[k] != previous && (next == kInvalid || previous == kInvalid))
        next = v.neighbors[k];
    previous = current;
    current = next;
  } while (current != start && current != kInvalid && polygon.size() <= vertices_.size());
}

}  // namespace matstruct
