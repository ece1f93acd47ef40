#include "prepare/repair_effect.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "base/index.h"
#include "base/tolerances.h"
#include "geometry/box.h"
#include "geometry/exact.h"
#include "prepare/boundary.h"
#include "prepare/orient_soup.h"
#include "query/surface_query.h"

namespace matstruct {

namespace {

constexpr double kSharp = 30 * std::numbers::pi / 180;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TriSurface boundary_of(const TetMesh& solid) {
  return {.vertices = solid.vertices,
          .triangles = find_boundary(solid, [](Index v) { return fmt::format("vertex {}", v); }).triangles};
}

struct EdgeUse {
  Edge edge;
  Index triangle = 0;
};

std::vector<EdgeUse> edge_uses(const TriSurface& surface) {
  std::vector<EdgeUse> uses;
  for (Index t = 0; t < count(surface.triangles); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = surface.triangles[uz(t)][k], b = surface.triangles[uz(t)][(k + 1) % 3];
      uses.push_back({ordered_edge(a, b), t});
    }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.triangle < b.triangle;
  });
  return uses;
}

struct Edges {
  std::vector<Edge> sharp;  // of two triangles that turn, or of more than two
  bool open = false;
};

Edges edges_of(const TriSurface& surface) {
  Edges edges;
  const std::vector<EdgeUse> uses = edge_uses(surface);
  const auto normal = [&](Index t) {
    const Triangle& v = surface.triangles[uz(t)];
    return triangle_normal(surface.vertices[uz(v[0])], surface.vertices[uz(v[1])], surface.vertices[uz(v[2])]);
  };
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].edge == uses[begin].edge) ++end;
    edges.open = edges.open || (end - begin) % 2 == 1;
    const bool turns =
        end - begin == 2 && angle_between(normal(uses[begin].triangle), normal(uses[begin + 1].triangle)) > kSharp;
    if (turns || end - begin > 2) edges.sharp.push_back(uses[begin].edge);
  }
  return edges;
}

double share_kept(const TriSurface& input, const std::vector<Edge>& before, const TriSurface& result,
                  const std::vector<Edge>& after, double distance) {
  constexpr int kProbes = 8;
  if (before.empty()) return kNone;
  TriSurface lines{.vertices = result.vertices, .triangles = {}};  // as triangles without area
  for (const Edge& e : after) lines.triangles.push_back({e[0], e[1], e[1]});
  if (lines.triangles.empty()) return 0;
  const SurfaceQuery query(lines);
  double all = 0, kept = 0;
  for (const Edge& e : before) {
    const Vec3 &a = input.vertices[uz(e[0])], &b = input.vertices[uz(e[1])];
    int near = 0;
    for (int k = 0; k < kProbes; ++k)
      if (query.closest(lerp(a, b, (k + 0.5) / kProbes), distance * distance).triangle != kInvalid) ++near;
    all += norm(b - a);
    kept += norm(b - a) * near / kProbes;
  }
  return 100 * kept / all;
}

double greatest_distance(const TriSurface& from, const TriSurface& to) {
  const SurfaceQuery query(to);
  double greatest2 = 0;
  for (const Triangle& t : from.triangles) {
    const Vec3 &a = from.vertices[uz(t[0])], &b = from.vertices[uz(t[1])], &c = from.vertices[uz(t[2])];
    for (const Vec3& p : {a, b, c, (a + b + c) / 3}) greatest2 = std::max(greatest2, query.closest(p).distance2);
  }
  return std::sqrt(greatest2);
}

}  // namespace

Repair measure_repair(const TriSurface& input, const TetMesh& solid) {
  const TriSurface result = boundary_of(solid);
  const Edges before = edges_of(input), after = edges_of(result);
  const double diagonal = box_diagonal(input.vertices), volume = signed_volume(input);
  Repair repair;
  repair.volume_change_percent =
      before.open || volume == 0 ? kNone : 100 * (signed_volume(result) - volume) / std::abs(volume);
  repair.distance_percent = 100 * greatest_distance(result, input) / diagonal;
  repair.sharp_edges_kept_percent =
      share_kept(input, before.sharp, result, after.sharp, tolerance::kSameEdge * diagonal);
  return repair;
}

}  // namespace matstruct
