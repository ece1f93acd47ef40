// Two thresholds, as in edge detection (J. Canny, A computational approach to edge detection, IEEE PAMI 8(6), 1986):
// the lower one, the limit of the dihedral angle, decides how far a line extends; the higher one, whether there is a
// line.
#include "prepare/noise_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/index.h"
#include "base/tolerances.h"
#include "base/union_find.h"
#include "prepare/sharp_graph.h"

namespace matstruct {

namespace {

constexpr double kStrongInScan = 2;     // kStrongTurn where much is noise
constexpr double kShareOfNoise = 0.25;  // CAD models have less than 0.14, scans and facetted sculptures more than 0.29

// Length, and the integral along it of what the dihedral turns by more than a strong edge.
struct Extent {
  double length = 0;
  double excess = 0;
  void add(const Extent& other) {
    length += other.length;
    excess += other.excess;
  }
  bool weak() const { return excess < 0; }
};

class NoiseFilter {
 public:
  NoiseFilter(const TriSurface& surface, const std::vector<SharpEdge>& edges, double diagonal, const Options& options)
      : surface_(surface),
        edges_(edges),
        shortest_(diagonal / options.gamma),
        weak_(tolerance::kWeakLine * diagonal),
        options_(options),
        graph_(sharp_graph(edges, count(surface.vertices))),
        degree_(surface.vertices.size()) {
    result_.noise.assign(edges.size(), 0);
    for (Index v = 0; v < count(degree_); ++v) degree_[uz(v)] = graph_.degree(v);
  }

  NoiseLines run() {
    measure(tolerance::kStrongTurn);
    while (remove_chains([&](const Extent& chain) { return chain.weak() && chain.length < weak_; })) continue;
    remove_sets([&](const Extent& set) { return set.weak() && set.length < weak_; });
    result_.mostly = share_of_noise() > kShareOfNoise;
    if (result_.mostly) {
      measure(kStrongInScan);
      while (remove_chains([](const Extent& chain) { return chain.weak(); })) continue;
      remove_sets([&](const Extent& set) { return set.weak() || set.length < weak_; });
    }
    return std::move(result_);
  }

 private:
  void measure(double strong) {
    extent_.clear();
    for (const SharpEdge& edge : edges_) {
      const double limit = edge.kind == EdgeKind::kConvex ? options_.convex_angle : options_.concave_angle;
      // Of a limit that is large in itself, not more than halfway to a right angle is asked for.
      const double needed = std::min(strong * limit, (limit + 90) / 2) * std::numbers::pi / 180;
      const double length = distance(surface_.vertices[uz(edge.vertices[0])], surface_.vertices[uz(edge.vertices[1])]);
      extent_.push_back({length, length * (std::abs(edge.dihedral - std::numbers::pi) - needed)});
    }
  }

  double share_of_noise() const {
    double all = 0, noise = 0;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      all += extent_[e].length;
      if (result_.noise[e]) noise += extent_[e].length;
    }
    return all > 0 ? noise / all : 0;
  }

  void remove(Index edge) {
    if (result_.noise[uz(edge)]) return;
    result_.noise[uz(edge)] = 1;
    for (const Index v : edges_[uz(edge)].vertices) --degree_[uz(v)];
  }

  // The edge at a vertex, not noise, other than `edge`; there is one.
  Index next(Index vertex, Index edge) const {
    Index k = 0;
    while (graph_.edge(vertex, k) == edge || result_.noise[uz(graph_.edge(vertex, k))]) ++k;
    return graph_.edge(vertex, k);
  }

  std::vector<Index> chain_from(Index free_end) const {
    std::vector<Index> chain;
    Index vertex = free_end, edge = kInvalid;
    do {
      edge = next(vertex, edge);
      chain.push_back(edge);
      vertex = other_end(edges_[uz(edge)], vertex);
    } while (degree_[uz(vertex)] == 2);
    return chain;
  }

  // Of chains with a free end, those that are noise or too short. All are judged before any is removed, so that the
  // order of vertices does not matter. Returns whether there were any.
  template <class IsNoise>
  bool remove_chains(IsNoise is_noise) {
    std::vector<Index> doomed;
    for (Index v = 0; v < count(degree_); ++v) {
      if (degree_[uz(v)] != 1) continue;
      const std::vector<Index> chain = chain_from(v);
      Extent extent;
      for (const Index e : chain) extent.add(extent_[uz(e)]);
      if (is_noise(extent) || extent.length < shortest_) doomed.insert(doomed.end(), chain.begin(), chain.end());
    }
    for (const Index e : doomed) remove(e);
    return !doomed.empty();
  }

  template <class IsNoise>
  void remove_sets(IsNoise is_noise) {
    UnionFind sets(count(degree_));
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (!result_.noise[e]) sets.unite(edges_[e].vertices[0], edges_[e].vertices[1]);
    std::vector<Extent> extent(degree_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (!result_.noise[e]) extent[uz(sets.find(edges_[e].vertices[0]))].add(extent_[e]);
    for (Index e = 0; e < count(edges_); ++e)
      if (is_noise(extent[uz(sets.find(edges_[uz(e)].vertices[0]))])) remove(e);
  }

  const TriSurface& surface_;
  const std::vector<SharpEdge>& edges_;
  double shortest_;  // of lines with a free end
  double weak_;      // the same for weak ones
  const Options& options_;
  SharpGraph graph_;
  std::vector<Index> degree_;  // of the vertices, in edges that are not noise
  std::vector<Extent> extent_;
  NoiseLines result_;
};

}  // namespace

NoiseLines find_noise_lines(const TriSurface& surface, const std::vector<SharpEdge>& edges, double diagonal,
                            const Options& options) {
  return NoiseFilter(surface, edges, diagonal, options).run();
}

}  // namespace matstruct
