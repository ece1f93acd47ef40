#include "extract/split_dual.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/index.h"

namespace matstruct {

namespace {

// A component of a cell, facet or edge: its spheres, its size, and the record to take a point of it from.
template <std::size_t N>
struct Part {
  std::array<Index, N> spheres{};
  double measure = 0, greatest = 0;
  Index record = kInvalid;
  bool on_line = false;  // holds a piece of the sharp line that its spheres stand on
};

// Records of one kind by component.
template <std::size_t N, class Record, class SpheresOf, class MeasureOf>
std::map<Index, Part<N>> parts_of(const std::vector<Record>& records, const std::vector<Index>& roots,
                                  SpheresOf spheres_of, MeasureOf measure_of) {
  std::map<Index, Part<N>> parts;
  for (Index r = 0; r < count(records); ++r) {
    const double measure = measure_of(records[uz(r)]);
    Part<N>& part = parts[roots[uz(r)]];
    part.measure += measure;
    if (part.record != kInvalid && measure <= part.greatest) continue;
    part.spheres = spheres_of(records[uz(r)]);
    part.greatest = measure;
    part.record = r;
  }
  return parts;
}

class Splitter {
 public:
  Splitter(const Domain& domain, const RpdEngine& engine, const Spheres& spheres, const RpdComponents& components)
      : domain_(domain), engine_(engine), rpd_(engine.diagram()), spheres_(spheres), components_(components) {}

  SplitDual run() {
    split_cells();
    split_facets();
    split_edges();
    split_vertices();
    for (const auto& [triangle, length] : lengths_) {
      result_.dual.triangles.push_back(triangle);
      result_.dual.lengths.push_back(length);
    }
    std::sort(result_.dual.edges.begin(), result_.dual.edges.end());
    std::sort(result_.dual.vertices.begin(), result_.dual.vertices.end());
    std::sort(result_.dual.tets.begin(), result_.dual.tets.end());
    return std::move(result_);
  }

 private:
  // The record of the given spheres in a tet; it exists.
  Index cell_in(Index tet, Index sphere) const {
    Index r = rpd_.start[uz(tet)][0];
    while (rpd_.cells[uz(r)].sphere != sphere) ++r;
    return r;
  }
  Index facet_in(Index tet, const Edge& spheres) const {
    Index r = rpd_.start[uz(tet)][1];
    while (rpd_.facets[uz(r)].spheres != spheres) ++r;
    return r;
  }
  Index edge_in(Index tet, const Triangle& spheres) const {
    Index r = rpd_.start[uz(tet)][2];
    while (rpd_.edges[uz(r)].spheres != spheres) ++r;
    return r;
  }

  // Whether a sphere has its place on the line of a sharp edge. Cells may reach other lines, too.
  bool stands_on_line(Index sphere, Index sharp_edge) const {
    const SphereSeed& seed = spheres_.seeds[uz(sphere)];
    const Index l = domain_.features.edges[uz(sharp_edge)].line;
    if (seed.type == SphereType::kSharpEdge) return seed.line == l;
    const FeatureLine& line = domain_.features.lines[uz(l)];
    return seed.type == SphereType::kCorner && !line.closed &&
           (line.vertices.front() == seed.corner || line.vertices.back() == seed.corner);
  }

  // A tet at a sharp edge.
  Index tet_at(Index sharp_edge) const {
    return domain_.triangle_tets[uz(domain_.features.edges[uz(sharp_edge)].triangles[0])];
  }

  // A ball about the middle of the points that `others` share with `self` in the tet.
  Index add_vertex(Index tet, Index self, const std::vector<Index>& others) {
    engine_.piece(tet, self, clipper_);
    Vec3 sum;
    double n = 0;
    for (const PieceVertex& v : clipper_.vertices()) {
      std::size_t met = 0;
      for (const std::int32_t p : v.planes)
        met +=
            p >= kFirstBisector && std::find(others.begin(), others.end(), clipper_.sphere_of_plane(p)) != others.end();
      if (met == others.size()) sum += v.point, n += 1;
    }
    const Vec3 center = sum / n;
    SphereSeed seed{center, std::sqrt(domain_.query.closest(center).distance2)};
    const Index id = count(spheres_.seeds) + count(result_.added);
    result_.added.push_back(seed);
    result_.dual.vertices.push_back(id);
    return id;
  }

