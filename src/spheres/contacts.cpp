#include "spheres/contacts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/index.h"
#include "base/tolerances.h"
#include "base/union_find.h"
#include "query/triangle_point.h"

namespace matstruct {

namespace {

// A contact whose directions cancel down to this share goes all the way round.
constexpr double kNoMiddle = 0.3;

bool is_nearer(const SurfaceHit& a, const SurfaceHit& b) {
  return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : a.triangle < b.triangle;
}

}  // namespace

bool is_patch_border(const Domain& domain, Index triangle, std::size_t local) {
  const Index e = domain.features.triangle_edges[uz(triangle)][local];
  return e != kInvalid && domain.features.edges[uz(e)].kind == EdgeKind::kConvex;
}

ContactFinder::ContactFinder(const Domain& domain, double smooth_angle)
    : domain_(domain),
      rise_(1 / std::cos(smooth_angle / 2)),
      floor_(tolerance::kTouch * domain.diagonal),
      stamp_(domain.surface.triangles.size(), 0),
      seen_(domain.surface.triangles.size(), 0),
      basin_(domain.surface.triangles.size(), kInvalid) {}

// Up to which squared distance a basin of depth sqrt(least2) reaches.
double ContactFinder::level2(double least2) const {
  const double least = std::sqrt(least2), level = std::max(rise_ * least, least + floor_);
  return level * level;
}

double ContactFinder::edge_distance2(Index triangle, std::size_t local, const Vec3& center) const {
  const Triangle& t = domain_.surface.triangles[uz(triangle)];
  const Vec3 &a = domain_.surface.vertices[uz(t[(local + 1) % 3])],
             &b = domain_.surface.vertices[uz(t[(local + 2) % 3])];
  return distance2(center, lerp(a, b, nearest_on_segment(center, a, b)));
}

// Visits the triangles of the basin that the walk from `start` runs into, lowest edges first; `visit` returns the
// squared distance of the triangle it is given. `least2`: what is known of the basin's depth before. Where it comes to
// a triangle of a basin that is known as a whole, it goes no further; see find().
template <class Visit>
void ContactFinder::flood(Index start, const Vec3& center, double least2, Visit visit) {
  ++flood_;
  const auto later = [](const Entry& a, const Entry& b) {
    return a.distance2 != b.distance2 ? a.distance2 > b.distance2 : a.triangle > b.triangle;
  };
  heap_.assign(1, {0, start});
  stamp_[uz(start)] = flood_;
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    const Entry entry = heap_.back();
    heap_.pop_back();
    if (entry.distance2 > level2(least2)) return;
    const Visited visited = visit(entry);
    least2 = std::min(least2, visited.distance2);
    if (visited.is_known) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index next = domain_.triangle_neighbors[uz(entry.triangle)][k];
      if (next == kInvalid || stamp_[uz(next)] == flood_ || is_patch_border(domain_, entry.triangle, k)) continue;
      stamp_[uz(next)] = flood_;
      heap_.push_back({edge_distance2(entry.triangle, k, center), next});
      std::push_heap(heap_.begin(), heap_.end(), later);
    }
  }
}

Contact ContactFinder::follow(const Contact& from, const Vec3& center) {
  SurfaceHit best;
  flood(from.triangle, center, std::numeric_limits<double>::infinity(), [&](const Entry& entry) {
    const SurfaceHit hit = domain_.query.closest_on(entry.triangle, center);
    if (is_nearer(hit, best)) best = hit;
    return Visited{hit.distance2};
  });
  return {best.point, best.triangle, std::sqrt(best.distance2)};
}

// Many triangles of the shell lie above the basins, and from each of them the walk runs down into one. It need not be
// flooded again: the triangles popped after the last one above the basin's final level are all that is connected to its
// lowest point below that level, so that another flood that comes to one of them would visit all of them, and nothing
// more through them, before any triangle above that level.
Contacts ContactFinder::find(const Vec3& center, double radius, double touch) {
  Contacts contacts;
  domain_.query.within(center, radius + std::max(touch, floor_), shell_);
  ++search_;
  first_basin_ += count(basins_);
  basins_.clear();
  for (const Index start : shell_) {
    if (seen_[uz(start)] == search_) continue;
    SurfaceHit best;
    popped_.clear();
    flood(start, center, std::numeric_limits<double>::infinity(), [&](const Entry& entry) {
      const Index t = entry.triangle;
      seen_[uz(t)] = search_;
      const bool is_known = basin_[uz(t)] >= first_basin_;
      const SurfaceHit hit = is_known ? basins_[static_cast<std::size_t>(basin_[uz(t)] - first_basin_)]
                                      : domain_.query.closest_on(t, center);
      if (is_nearer(hit, best)) best = hit;
      popped_.push_back(entry);
      return Visited{hit.distance2, is_known};
    });
    const double level = level2(best.distance2);
    for (auto at = popped_.rbegin(); at != popped_.rend() && at->distance2 <= level; ++at)
      if (basin_[uz(at->triangle)] < first_basin_) basin_[uz(at->triangle)] = first_basin_ + count(basins_);
    basins_.push_back(best);
    const Contact contact{best.point, best.triangle, std::sqrt(best.distance2)};
    if (std::none_of(contacts.begin(), contacts.end(), [&](const Contact& c) { return same(c, contact); }))
      contacts.push_back(contact);
  }
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const Contact& a, const Contact& b) { return a.distance < b.distance; });
  return contacts;
}

bool ContactFinder::same(const Contact& a, const Contact& b) const {
  // A foot on the edge of two triangles may be found on either. Only at a sharp edge itself are feet of two basins
  // so near each other.
  return a.triangle == b.triangle || (a.distance > 100 * floor_ && distance2(a.point, b.point) <= floor_ * floor_);
}

double ContactFinder::spread(const Contact& contact, const Vec3& center) {
  const double level = level2(contact.distance * contact.distance);
  directions_.clear();
  Vec3 sum;
  flood(contact.triangle, center, contact.distance * contact.distance, [&](const Entry& entry) {
    const SurfaceHit hit = domain_.query.closest_on(entry.triangle, center);
    if (hit.distance2 <= level) sum += directions_.emplace_back(normalized(hit.point - center));
    return Visited{hit.distance2};
  });
  if (norm(sum) < kNoMiddle * static_cast<double>(directions_.size())) return std::numbers::pi;
  double greatest = 0;
  for (const Vec3& d : directions_) greatest = std::max(greatest, angle_between(sum, d));
  return greatest;
}

Vec3 direction(const Domain& domain, const Vec3& center, const Contact& contact) {
  if (contact.distance > tolerance::kTouch * domain.diagonal) return (contact.point - center) / contact.distance;
  return domain.triangle_normals[uz(contact.triangle)];
}

std::vector<Index> patches(const Domain& domain) {
  const Index triangles = count(domain.surface.triangles);
  UnionFind sets(triangles);
  for (Index t = 0; t < triangles; ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (const Index next = domain.triangle_neighbors[uz(t)][k]; next != kInvalid && !is_patch_border(domain, t, k))
        sets.unite(t, next);
  std::vector<Index> patch;
  Index patches = 0;
  for (Index t = 0; t < triangles; ++t) patch.push_back(sets.find(t) == t ? patches++ : patch[uz(sets.find(t))]);
  return patch;
}

}  // namespace matstruct
