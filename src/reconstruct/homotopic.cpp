#include "reconstruct/homotopic.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <queue>
#include <utility>

#include "base/index.h"

namespace matstruct {

namespace {

/// The tetrahedra of each vertex.
class Stars {
 public:
  Stars(const std::vector<Tetrahedron>& tets, std::size_t vertices) : tets_(tets), start_(vertices + 1, 0) {
    for (const Tetrahedron& tet : tets)
      for (const Index v : tet) ++start_[uz(v) + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    tet_.resize(start_.back());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (Index t = 0; t < count(tets); ++t)
      for (const Index v : tets[uz(t)]) tet_[next[uz(v)]++] = t;
  }
  /// Calls visit(a, b, c) with the triangles of the vertex's link.
  template <class Visit>
  void link(Index v, const Visit& visit) const {
    for (std::size_t k = start_[uz(v)]; k < start_[uz(v) + 1]; ++k) {
      const auto& [a, b, c, d] = tets_[uz(tet_[k])];
      if (v == a) visit(b, c, d);
      if (v == b) visit(a, c, d);
      if (v == c) visit(a, b, d);
      if (v == d) visit(a, b, c);
    }
  }

 private:
  const std::vector<Tetrahedron>& tets_;
  std::vector<std::size_t> start_;
  std::vector<Index> tet_;
};

/// Whether a vertex's neighbours inside are connected within its link, and those outside too.
class Link {
 public:
  Link(const Stars& stars, const std::vector<char>& inside) : stars_(stars), inside_(inside) {}

  bool splits_in_two(Index v) {
    vertices_.clear();
    stars_.link(v, [&](Index a, Index b, Index c) { vertices_.insert(vertices_.end(), {a, b, c}); });
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    parent_.resize(vertices_.size());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    std::array<std::size_t, 2> pieces{};
    for (const Index neighbor : vertices_) ++pieces[side(neighbor)];
    stars_.link(v, [&](Index a, Index b, Index c) {
      for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, a}})
        if (side(p) == side(q) && unite(place(p), place(q))) --pieces[side(p)];
    });
    return pieces[0] == 1 && pieces[1] == 1;
  }

 private:
  std::size_t side(Index v) const { return inside_[uz(v)] ? 1 : 0; }
  std::size_t place(Index v) const {
    return static_cast<std::size_t>(std::lower_bound(vertices_.begin(), vertices_.end(), v) - vertices_.begin());
  }
  bool unite(std::size_t a, std::size_t b) {
    while (parent_[a] != a) a = parent_[a];
    while (parent_[b] != b) b = parent_[b];
    parent_[b] = a;
    return a != b;
  }

  const Stars& stars_;
  const std::vector<char>& inside_;
  std::vector<Index> vertices_;
  std::vector<std::size_t> parent_;
};

}  // namespace

std::vector<char> shrink(const std::vector<Tetrahedron>& tets, const std::vector<double>& values, double start,
                         double end) {
  const Stars stars(tets, values.size());
  std::vector<char> inside(values.size(), 0), queued(values.size(), 0);
  for (const Tetrahedron& tet : tets)
    for (const Index v : tet) inside[uz(v)] = values[uz(v)] < start;
  std::priority_queue<std::pair<double, Index>> queue;
  const auto offer = [&](Index v) {
    if (!inside[uz(v)] || queued[uz(v)] || values[uz(v)] < end) return;
    queued[uz(v)] = 1;
    queue.push({values[uz(v)], v});
  };
  for (Index v = 0; v < count(inside); ++v) offer(v);
  Link link(stars, inside);
  while (!queue.empty()) {
    const Index v = queue.top().second;
    queue.pop();
    queued[uz(v)] = 0;
    if (!link.splits_in_two(v)) continue;
    inside[uz(v)] = 0;
    stars.link(v, [&](Index a, Index b, Index c) {
      for (const Index neighbor : {a, b, c}) offer(neighbor);
    });
  }
  return inside;
}

}  // namespace matstruct