  void split_cells() {
    auto parts = parts_of<1>(
        rpd_.cells, components_.cells, [](const RpdCell& c) { return std::array{c.sphere}; },
        [](const RpdCell& c) { return c.volume; });
    for (const RpdStretch& s : rpd_.stretches)
      if (stands_on_line(s.sphere, s.sharp_edge))
        parts.at(components_.cells[uz(cell_in(tet_at(s.sharp_edge), s.sphere))]).on_line = true;
    for (const auto& [root, first] : first_parts(parts)) {
      const Part<1>& part = parts.at(root);
      const Index sphere = part.spheres[0];
      if (first) {
        result_.dual.vertices.push_back(sphere);
        vertex_of_cell_[root] = sphere;
      } else {
        vertex_of_cell_[root] = add_vertex(rpd_.cells[uz(part.record)].tet, sphere, {});
        result_.added.back().guard = spheres_.seeds[uz(sphere)].guard;
      }
    }
  }

  void split_facets() {
    auto parts = parts_of<2>(
        rpd_.facets, components_.facets, [](const RpdFacet& f) { return f.spheres; },
        [](const RpdFacet& f) { return f.area; });
    for (const RpdCrossing& c : rpd_.crossings)
      if (stands_on_line(c.spheres[0], c.sharp_edge) && stands_on_line(c.spheres[1], c.sharp_edge))
        parts.at(components_.facets[uz(facet_in(tet_at(c.sharp_edge), c.spheres))]).on_line = true;
    // The facet's own spheres, for a point of it; the vertices of its cells, for its corners.
    std::map<Index, Part<2>> in_vertices = parts;
    for (auto& [root, part] : in_vertices) {
      const RpdFacet& facet = rpd_.facets[uz(part.record)];
      for (std::size_t k = 0; k < 2; ++k) part.spheres[k] = vertex_at(facet.tet, facet.spheres[k]);
      std::sort(part.spheres.begin(), part.spheres.end());
    }
    for (const auto& [root, first] : first_parts(in_vertices)) {
      const Edge& ends = in_vertices.at(root).spheres;
      std::vector<Edge>& pieces = pieces_of_facet_[root];
      if (first) {
        pieces = {ends};
      } else {
        const RpdFacet& facet = rpd_.facets[uz(parts.at(root).record)];
        const Index middle = add_vertex(facet.tet, facet.spheres[0], {facet.spheres[1]});
        pieces = {{ends[0], middle}, {ends[1], middle}};
      }
      result_.dual.edges.insert(result_.dual.edges.end(), pieces.begin(), pieces.end());
    }
  }

  void split_edges() {
    auto parts = parts_of<3>(
        rpd_.edges, components_.edges, [](const RpdEdge& e) { return e.spheres; },
        [](const RpdEdge& e) { return e.length; });
    std::map<Index, Part<3>> in_vertices = parts;
    for (auto& [root, part] : in_vertices) {
      const RpdEdge& edge = rpd_.edges[uz(part.record)];
      for (std::size_t k = 0; k < 3; ++k) part.spheres[k] = vertex_at(edge.tet, edge.spheres[k]);
      std::sort(part.spheres.begin(), part.spheres.end());
    }
    for (const auto& [root, first] : first_parts(in_vertices)) {
      const auto& [a, b, c] = parts.at(root).spheres;
      const RpdEdge& edge = rpd_.edges[uz(parts.at(root).record)];
      std::vector<Edge> boundary;
      for (const Edge& pair : {Edge{a, b}, Edge{a, c}, Edge{b, c}}) {
        const auto& pieces = pieces_of_facet_.at(components_.facets[uz(facet_in(edge.tet, pair))]);
        boundary.insert(boundary.end(), pieces.begin(), pieces.end());
      }
      std::vector<Triangle>& pieces = pieces_of_edge_[root];
      if (first && boundary.size() == 3)
        pieces = {in_vertices.at(root).spheres};
      else
        pieces = cone(boundary, add_vertex(edge.tet, a, {b, c}));
      for (const Triangle& t : pieces) lengths_[t] = parts.at(root).measure;
    }
  }

