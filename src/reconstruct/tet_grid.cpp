#include "reconstruct/tet_grid.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace matstruct {

namespace {

std::int64_t length2(const GridPoint& a, const GridPoint& b) {
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t step = std::int64_t{a[k]} - b[k];
    sum += step * step;
  }
  return sum;
}

GridPoint moved(GridPoint at, std::size_t axis, std::int32_t by) {
  at[axis] += by;
  return at;
}

Vec3 vector(const GridPoint& at) {
  return {double(at[0]), double(at[1]), double(at[2])};
}

/// Positive if `x` is on the positive side of the plane of a, b, c.
double side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x) {
  return dot(cross(b - a, c - a), x - a);
}

}  // namespace

TetGrid::TetGrid() {
  std::array<std::size_t, 3> axes{0, 1, 2};
  do {
    const bool even = (axes[1] + 3 - axes[0]) % 3 == 1;
    for (std::int32_t x = 0; x < kSize; x += kCube)
      for (std::int32_t y = 0; y < kSize; y += kCube)
        for (std::int32_t z = 0; z < kSize; z += kCube) {
          GridPoint at{x, y, z};
          Tetrahedron tet;
          tet[0] = point(at);
          for (std::size_t k = 0; k < 3; ++k) tet[k + 1] = point(at = moved(at, axes[k], kCube));
          if (!even) std::swap(tet[2], tet[3]);
          roots_.push_back(longest_edge_first(tet));
        }
  } while (std::next_permutation(axes.begin(), axes.end()));
  tets_ = roots_;
}

std::uint64_t TetGrid::key(const GridPoint& at) {
  constexpr int kBits = 21;
  std::uint64_t bits = 0;
  for (const std::int32_t c : at) bits = bits << kBits | static_cast<std::uint64_t>(c);
  return bits;
}

bool TetGrid::inside(const GridPoint& at) {
  return std::all_of(at.begin(), at.end(), [](std::int32_t c) { return c >= 0 && c <= kSize; });
}

Index TetGrid::point(const GridPoint& at) {
  const auto [found, added] = index_.try_emplace(key(at), count(points_));
  if (added) points_.push_back(at);
  return found->second;
}

GridPoint TetGrid::halfway(Index a, Index b) const {
  GridPoint middle;
  for (std::size_t k = 0; k < 3; ++k) middle[k] = (points_[uz(a)][k] + points_[uz(b)][k]) / 2;
  return middle;
}

Index TetGrid::midpoint(Index a, Index b) {
  return point(halfway(a, b));
}

