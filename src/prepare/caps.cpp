#include "prepare/caps.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/index.h"
#include "geometry/exact.h"

namespace matstruct {

namespace {

// The legs of a cap are so many times longer than it may be high.
constexpr double kLegs = 16;

// The corner of a triangle, by its local vertex, opposite its longest edge: of a cap the one between the others.
std::size_t middle_corner(const TriSurface& surface, const Triangle& t) {
  const auto opposite = [&](std::size_t k) {
    return distance2(surface.vertices[uz(t[(k + 1) % 3])], surface.vertices[uz(t[(k + 2) % 3])]);
  };
  std::size_t best = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (opposite(k) > opposite(best)) best = k;
  return best;
}

bool is_cap(const TriSurface& surface, const Triangle& t, double height) {
  const std::size_t k = middle_corner(surface, t);
  const Vec3 &a = surface.vertices[uz(t[(k + 1) % 3])], &b = surface.vertices[uz(t[k])],
             &c = surface.vertices[uz(t[(k + 2) % 3])];
  if (collinear(a, b, c)) return true;
  return norm(cross(b - a, c - a)) < height * distance(a, c) &&
         std::min(distance(a, b), distance(b, c)) > kLegs * height;
}

// True for a cap of which ac is not the longest edge. It goes first: so the longest edge of caps only gets shorter, or
// caps fewer, and the rounds end.
bool is_longer_cap(const TriSurface& surface, const Triangle& t, Index a, Index c, double height) {
  if (!is_cap(surface, t, height)) return false;
  const Index middle = t[middle_corner(surface, t)];
  return middle == a || middle == c;
}

std::vector<std::pair<Edge, Index>> sorted_edges(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<Edge, Index>> edges;
  for (Index t = 0; t < count(triangles); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[uz(t)][k], b = triangles[uz(t)][(k + 1) % 3];
      edges.push_back({ordered_edge(a, b), t});
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

// One round: caps and what lies across them change at most once. Returns the number of caps removed.
Index remove_some(TriSurface& surface, const std::vector<Index>& caps, double height) {
  std::vector<Triangle>& triangles = surface.triangles;
  const auto edges = sorted_edges(triangles);
  std::vector<char> touched(triangles.size(), 0), gone(triangles.size(), 0);
  Index removed = 0;
  for (const Index t : caps) {
    const std::size_t k = middle_corner(surface, triangles[uz(t)]);
    const Index b = triangles[uz(t)][k], a = triangles[uz(t)][(k + 1) % 3], c = triangles[uz(t)][(k + 2) % 3];
    const std::pair<Edge, Index> first{ordered_edge(a, c), kInvalid};
    const auto begin = std::upper_bound(edges.begin(), edges.end(), first);
    const auto end = std::find_if(begin, edges.end(), [&](const auto& e) { return e.first != first.first; });
    if (touched[uz(t)] || end - begin > 2) continue;
    if (end - begin == 2) {
      const Index other = begin->second == t ? (begin + 1)->second : begin->second;
      const Triangle old = triangles[uz(other)];
      if (touched[uz(other)] || std::find(old.begin(), old.end(), b) != old.end()) continue;
      if (is_longer_cap(surface, old, a, c, height)) continue;
      Triangle added = old;
      std::replace(added.begin(), added.end(), a, b);
      std::replace(triangles[uz(other)].begin(), triangles[uz(other)].end(), c, b);
      triangles.push_back(added);
      gone.push_back(0);
      touched[uz(other)] = 1;
    }
    touched[uz(t)] = gone[uz(t)] = 1;
    ++removed;
  }
  std::size_t next = 0;
  for (std::size_t t = 0; t < gone.size(); ++t)
    if (!gone[t]) triangles[next++] = triangles[t];
  triangles.resize(next);
  return removed;
}

}  // namespace

Index remove_caps(TriSurface& surface, double height) {
  // Flips that change nothing but rounding could go round; there is one for each cap, or little more.
  const Index most = count(surface.triangles);
  Index removed = 0;
  while (removed <= most) {
    std::vector<Index> caps;
    for (Index t = 0; t < count(surface.triangles); ++t)
      if (is_cap(surface, surface.triangles[uz(t)], height)) caps.push_back(t);
    const Index now = caps.empty() ? 0 : remove_some(surface, caps, height);
    if (now == 0) break;
    removed += now;
  }
  return removed;
}

}  // namespace matstruct