  void split_vertices() {
    for (const RpdVertex& v : rpd_.vertices) {
      const auto& [a, b, c, d] = v.spheres;
      std::vector<Triangle> boundary;
      for (const Triangle& triple : {Triangle{a, b, c}, Triangle{a, b, d}, Triangle{a, c, d}, Triangle{b, c, d}}) {
        const auto& pieces = pieces_of_edge_.at(components_.edges[uz(edge_in(v.tet, triple))]);
        boundary.insert(boundary.end(), pieces.begin(), pieces.end());
      }
      if (boundary.size() == 4) {
        Tetrahedron tet{};
        for (std::size_t k = 0; k < 4; ++k) tet[k] = vertex_at(v.tet, v.spheres[k]);
        std::sort(tet.begin(), tet.end());
        result_.dual.tets.push_back(tet);
        continue;
      }
      const Index middle = add_vertex(v.tet, a, {b, c, d});
      std::vector<Edge> edges;
      for (const auto& [p, q, r] : boundary) {
        result_.dual.tets.push_back({p, q, r, middle});
        edges.insert(edges.end(), {{p, q}, {p, r}, {q, r}});
      }
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
      for (const Triangle& t : cone(edges, middle)) lengths_[t] = 0;
    }
  }

  // Triangles from `middle`, which has the greatest id so far, to edges; adds their edges to the complex.
  std::vector<Triangle> cone(const std::vector<Edge>& edges, Index middle) {
    std::vector<Triangle> triangles;
    std::vector<Index> corners;
    for (const auto& [p, q] : edges) {
      triangles.push_back({p, q, middle});
      corners.insert(corners.end(), {p, q});
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    for (const Index c : corners) result_.dual.edges.push_back({c, middle});
    return triangles;
  }

  Index vertex_at(Index tet, Index sphere) const {
    return vertex_of_cell_.at(components_.cells[uz(cell_in(tet, sphere))]);
  }

  // Of each component, by name, whether it is the first of those with its corners.
  template <std::size_t N>
  static std::map<Index, bool> first_parts(const std::map<Index, Part<N>>& parts) {
    std::map<std::array<Index, N>, Index> best;
    for (const auto& [root, part] : parts) {
      const auto [found, fresh] = best.try_emplace(part.spheres, root);
      const Part<N>& other = parts.at(found->second);
      if (!fresh && std::pair(part.on_line, part.measure) > std::pair(other.on_line, other.measure))
        found->second = root;
    }
    std::map<Index, bool> first;
    for (const auto& [root, part] : parts) first[root] = best.at(part.spheres) == root;
    return first;
  }

  const Domain& domain_;
  const RpdEngine& engine_;
  const Rpd& rpd_;
  const Spheres& spheres_;
  const RpdComponents& components_;
  Clipper clipper_;
  SplitDual result_;
  std::map<Index, Index> vertex_of_cell_;
  std::map<Index, std::vector<Edge>> pieces_of_facet_;
  std::map<Index, std::vector<Triangle>> pieces_of_edge_;
  std::map<Triangle, double> lengths_;
};

// Whether no two components have the same spheres.
template <class Record, class Key>
bool connected(const std::vector<Record>& records, const std::vector<Index>& roots, Key key) {
  std::vector<decltype(key(records[0]))> names;
  for (Index r = 0; r < count(records); ++r)
    if (roots[uz(r)] == r) names.push_back(key(records[uz(r)]));
  std::sort(names.begin(), names.end());
  return std::adjacent_find(names.begin(), names.end()) == names.end();
}

}  // namespace

SplitDual split_dual(const Domain& domain, const RpdEngine& engine, const Spheres& spheres,
                     const std::vector<PinchContact>& contacts) {
  const Rpd& rpd = engine.diagram();
  const RpdComponents components = rpd_components(domain, rpd, contacts);
  const auto spheres_of = [](const auto& record) { return record.spheres; };
  if (connected(rpd.cells, components.cells, [](const RpdCell& c) { return c.sphere; }) &&
      connected(rpd.facets, components.facets, spheres_of) && connected(rpd.edges, components.edges, spheres_of))
    return {dual_complex(rpd), {}};
  return Splitter(domain, engine, spheres, components).run();
}

}  // namespace matstruct
