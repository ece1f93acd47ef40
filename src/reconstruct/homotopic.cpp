#include "reconstruct/homotopic.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <queue>
#include <utility>

#include "base/incidence.h"
#include "base/index.h"
#include "base/union_find.h"

namespace matstruct {

namespace {

/// The tetrahedra of each vertex.
class Stars {
 public:
  Stars(const std::vector<Tetrahedron>& tets, std::size_t vertices) : tets_(tets), tets_of_vertex_(vertices, tets) {}
  /// Calls visit(a, b, c) with the triangles of the vertex's link.
  template <class Visit>
  void link(Index v, const Visit& visit) const {
    for (const Index t : tets_of_vertex_.of(v)) {
      const auto& [a, b, c, d] = tets_[uz(t)];
      if (v == a) visit(b, c, d);
      if (v == b) visit(a, c, d);
      if (v == c) visit(a, b, d);
      if (v == d) visit(a, b, c);
    }
  }

 private:
  const std::vector<Tetrahedron>& tets_;
  Incidence tets_of_vertex_;
};

/// What is inside and outside within the link of a vertex.
class Link {
 public:
  Link(const Stars& stars, const std::vector<char>& inside) : stars_(stars), inside_(inside) {}

  /// Whether the neighbours inside are connected within the link, and those outside too.
  bool splits_in_two(Index v) {
    collect(v);
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
  /// Euler characteristic of the part inside. A link is closed: each of its edges has two triangles.
  Index euler(Index v) {
    collect(v);
    const auto in = [&](Index u) { return Index{inside_[uz(u)] != 0}; };
    Index vertices = 0, sides = 0, triangles = 0;
    for (const Index u : vertices_) vertices += in(u);
    stars_.link(v, [&](Index a, Index b, Index c) {
      sides += in(a)*in(b) + in(b)*in(c) + in(c)*in(a);
      triangles += in(a)*in(b)*in(c);
    });
    return vertices - sides / 2 + triangles;
  }

 private:
  void collect(Index v) {
    vertices_.clear();
    stars_.link(v, [&](Index a, Index b, Index c) { vertices_.insert(vertices_.end(), {a, b, c}); });
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  }
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

/// shrink(), with the stars at hand.
std::vector<char> shrunk(const Stars& stars, const std::vector<double>& values, std::vector<char> inside,
                         const std::vector<char>& kept) {
  std::vector<char> queued(values.size(), 0);
  std::priority_queue<std::pair<double, Index>> queue;
  const auto offer = [&](Index v) {
    if (!inside[uz(v)] || queued[uz(v)] || kept[uz(v)]) return;
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

std::vector<char> grown(const std::vector<Tetrahedron>& tets, const std::vector<double>& values, double level,
                        const std::vector<char>& kept) {
  std::vector<char> inside = kept;
  for (const Tetrahedron& tet : tets)
    for (const Index v : tet) inside[uz(v)] = inside[uz(v)] || values[uz(v)] < level;
  return inside;
}

/// A connected piece of what was added to a set.
struct Piece {
  double deepest = 0;  ///< greatest value
  Index euler = 0;     ///< by which it changes the Euler characteristic of what is inside
  std::vector<Index> vertices;
};

/// The pieces that were added between two sets, and how they touch the components inside before and outside after.
class Pieces {
 public:
  Pieces(const std::vector<Tetrahedron>& tets, const Stars& stars, const std::vector<double>& values,
         const std::vector<char>& before, const std::vector<char>& after) {
    std::vector<Kind> kind(values.size(), kOutside);
    for (std::size_t v = 0; v < kind.size(); ++v) kind[v] = before[v] ? kBefore : after[v] ? kAdded : kOutside;
    UnionFind components(count(values));
    for (const Tetrahedron& tet : tets)
      for (std::size_t k = 1; k < 4; ++k)
        for (std::size_t i = 0; i < k; ++i)
          if (kind[uz(tet[k])] == kind[uz(tet[i])]) components.unite(tet[k], tet[i]);
    number_nodes(tets, kind, components);
    find_contacts(tets, kind, components);
    measure(stars, values, before, kind, components);
  }

  const std::vector<Piece>& all() const { return pieces_; }
  std::vector<Index> by_depth() const {
    std::vector<Index> order(pieces_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return pieces_[uz(a)].deepest < pieces_[uz(b)].deepest; });
    return order;
  }
  /// Components of the surface around what is inside when the pieces that are `added` (#P, 1) are: each separates one
  /// component inside from one outside, as the edges of a tree do.
  Index surface_components(const std::vector<char>& added) const {
    UnionFind parts(count(kinds_));
    Index components = count(kinds_);
    for (const auto& [piece, node] : contacts_)
      if ((kinds_[uz(node)] == kBefore) == (added[uz(piece)] != 0) && parts.unite(piece, node)) --components;
    return components - 1;
  }

 private:
  enum Kind : char { kOutside, kAdded, kBefore };

  /// Nodes are the components of each kind, first the pieces.
  void number_nodes(const std::vector<Tetrahedron>& tets, const std::vector<Kind>& kind, UnionFind& components) {
    node_.assign(kind.size(), kInvalid);
    for (const bool pieces : {true, false})
      for (const Tetrahedron& tet : tets)
        for (const Index v : tet) {
          Index& node = node_[uz(components.find(v))];
          if (node != kInvalid || (kind[uz(v)] == kAdded) != pieces) continue;
          node = count(kinds_);
          kinds_.push_back(kind[uz(v)]);
        }
  }
  void find_contacts(const std::vector<Tetrahedron>& tets, const std::vector<Kind>& kind, UnionFind& components) {
    for (const Tetrahedron& tet : tets)
      for (const Index v : tet)
        for (const Index u : tet)
          if (kind[uz(v)] == kAdded && kind[uz(u)] != kAdded)
            contacts_.push_back({node_[uz(components.find(v))], node_[uz(components.find(u))]});
    std::sort(contacts_.begin(), contacts_.end());
    contacts_.erase(std::unique(contacts_.begin(), contacts_.end()), contacts_.end());
  }
  void measure(const Stars& stars, const std::vector<double>& values, std::vector<char> inside,
               const std::vector<Kind>& kind, UnionFind& components) {
    pieces_.resize(static_cast<std::size_t>(std::count(kinds_.begin(), kinds_.end(), kAdded)));
    Link link(stars, inside);
    for (Index v = 0; v < count(values); ++v) {
      if (kind[uz(v)] != kAdded) continue;
      // No simplex has vertices of two pieces, so that their changes add up whatever the order.
      Piece& piece = pieces_[uz(node_[uz(components.find(v))])];
      piece.deepest = std::max(piece.deepest, values[uz(v)]);
      piece.euler += 1 - link.euler(v);
      piece.vertices.push_back(v);
      inside[uz(v)] = 1;
    }
  }

  std::vector<Index> node_;                     // of the first vertex of each component
  std::vector<Kind> kinds_;                     // of nodes
  std::vector<std::array<Index, 2>> contacts_;  // a piece and a node of another kind
  std::vector<Piece> pieces_;
};

Index distance_of(const SurfaceTopology& a, const SurfaceTopology& b) {
  return std::abs(a.components - b.components) + std::abs(a.genus - b.genus);
}

}  // namespace

std::vector<char> shrink(const std::vector<Tetrahedron>& tets, const std::vector<double>& values, double level,
                         const std::vector<char>& kept) {
  return shrunk(Stars(tets, values.size()), values, grown(tets, values, level, kept), kept);
}

std::vector<char> fill(const std::vector<Tetrahedron>& tets, const std::vector<double>& values,
                       const std::vector<char>& inside, const SurfaceTopology& given, const SurfaceTopology& wanted,
                       std::span<const double> levels, const Context& context) {
  const Stars stars(tets, values.size());
  std::vector<char> now = inside, filled(values.size(), 0);
  SurfaceTopology topology = given;
  for (const double level : levels) {
    if (topology == wanted) break;
    context.check();
    const Pieces pieces(tets, stars, values, now, shrunk(stars, values, grown(tets, values, level, now), now));
    // The genus of the surface is its number of components less the Euler characteristic of what is inside.
    Index euler = topology.components - topology.genus;
    std::vector<char> added(pieces.all().size(), 0);
    for (const Index p : pieces.by_depth()) {
      const Piece& piece = pieces.all()[uz(p)];
      added[uz(p)] = 1;
      const Index components = pieces.surface_components(added);
      const SurfaceTopology next{components, components - (euler + piece.euler)};
      if (distance_of(next, wanted) >= distance_of(topology, wanted)) {
        added[uz(p)] = 0;
        continue;
      }
      topology = next;
      euler += piece.euler;
      for (const Index v : piece.vertices) now[uz(v)] = filled[uz(v)] = 1;
    }
  }
  return filled;
}

}  // namespace matstruct
