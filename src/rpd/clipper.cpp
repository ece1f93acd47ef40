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

Bisector bisector(const std::vector<WeightedPoint>& spheres, Index self, Index other) {
  const WeightedPoint &m = spheres[uz(self)], &n = spheres[uz(other)];
  const Vec3 d = n.center - m.center;
  const double length2 = norm2(d);
  return {other, 2 * d, 2 * kRoundUp * std::sqrt(length2), length2 - (n.weight - m.weight),
          length2 + std::abs(n.weight) + std::abs(m.weight)};
}

bool Clipper::clip(const std::array<Vec3, 4>& corners, const std::vector<WeightedPoint>& spheres, Index self,
                   std::span<const Bisector> bisectors) {
  spheres_ = &spheres;
  self_ = self;
  center_ = spheres[uz(self)].center;
  corners_ = corners;
  broken_ = measured_ = false;
  start_from_tet();
  collect_planes(bisectors);
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
void Clipper::collect_planes(std::span<const Bisector> bisectors) {
  const Vec3 middle = 0.25 * (corners_[0] + corners_[1] + corners_[2] + corners_[3]);
  double reach = 0, radius2 = 0;
  for (const Vec3& c : corners_) {
    reach = std::max(reach, norm1(c - center_));
    radius2 = std::max(radius2, distance2(c, middle));
  }
  const double radius = kRoundUp * std::sqrt(radius2);
  const Vec3 offset = middle - center_;
  planes_cut_.clear();
  cuts_.clear();
  for (const Bisector& b : bisectors) {
    const double rounding = kBisectorError * (b.magnitude + b.steepness * reach);
    const double at_middle = b.constant - dot(b.gradient, offset);
    if (at_middle > 2 * rounding + b.steepness * radius) continue;
    const Cut cut{at_middle / b.steepness, kFirstBisector + static_cast<int>(planes_cut_.size())};
    planes_cut_.push_back({b, rounding});
    std::size_t place = cuts_.size();
    cuts_.push_back(cut);
    for (; place > 0 && cut.distance < cuts_[place - 1].distance; --place) cuts_[place] = cuts_[place - 1];
    cuts_[place] = cut;
  }
}

int Clipper::side(std::size_t vertex, const Plane& plane) const {
  const PieceVertex& v = vertices_[vertex];
  const WeightedPoint& other = (*spheres_)[uz(plane.bisector.other)];
  if (arithmetic_ == Arithmetic::kPlain) return power_side_inexact(name(v), other);
  const double bound = plane.rounding + plane.bisector.steepness * v.error;
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
  const Plane& p = at(plane);
  const std::size_t old_count = vertices_.size();
  values_.resize(old_count);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < old_count; ++v) {
    values_[v] = value(p.bisector, vertices_[v].point);
    least = std::min(least, values_[v]);
  }
  const double bound = p.rounding + p.bisector.steepness * greatest_error_;
  const bool exact = arithmetic_ == Arithmetic::kExact;
  if (exact && least > bound) return;

  kept_.resize(old_count);
  removed_.clear();
  for (std::size_t v = 0; v < old_count; ++v) {
    const bool clear = exact && std::abs(values_[v]) > bound;
    kept_[v] = clear ? values_[v] > 0 : side(v, p) >= 0;
    if (!kept_[v]) removed_.push_back(static_cast<std::int32_t>(v));
  }
  if (removed_.empty()) return;
  if (removed_.size() == old_count) {
    vertices_.clear();
    return;
  }
  find_crossings(plane);
  replace_removed();
  link_crossings();
  fill_holes();
}

// A new vertex on every edge from a kept to a removed vertex.
void Clipper::find_crossings(int plane) {
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
      place(c.vertex, a, removed, at(plane));
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
void Clipper::place(PieceVertex& v, std::size_t kept, std::size_t removed, const Plane& plane) {
  const PieceVertex &p = vertices_[kept], &q = vertices_[removed];
  const double span = values_[kept] - values_[removed];
  const Vec3 along = q.point - p.point;
  const double end_error = std::max(p.error, q.error);
  const double length = kRoundUp * norm(along) + 2 * end_error;
  const double delta = plane.rounding + plane.bisector.steepness * end_error;
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
  open_.resize(planes_cut_.size() + kFirstBisector, kInvalid);
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

// Facets are fans of triangles from one of their vertices (the pole) to their edges, and the piece is made of the tets
// from its middle to these triangles, so that one pass over the edges finds everything.
void Clipper::measure() {
  measured_ = true;
  const std::size_t plane_count = planes_cut_.size() + kFirstBisector;
  poles_.assign(plane_count, kInvalid);
  areas_.assign(plane_count, 0);
  Vec3 middle;
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(vertices_.size()); ++v) {
    middle += vertices_[uz(v)].point;
    for (const std::int32_t p : vertices_[uz(v)].planes)
      if (poles_[uz(p)] == kInvalid) poles_[uz(p)] = v;
  }
  middle = middle / static_cast<double>(vertices_.size());
  planes_.clear();
  for (int p = 0; p < static_cast<int>(plane_count); ++p)
    if (poles_[uz(p)] != kInvalid) planes_.push_back(p);
  double sum = 0;
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(vertices_.size()); ++v)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t w = vertices_[uz(v)].neighbors[k];
      if (w < v) continue;
      const Vec3 &a = vertices_[uz(v)].point, &b = vertices_[uz(w)].point;
      const Vec3 twice = cross(a - middle, b - middle);
      for (std::size_t j = 0; j < 3; ++j) {
        if (j == k) continue;
        const std::int32_t p = vertices_[uz(v)].planes[j];
        const Vec3& pole = vertices_[uz(poles_[uz(p)])].point;
        sum += std::abs(dot(twice, pole - middle));
        if (p >= kFirstBisector && self_ < at(p).bisector.other)
          areas_[uz(p)] += std::abs(dot(cross(a - pole, b - pole), at(p).bisector.gradient));
      }
    }
  volume_ = sum / 6;
}

const std::vector<int>& Clipper::planes() {
  if (!measured_) measure();
  return planes_;
}

double Clipper::area(int plane) {
  if (!measured_) measure();
  return areas_[uz(plane)] / (2 * norm(at(plane).bisector.gradient));
}

double Clipper::volume() {
  if (!measured_) measure();
  return volume_;
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
