#include "prepare/orient_soup.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/index.h"

namespace matstruct {

namespace {

struct Across {
  Index triangle = 0;
  bool agrees = true;  // it runs along the common edge in the other direction
};

std::vector<std::vector<Across>> neighbours(const std::vector<Triangle>& triangles) {
  struct Use {
    Edge edge;
    Index triangle;
    bool forward;
  };
  std::vector<Use> uses;
  for (Index t = 0; t < count(triangles); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[uz(t)][k], b = triangles[uz(t)][(k + 1) % 3];
      uses.push_back({ordered_edge(a, b), t, a < b});
    }
  std::sort(uses.begin(), uses.end(),
            [](const Use& a, const Use& b) { return a.edge != b.edge ? a.edge < b.edge : a.triangle < b.triangle; });
  std::vector<std::vector<Across>> across(triangles.size());
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].edge == uses[begin].edge) ++end;
    if (end - begin != 2) continue;
    const Use &a = uses[begin], &b = uses[begin + 1];
    across[uz(a.triangle)].push_back({b.triangle, a.forward != b.forward});
    across[uz(b.triangle)].push_back({a.triangle, a.forward != b.forward});
  }
  return across;
}

double six_volume(const TriSurface& surface, Index t) {
  const Triangle& v = surface.triangles[uz(t)];
  const Vec3& origin = surface.vertices.front();
  return dot(surface.vertices[uz(v[0])] - origin,
             cross(surface.vertices[uz(v[1])] - origin, surface.vertices[uz(v[2])] - origin));
}

void flip(Triangle& t) {
  std::swap(t[1], t[2]);
}

// The set of `seed`, with the turns that make its triangles run alike.
struct Part {
  std::vector<Index> triangles;
  bool alike = true, two_sided = true;
};

Part collect(const std::vector<std::vector<Across>>& across, Index seed, std::vector<signed char>& turn) {
  Part part{.triangles = {seed}};
  turn[uz(seed)] = 1;
  for (std::size_t next = 0; next < part.triangles.size(); ++next) {
    const Index t = part.triangles[next];
    for (const Across& other : across[uz(t)]) {
      const auto wanted = static_cast<signed char>(other.agrees ? turn[uz(t)] : -turn[uz(t)]);
      part.alike = part.alike && other.agrees;
      signed char& known = turn[uz(other.triangle)];
      part.two_sided = part.two_sided && (known == 0 || known == wanted);
      if (known != 0) continue;
      known = wanted;
      part.triangles.push_back(other.triangle);
    }
  }
  return part;
}

}  // namespace

double signed_volume(const TriSurface& surface) {
  double sum = 0;
  for (Index t = 0; t < count(surface.triangles); ++t) sum += six_volume(surface, t);
  return sum / 6;
}

TriSurface orient_soup(TriSurface surface) {
  const auto across = neighbours(surface.triangles);
  std::vector<signed char> turn(surface.triangles.size(), 0);  // 0: not seen
  for (Index seed = 0; seed < count(surface.triangles); ++seed) {
    if (turn[uz(seed)] != 0) continue;
    const Part part = collect(across, seed, turn);
    if (part.alike || !part.two_sided) continue;
    double volume = 0;
    for (const Index t : part.triangles) {
      if (turn[uz(t)] < 0) flip(surface.triangles[uz(t)]);
      volume += six_volume(surface, t);
    }
    if (volume < 0)
      for (const Index t : part.triangles) flip(surface.triangles[uz(t)]);
  }
  if (signed_volume(surface) < 0)
    for (Triangle& t : surface.triangles) flip(t);
  return surface;
}

}  // namespace matstruct
