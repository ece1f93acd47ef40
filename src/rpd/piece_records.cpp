#include "rpd/piece_records.h"

#include <map>
#include <tuple>

#include "base/index.h"

namespace matstruct {

namespace {

// A face of the piece: the planes it lies on, the tet's facets first.
template <std::size_t N>
struct Name {
  std::array<std::int32_t, N> planes;

  std::size_t facet_count() const {
    std::size_t n = 0;
    for (const std::int32_t p : planes) n += p < kFirstBisector;
    return n;
  }
};

// Local index of the edge that lies on both facets.
constexpr int find_edge_on(int f, int g) {
  for (int e = 0; e < 6; ++e) {
    const auto [a, b] = kTetEdges[uz(e)];
    if (a != f && a != g && b != f && b != g) return e;
  }
  return kInvalid;
}

constexpr auto kEdgeOn = [] {
  std::array<std::array<int, 4>, 4> table{};
  for (int f = 0; f < 4; ++f)
    for (int g = 0; g < 4; ++g) table[uz(f)][uz(g)] = find_edge_on(f, g);
  return table;
}();

int edge_on(int f, int g) {
  return kEdgeOn[uz(f)][uz(g)];
}

template <std::size_t N>
bool owns(const TetOwnership& own, const Name<N>& name, std::size_t facet_count) {
  const auto& p = name.planes;
  if (facet_count == 0) return true;
  if (facet_count == 1) return own.facets[uz(p[0])];
  if constexpr (N >= 2)
    if (facet_count == 2) return own.edges[uz(edge_on(p[0], p[1]))];
  if constexpr (N >= 3) return own.vertices[uz(6 - p[0] - p[1] - p[2])];
  return false;
}

template <std::size_t N>
std::array<Index, N> sorted(std::array<Index, N> ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

// Walks over the faces of one piece and writes what they are.
class Recorder {
 public:
  Recorder(Clipper& clipper, const Domain& domain, const TetOwnership& own, Index tet, Index self, PieceRecords& out)
      : clipper_(clipper), domain_(domain), own_(own), tet_(tet), self_(self), out_(out) {}

  std::int32_t run() {
    const std::vector<int>& planes = clipper_.planes();
    out_.facet_of_plane.assign(uz(planes.back()) + 1, kInvalid);
    for (const int p : planes) add_plane(p);
    for (std::size_t v = 0; v < clipper_.vertices().size(); ++v) add_vertex(v);
    cell_.tet = tet_;
    cell_.sphere = self_;
    cell_.volume = clipper_.volume();
    cell_.euler += -1;
    out_.cells.push_back(cell_);
    return whole_ - 1;
  }

 private:
  // Adds a face of the piece, of the given sign (-1)^dim, to every Euler characteristic that it is part of. Returns
  // whether this piece's sphere is the least of the name's: it writes what they share.
  template <std::size_t N>
  bool tally(const Name<N>& name, std::size_t facet_count, int sign) {
    bool least = true;
    const bool owned = owns(own_, name, facet_count);
    if (owned) cell_.euler += sign;
    for (std::size_t k = facet_count; k < N; ++k) {
      const Index f = record_of(name.planes[k]);
      if (f == kInvalid)
        least = false;
      else if (owned)
        out_.facets[uz(f)].euler += sign;
    }
    if (owned && least) whole_ += sign;
    return least;
  }

  // Record of the facet on a bisector, which is written with the lesser of its two spheres; kInvalid if that is not
  // this piece's.
  Index record_of(std::int32_t plane) const { return out_.facet_of_plane[uz(plane)]; }
  Index sphere_on(std::int32_t plane) const { return clipper_.sphere_of_plane(plane); }

  void add_plane(int plane) {
    if (plane < kFirstBisector) {
      cell_.facets = static_cast<std::uint8_t>(cell_.facets | (1 << plane));
    } else if (const Index other = sphere_on(plane); self_ < other) {
      out_.facet_of_plane[uz(plane)] = count(out_.facets);
      out_.facets.push_back({tet_, {self_, other}, clipper_.area(plane), 0, 0});
    }
    tally(Name<1>{{plane}}, plane < kFirstBisector ? 1 : 0, 1);
  }

  void add_vertex(std::size_t index) {
    const PieceVertex& v = clipper_.vertices()[index];
    const Name<3> name{v.planes};
    const auto& p = v.planes;
    const std::size_t facet_count = name.facet_count();
    if (tally(name, facet_count, 1)) {
      if (facet_count == 0)
        out_.vertices.push_back({tet_, sorted<4>({self_, sphere_on(p[0]), sphere_on(p[1]), sphere_on(p[2])})});
      if (facet_count == 2)
        if (const Index sharp = sharp_edge_on(p[0], p[1]); sharp != kInvalid)
          out_.crossings.push_back({sharp, {self_, sphere_on(p[2])}});
    }
    for (std::size_t k = 0; k < 3; ++k)
      if (static_cast<std::int32_t>(index) < v.neighbors[k]) add_edge(v, k);
  }

  void add_edge(const PieceVertex& v, std::size_t leaving) {
    const PieceVertex& w = clipper_.vertices()[uz(v.neighbors[leaving])];
    const Name<2> name{{v.planes[leaving == 0 ? 1 : 0], v.planes[leaving == 2 ? 1 : 2]}};
    const auto& p = name.planes;
    const std::size_t facet_count = name.facet_count();
    const bool least = tally(name, facet_count, -1);
    if (facet_count == 1 && least) {
      RpdFacet& f = out_.facets[uz(record_of(p[1]))];
      f.facets = static_cast<std::uint8_t>(f.facets | (1 << p[0]));
    }
    if (facet_count == 0 && least) {
      RpdEdge e{tet_, sorted<3>({self_, sphere_on(p[0]), sphere_on(p[1])}), distance(v.point, w.point), 0};
      for (const PieceVertex* end : {&v, &w})
        if (end->planes[0] < kFirstBisector) e.facets = static_cast<std::uint8_t>(e.facets | (1 << end->planes[0]));
      out_.edges.push_back(e);
    }
    if (facet_count == 2)
      if (const Index sharp = sharp_edge_on(p[0], p[1]); sharp != kInvalid) add_stretch(sharp, v.point, w.point);
  }

  Index sharp_edge_on(int f, int g) const { return own_.sharp_edges[uz(edge_on(f, g))]; }

  void add_stretch(Index sharp, const Vec3& p, const Vec3& q) {
    const auto [a, b] = domain_.features.edges[uz(sharp)].vertices;
    const Vec3 origin = domain_.surface.vertices[uz(a)];
    const Vec3 along = domain_.surface.vertices[uz(b)] - origin;
    const double s = dot(p - origin, along) / norm2(along);
    const double t = dot(q - origin, along) / norm2(along);
    out_.stretches.push_back({sharp, self_, std::min(s, t), std::max(s, t)});
  }

  Clipper& clipper_;
  const Domain& domain_;
  const TetOwnership& own_;
  Index tet_, self_;
  PieceRecords& out_;
  RpdCell cell_;
  std::int32_t whole_ = 0;
};

}  // namespace

std::int32_t append_piece(Clipper& clipper, const Domain& domain, const TetOwnership& own, Index tet, Index sphere,
                          PieceRecords& out) {
  return Recorder(clipper, domain, own, tet, sphere, out).run();
}

std::vector<TetOwnership> tet_ownership(const Domain& domain) {
  const auto& tets = domain.solid.tets;
  std::vector<TetOwnership> own(tets.size());
  for (Index t = 0; t < count(tets); ++t)
    for (std::size_t k = 0; k < 4; ++k) {
      const Index neighbor = domain.tet_neighbors[uz(t)][k];
      own[uz(t)].facets[k] = neighbor == kInvalid || t < neighbor;
    }

  std::vector<bool> vertex_seen(domain.solid.vertices.size(), false);
  std::vector<std::tuple<Edge, Index, int>> edges;  // (vertices, tet, local edge)
  edges.reserve(tets.size() * 6);
  for (Index t = 0; t < count(tets); ++t) {
    Tetrahedron v = tets[uz(t)];
    for (Index& corner : v) corner = domain.points[uz(corner)];
    for (std::size_t k = 0; k < 4; ++k) {
      own[uz(t)].vertices[k] = !vertex_seen[uz(v[k])];
      vertex_seen[uz(v[k])] = true;
    }
    for (int e = 0; e < 6; ++e) {
      const auto [a, b] = kTetEdges[uz(e)];
      edges.push_back({sorted<2>({v[uz(a)], v[uz(b)]}), t, e});
    }
    own[uz(t)].sharp_edges.fill(kInvalid);
  }
  std::sort(edges.begin(), edges.end());
  std::map<Edge, Index> sharp;
  for (Index s = 0; s < count(domain.features.edges); ++s) sharp[domain.features.edges[uz(s)].vertices] = s;
  for (std::size_t n = 0; n < edges.size(); ++n) {
    const auto& [vertices, tet, local] = edges[n];
    if (n > 0 && std::get<0>(edges[n - 1]) == vertices) continue;
    own[uz(tet)].edges[uz(local)] = true;
    if (const auto found = sharp.find(vertices); found != sharp.end())
      own[uz(tet)].sharp_edges[uz(local)] = found->second;
  }
  return own;
}

}  // namespace matstruct