Tetrahedron TetGrid::longest_edge_first(const Tetrahedron& tet) const {
  // Each of the six edges with an even permutation that puts it first. The longest one is unique in this grid.
  constexpr std::array<std::array<std::size_t, 4>, 6> kOrders{
      {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};
  std::int64_t longest = 0;
  Tetrahedron result = tet;
  for (const auto& [a, b, c, d] : kOrders) {
    const std::int64_t length = length2(points_[uz(tet[a])], points_[uz(tet[b])]);
    if (length <= longest) continue;
    longest = length;
    result = {tet[a], tet[b], tet[c], tet[d]};
  }
  return result;
}

double TetGrid::size(const Tetrahedron& tet) const {
  return std::sqrt(static_cast<double>(length2(points_[uz(tet[0])], points_[uz(tet[1])])));
}

void TetGrid::mark(const Tetrahedron& tet) {
  for (std::size_t k = 0; k < 3; ++k)
    if ((points_[uz(tet[0])][k] + points_[uz(tet[1])][k]) % 2 != 0) return;
  marked_.push_back(halfway(tet[0], tet[1]));
}

std::optional<Tetrahedron> TetGrid::around(const Vec3& at) const {
  const auto holds = [&](const Tetrahedron& tet) {
    const std::array<Vec3, 4> p{vector(points_[uz(tet[0])]), vector(points_[uz(tet[1])]), vector(points_[uz(tet[2])]),
                                vector(points_[uz(tet[3])])};
    return side(p[0], p[1], p[2], at) >= 0 && side(p[0], p[2], p[3], at) >= 0 && side(p[0], p[3], p[1], at) >= 0 &&
           side(p[1], p[3], p[2], at) >= 0;
  };
  const auto root = std::find_if(roots_.begin(), roots_.end(), holds);
  if (root == roots_.end()) return std::nullopt;
  Tetrahedron tet = *root;
  while (is_split(halfway(tet[0], tet[1]))) {
    const auto [a, b, c, d] = tet;
    const GridPoint middle = halfway(a, b);
    const Index m = index_.at(key(middle));
    // The vertex b is on the positive side of the plane through the midpoint and the other two.
    const bool near_b = side(vector(middle), vector(points_[uz(c)]), vector(points_[uz(d)]), at) > 0;
    tet = longest_edge_first(near_b ? Tetrahedron{m, b, c, d} : Tetrahedron{a, m, c, d});
  }
  return tet;
}

bool TetGrid::mark_around(const Vec3& at, double smallest) {
  const auto tet = around(at);
  if (!tet || size(*tet) <= smallest) return false;
  mark(*tet);
  return true;
}

/// The tetrahedra around an edge come from bisections of their own. With h the lowest bit of the midpoint's
/// coordinates: the centre of a cube (all three have h) needs the midpoints of the cube's edges at the centre of the
/// next larger cube, that of a square the centres of the two cubes at it, that of a cube's edge those of its four
/// squares.
void TetGrid::split(const GridPoint& midpoint) {
  if (!split_.insert(key(midpoint)).second) return;
  fresh_.insert(key(midpoint));
  const std::int32_t bits = midpoint[0] | midpoint[1] | midpoint[2];
  const std::int32_t h = bits & -bits;
  const auto has = [&](std::size_t axis) { return (midpoint[axis] & h) != 0; };
  const int odd = int(has(0)) + int(has(1)) + int(has(2));
  if (odd == 3) {
    if (2 * h >= kCube) return;
    GridPoint even;    // the corner that is a corner of the next larger cube
    GridPoint center;  // the corner that is its centre
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t low = midpoint[k] - h, high = midpoint[k] + h;
      const bool low_is_even = (low & (2 * h)) == 0;
      even[k] = low_is_even ? low : high;
      center[k] = low_is_even ? high : low;
    }
    for (std::size_t k = 0; k < 3; ++k) split(moved(even, k, center[k] - even[k]));
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (has(k)) continue;
    for (const std::int32_t step : {-h, h})
      if (const GridPoint at = moved(midpoint, k, step); inside(at)) split(at);
  }
}

Index TetGrid::refine(Index first) {
  for (const GridPoint& midpoint : marked_) split(midpoint);
  marked_.clear();
  const auto must_open = [&](const Tetrahedron& tet) { return fresh_.contains(key(halfway(tet[0], tet[1]))); };
  std::vector<Tetrahedron> kept, open;
  Index unchanged = 0;
  for (Index t = 0; t < count(tets_); ++t) {
    const Tetrahedron& tet = tets_[uz(t)];
    const bool opens = must_open(tet);
    (opens ? open : kept).push_back(tet);
    if (!opens && t < first) ++unchanged;
  }
  while (!open.empty()) {
    const auto [a, b, c, d] = open.back();
    open.pop_back();
    const Index m = midpoint(a, b);
    for (const Tetrahedron& half : {Tetrahedron{m, b, c, d}, Tetrahedron{a, m, c, d}}) {
      const Tetrahedron tet = longest_edge_first(half);
      (must_open(tet) ? open : kept).push_back(tet);
    }
  }
  tets_ = std::move(kept);
  fresh_.clear();
  return unchanged;
}

}  // namespace matstruct
