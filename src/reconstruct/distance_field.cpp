#include "reconstruct/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/index.h"

namespace matstruct {

namespace {

/// Side of the grid, relative to the longest side of the box: room for level sets outside of it.
constexpr double kRoom = 1.2;
/// No point of a tetrahedron is further than this, times its longest edge, from its vertices and the middles of edges.
constexpr double kReach = 0.35;

}  // namespace

DistanceField::DistanceField(const MedialTree& tree, const Vec3& low, const Vec3& high, const Resolution& resolution,
                             const Context& context)
    : tree_(tree), resolution_(resolution), context_(context) {
  const Vec3 extent = high - low;
  const double side = kRoom * std::max({extent.x, extent.y, extent.z}) + 2 * resolution.level;
  unit_ = side / TetGrid::kSize;
  origin_ = (low + high) / 2 - Vec3{side, side, side} / 2;
}

void DistanceField::refine() {
  while (seen_ < count(grid_.tets())) {
    context_.check();
    evaluate();
    // Midpoints are made in order, and evaluated in parallel.
    const std::vector<Tetrahedron> tets(grid_.tets().begin() + seen_, grid_.tets().end());
    std::vector<std::array<Index, 6>> midpoints(tets.size());
    for (std::size_t t = 0; t < tets.size(); ++t)
      if (may_split(tets[t])) midpoints[t] = midpoints_of(tets[t]);
    evaluate();
    for (std::size_t t = 0; t < tets.size(); ++t)
      if (may_split(tets[t]) && must_split(tets[t], midpoints[t])) grid_.mark(tets[t]);
    seen_ = grid_.refine(count(grid_.tets()));
  }
}

bool DistanceField::divide_around(const std::vector<Vec3>& points, double size) {
  bool divided = false;
  for (;;) {
    bool marked = false;
    for (const Vec3& x : points) marked |= grid_.mark_around((x - origin_) / unit_, size / unit_);
    if (!marked) return divided;
    seen_ = grid_.refine(seen_);
    divided = true;
  }
}

std::vector<Vec3> DistanceField::places() const {
  std::vector<Vec3> result;
  result.reserve(grid_.points().size());
  for (const GridPoint& at : grid_.points()) result.push_back(place(at));
  return result;
}

void DistanceField::evaluate() {
  std::vector<Vec3> added;
  for (std::size_t p = values_.size(); p < grid_.points().size(); ++p) added.push_back(place(grid_.points()[p]));
  const std::vector<double> distances = tree_.distances(added, context_);
  values_.insert(values_.end(), distances.begin(), distances.end());
}

/// Whether the tetrahedron is long enough and may cross the level set: the distance changes at most as much as one
/// moves.
bool DistanceField::may_split(const Tetrahedron& tet) const {
  const double reach = length(tet);
  return reach > resolution_.finest && std::all_of(tet.begin(), tet.end(), [&](Index p) {
           return std::abs(values_[uz(p)] - resolution_.level) <= reach;
         });
}

std::array<Index, 6> DistanceField::midpoints_of(const Tetrahedron& tet) {
  std::array<Index, 6> result{};
  std::size_t k = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) result[k++] = grid_.midpoint(tet[i], tet[j]);
  return result;
}

bool DistanceField::must_split(const Tetrahedron& tet, const std::array<Index, 6>& midpoints) const {
  double low = std::numeric_limits<double>::infinity(), high = -low, bend = 0;
  const auto value = [&](Index p) { return values_[uz(p)] - resolution_.level; };
  const auto see = [&](Index p) {
    low = std::min(low, value(p));
    high = std::max(high, value(p));
  };
  std::size_t k = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    see(tet[i]);
    for (std::size_t j = i + 1; j < 4; ++j) {
      const Index middle = midpoints[k++];
      see(middle);
      bend = std::max(bend, std::abs(value(middle) - (value(tet[i]) + value(tet[j])) / 2));
    }
  }
  const double nearest = low > 0 ? low : (high < 0 ? -high : 0), size = length(tet);
  if (size > resolution_.largest) return nearest <= kReach * size;
  return bend > resolution_.error && nearest <= 2 * bend;
}

}  // namespace matstruct
