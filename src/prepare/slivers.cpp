#include "prepare/slivers.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/index.h"
#include "geometry/exact.h"
#include "prepare/boundary.h"

namespace matstruct {

namespace {

bool is_positive(const std::vector<Vec3>& points, const Tetrahedron& t) {
  return orientation(points[uz(t[0])], points[uz(t[1])], points[uz(t[2])], points[uz(t[3])]) > 0;
}

// The vertices as a frame maps them.
struct View {
  Frame frame;
  std::vector<Vec3> points;
};

bool is_good(const TetMesh& solid, const std::vector<View>& views, const Tetrahedron& tet) {
  return is_positive(solid.vertices, tet) &&
         std::ranges::all_of(views, [&](const View& view) { return is_positive(view.points, tet); });
}

// Around an inner edge ab lie tets (a, b, x, y). Splitting it at a point m replaces each by (a, m, x, y) and (m, b, x,
// y). For the inner diagonal ab of a flat tet whose other diagonal lies towards the outside, all these are positive
// when m is near the edge on the inner side; for a slightly inverted one when m is far enough from it. Bad tets can lie
// on each other: rounds are made until nothing changes, and the innermost comes first because for it a place of m is
// found.
class SliverRepair {
 public:
  SliverRepair(TetMesh& solid, std::vector<View> views)
      : solid_(solid), views_(std::move(views)), tets_of_(solid.vertices.size()) {
    for (Index t = 0; t < count(solid.tets); ++t)
      for (const Index v : solid.tets[uz(t)]) tets_of_[uz(v)].push_back(t);
    const Boundary boundary = find_boundary(solid, [](Index) { return std::string(); });
    for (const Triangle& t : boundary.triangles)
      for (std::size_t k = 0; k < 3; ++k) fixed_.insert(ordered_edge(t[k], t[(k + 1) % 3]));
  }

  bool run(std::vector<Index> bad) {
    for (std::size_t before = 0; before != bad.size();) {
      before = bad.size();
      std::erase_if(bad, [&](Index t) { return is_good(solid_, views_, solid_.tets[uz(t)]) || repair(t); });
    }
    return bad.empty();
  }

 private:
  std::vector<Index> tets_around(const Edge& edge) const {
    std::vector<Index> ring;
    for (const Index t : tets_of_[uz(edge[0])]) {
      const Tetrahedron& tet = solid_.tets[uz(t)];
      if (std::find(tet.begin(), tet.end(), edge[1]) != tet.end()) ring.push_back(t);
    }
    return ring;
  }

  // Six times the least volume after a split at p; negative if one is not strictly positive. p among `points`.
  double least_volume(const Edge& edge, const std::vector<Index>& ring, const Vec3& p,
                      const std::vector<Vec3>& points) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Index t : ring)
      for (const Index replaced : edge) {
        std::array<Vec3, 4> q;
        for (std::size_t k = 0; k < 4; ++k) {
          const Index v = solid_.tets[uz(t)][k];
          q[k] = v == replaced ? p : points[uz(v)];
        }
        if (orientation(q[0], q[1], q[2], q[3]) <= 0) return -1;
        least = std::min(least, dot(cross(q[1] - q[0], q[2] - q[0]), q[3] - q[0]));
      }
    return least;
  }

  // The best of a few points from the middle of the edge towards the other vertices around it.
  std::optional<std::pair<double, Vec3>> best_point(const Edge& edge, const std::vector<Index>& ring, Index bad) const {
    const Tetrahedron& own = solid_.tets[uz(bad)];
    Vec3 target;
    double others = 0;
    for (const Index t : ring)
      for (const Index v : solid_.tets[uz(t)]) {
        if (std::find(own.begin(), own.end(), v) != own.end()) continue;
        target += solid_.vertices[uz(v)];
        ++others;
      }
    if (others == 0) return std::nullopt;
    const Vec3 middle = (solid_.vertices[uz(edge[0])] + solid_.vertices[uz(edge[1])]) * 0.5;
    std::optional<std::pair<double, Vec3>> best;
    constexpr int kHalvings = 30;
    double step = 1;
    for (int k = 0; k < kHalvings; ++k) {
      step /= 2;
      const Vec3 p = lerp(middle, target / others, step);
      const double least = least_volume(edge, ring, p, solid_.vertices);
      if (least > 0 && (!best || least > best->first) && std::ranges::all_of(views_, [&](const View& view) {
            return least_volume(edge, ring, view.frame.to_internal(p), view.points) > 0;
          }))
        best = {least, p};
    }
    return best;
  }

  bool repair(Index bad) {
    const Tetrahedron tet = solid_.tets[uz(bad)];
    Edge edge{};
    std::optional<std::pair<double, Vec3>> best;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        const Edge candidate = ordered_edge(tet[i], tet[j]);
        if (fixed_.count(candidate)) continue;
        const auto found = best_point(candidate, tets_around(candidate), bad);
        if (!found || (best && found->first <= best->first)) continue;
        best = found;
        edge = candidate;
      }
    if (best) split(edge, best->second);
    return best.has_value();
  }

  void split(const Edge& edge, const Vec3& p) {
    const Index middle = count(solid_.vertices);
    solid_.vertices.push_back(p);
    for (View& view : views_) view.points.push_back(view.frame.to_internal(p));
    tets_of_.emplace_back();
    for (const Index t : tets_around(edge)) {
      const Index added = count(solid_.tets);
      Tetrahedron half = solid_.tets[uz(t)];
      std::replace(half.begin(), half.end(), edge[0], middle);
      std::replace(solid_.tets[uz(t)].begin(), solid_.tets[uz(t)].end(), edge[1], middle);
      solid_.tets.push_back(half);
      std::erase(tets_of_[uz(edge[1])], t);
      tets_of_[uz(middle)].push_back(t);
      for (const Index v : half) tets_of_[uz(v)].push_back(added);
    }
  }

  TetMesh& solid_;
  std::vector<View> views_;
  std::vector<std::vector<Index>> tets_of_;
  std::set<Edge> fixed_;  // edges of the boundary
};

}  // namespace

bool repair_slivers(TetMesh& solid, const std::vector<Frame>& frames) {
  std::vector<View> views;
  for (const Frame& frame : frames) {
    View& view = views.emplace_back(View{frame, {}});
    for (const Vec3& p : solid.vertices) view.points.push_back(frame.to_internal(p));
  }
  std::vector<Index> bad;
  for (Index t = 0; t < count(solid.tets); ++t)
    if (!is_good(solid, views, solid.tets[uz(t)])) bad.push_back(t);
  return bad.empty() || SliverRepair(solid, std::move(views)).run(std::move(bad));
}

}  // namespace matstruct
