#include "metrics/surface_patches.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/index.h"
#include "geometry/exact.h"
#include "query/face_angle.h"
#include "query/triangle_point.h"

namespace matstruct {

namespace {

/// Of each vertex the least one at the same place.
std::vector<Index> weld(const std::vector<Vec3>& vertices) {
  std::vector<Index> order(vertices.size()), same(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](Index v) { return std::tuple(vertices[uz(v)].x, vertices[uz(v)].y, vertices[uz(v)].z, v); };
  std::sort(order.begin(), order.end(), [&](Index v, Index w) { return key(v) < key(w); });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool repeats = k > 0 && vertices[uz(order[k])] == vertices[uz(order[k - 1])];
    same[uz(order[k])] = repeats ? same[uz(order[k - 1])] : order[k];
  }
  return same;
}

struct Side {
  Edge edge;
  Index triangle = kInvalid, opposite = 0;
};

/// All sides of all triangles, equal edges next to each other.
std::vector<Side> sides_of(const TriSurface& surface) {
  std::vector<Side> sides;
  for (Index t = 0; t < count(surface.triangles); ++t) {
    const Triangle& v = surface.triangles[uz(t)];
    for (Index k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({v[uz((k + 1) % 3)], v[uz((k + 2) % 3)]});
      sides.push_back({{low, high}, t, k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.edge, a.triangle, a.opposite) < std::tie(b.edge, b.triangle, b.opposite);
  });
  return sides;
}

double signed_volume(const TriSurface& surface) {
  const auto& v = surface.vertices;
  const Vec3 origin = v[uz(surface.triangles.front()[0])];
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles)
    sum += dot(v[uz(a)] - origin, cross(v[uz(b)] - origin, v[uz(c)] - origin));
  return sum;
}

/// The surface with vertices at the same place made one and, if it is turned inside out, turned back.
TriSurface outward(TriSurface surface) {
  const std::vector<Index> same = weld(surface.vertices);
  const bool inward = !surface.triangles.empty() && signed_volume(surface) < 0;
  for (Triangle& t : surface.triangles) {
    for (Index& v : t) v = same[uz(v)];
    if (inward) std::swap(t[1], t[2]);
  }
  return surface;
}

}  // namespace

SurfacePatches::SurfacePatches(const TriSurface& surface, double convex_angle)
    : surface_(outward(surface)), neighbours_(surface.triangles.size(), {kInvalid, kInvalid, kInvalid}) {
  std::vector<Vec3> normals;
  for (const auto& [a, b, c] : surface_.triangles)
    normals.push_back(triangle_normal(surface_.vertices[uz(a)], surface_.vertices[uz(b)], surface_.vertices[uz(c)]));
  std::vector<std::pair<Side, Side>> pairs;
  const std::vector<Side> sides = sides_of(surface_);
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].edge == sides[first].edge) ++last;
    const Side &a = sides[first], &b = sides[last - 1];
    // A triangle without area has no normal: it joins nothing, lest it join the patches on both sides of a sharp edge.
    if (last - first != 2 || norm2(normals[uz(a.triangle)]) == 0 || norm2(normals[uz(b.triangle)]) == 0) continue;
    neighbours_[uz(a.triangle)][uz(a.opposite)] = b.triangle;
    neighbours_[uz(b.triangle)][uz(b.opposite)] = a.triangle;
    pairs.emplace_back(a, b);
  }
  const double limit = convex_angle * std::numbers::pi / 180;
  std::erase_if(pairs, [&](const auto& pair) {
    const Index triangle = pair.first.triangle;
    const std::size_t local = uz(pair.first.opposite);
    const double dihedral = dihedral_angle(surface_, neighbours_, normals, triangle, local);
    return !is_sharp_convex(surface_, neighbours_, normals, triangle, local, dihedral, limit);
  });
  for (const auto& pair : pairs)
    for (const Side& side : {pair.first, pair.second}) neighbours_[uz(side.triangle)][uz(side.opposite)] = kInvalid;
}

PatchWalk::PatchWalk(const SurfacePatches& patches)
    : patches_(patches), seen_(patches.surface().triangles.size(), kInvalid) {}

bool PatchWalk::flood(const Vec3& center, double radius, Index from, Index until) {
  const TriSurface& surface = patches_.surface();
  stack_.assign(1, from);
  seen_[uz(from)] = walk_;
  while (!stack_.empty()) {
    const Index t = stack_.back();
    stack_.pop_back();
    if (t == until) return true;
    const Triangle& corners = surface.triangles[uz(t)];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index next = patches_.neighbours(t)[k];
      if (next == kInvalid || seen_[uz(next)] == walk_) continue;
      const Vec3 &a = surface.vertices[uz(corners[(k + 1) % 3])], &b = surface.vertices[uz(corners[(k + 2) % 3])];
      if (distance2(center, lerp(a, b, nearest_on_segment(center, a, b))) > radius * radius) continue;
      seen_[uz(next)] = walk_;
      stack_.push_back(next);
    }
  }
  return false;
}

bool PatchWalk::joined(const Vec3& center, double radius, Index a, Index b) {
  ++walk_;
  return flood(center, radius, a, b);
}

Index PatchWalk::pieces(const Vec3& center, double radius, std::span<const Index> triangles) {
  ++walk_;
  Index result = 0;
  for (const Index t : triangles) {
    if (seen_[uz(t)] == walk_) continue;
    flood(center, radius, t, kInvalid);
    ++result;
  }
  return result;
}

}  // namespace matstruct
