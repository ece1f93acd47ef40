#include "extract/thinning.h"

#include <algorithm>
#include <queue>

#include "base/incidence.h"
#include "base/index.h"
#include "base/parallel.h"

namespace matstruct {

namespace {

constexpr Index kFaceGrain = 256;
// Two faces at an angle of more than 120 degrees (its cosine) lie side by side.
constexpr double kFlat = -0.5;

// The complex with the incidences that collapses need. Simplices are numbered as in the dual complex.
class Collapser {
 public:
  Collapser(const DualComplex& dual, const std::vector<Edge>& feature_edges)
      : dual_(dual),
        face_edges(dual.triangles.size()),
        tet_faces(dual.tets.size()),
        edge_alive(dual.edges.size(), 1),
        face_alive(dual.triangles.size(), 1),
        tet_alive(dual.tets.size(), 1),
        edge_protected(dual.edges.size(), 0),
        edge_degree(dual.edges.size(), 0),
        face_degree(dual.triangles.size(), 0),
        vertex_alive(dual.vertices.empty() ? 0 : uz(dual.vertices.back()) + 1, 1) {
    for (std::size_t f = 0; f < dual.triangles.size(); ++f) {
      const auto& [a, b, c] = dual.triangles[f];
      face_edges[f] = {edge_id({b, c}), edge_id({a, c}), edge_id({a, b})};
      for (const Index e : face_edges[f]) ++edge_degree[uz(e)];
    }
    for (std::size_t t = 0; t < dual.tets.size(); ++t) {
      const auto& [a, b, c, d] = dual.tets[t];
      tet_faces[t] = {face_id({b, c, d}), face_id({a, c, d}), face_id({a, b, d}), face_id({a, b, c})};
      for (const Index f : tet_faces[t]) ++face_degree[uz(f)];
    }
    for (const Edge& e : feature_edges)
      if (const Index id = find(dual.edges, e); id != kInvalid) edge_protected[uz(id)] = 1;
    build_cofaces();
  }

  // Removes every tet, always through the free face of greatest `badness`.
  void remove_tets(const std::vector<double>& badness, const std::vector<TangentSphere>& centers) {
    using Item = std::pair<double, Index>;
    std::priority_queue<Item> queue;
    const auto push = [&](Index f) {
      if (face_alive[uz(f)] && face_degree[uz(f)] == 1) queue.push({badness[uz(f)], f});
    };
    for (Index f = 0; f < count(dual_.triangles); ++f) push(f);
    while (!queue.empty()) {
      const Index f = queue.top().second;
      queue.pop();
      if (!face_alive[uz(f)] || face_degree[uz(f)] != 1) continue;
      const Index t = face_tets[uz(f)][0] != kInvalid && tet_alive[uz(face_tets[uz(f)][0])] ? face_tets[uz(f)][0]
                                                                                            : face_tets[uz(f)][1];
      tet_alive[uz(t)] = 0;
      remove_face(f);
      for (const Index g : tet_faces[uz(t)]) {
        --face_degree[uz(g)];
        push(g);
      }
      note_partner(t, f, centers);
    }
  }

  // Four spheres of one sheet make a flat tet, two triangulations of one quadrangle: with the face that the tet was
  // removed through goes the one that shares its diagonal. If a neighbour holds that, the first triangulation comes
  // back, if it is valid, and the second goes: the tet is put back with the face and removed through another one.
  void remove_partners(const std::vector<std::uint8_t>& face_valid) {
    for (bool changed = true; changed;) {
      changed = false;
      for (const Partners& p : partners_) {
        if (face_alive[uz(p.removed)] || !face_alive[uz(p.partner)] || face_degree[uz(p.partner)] != 0) continue;
        if (edge_degree[uz(p.diagonal)] == 1 && !edge_protected[uz(p.diagonal)]) {
          remove_face(p.partner);
          edge_alive[uz(p.diagonal)] = 0;
          changed = true;
        } else if (face_valid[uz(p.removed)] && exchange(p)) {
          changed = true;
        }
      }
    }
  }

  // Removes faces of importance below `threshold` through their free edges, least important first; of several free
  // edges the one of greatest `edge_rank`.
  void remove_faces(const std::vector<double>& importance, const std::vector<double>& edge_rank, double threshold) {
    using Item = std::pair<double, Index>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
    const auto push = [&](Index f) {
      if (face_alive[uz(f)] && importance[uz(f)] < threshold && free_edge(f, edge_rank) != kInvalid)
        queue.push({importance[uz(f)], f});
    };
    for (Index f = 0; f < count(dual_.triangles); ++f) push(f);
    while (!queue.empty()) {
      const Index f = queue.top().second;
      queue.pop();
      if (!face_alive[uz(f)]) continue;
      const Index e = free_edge(f, edge_rank);
      if (e == kInvalid) continue;
      remove_face(f);
      edge_alive[uz(e)] = 0;
      for (const Index g : face_edges[uz(f)])
        for (Index k = edge_face_start[uz(g)]; k < edge_face_start[uz(g) + 1]; ++k) push(edge_faces[uz(k)]);
    }
  }

  // Removes what is left of flat tets inside sheets: faces with a free edge that stand on an edge with two other faces
  // though no seam runs there.
  void remove_flaps(const std::vector<double>& importance, const std::vector<double>& edge_rank,
                    const std::vector<std::uint8_t>& edge_contacts) {
    using Item = std::pair<double, Index>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
    const auto is_flap = [&](Index f) {
      return face_alive[uz(f)] && free_edge(f, edge_rank) != kInvalid &&
             std::any_of(face_edges[uz(f)].begin(), face_edges[uz(f)].end(),
                         [&](Index e) { return edge_degree[uz(e)] >= 3 && edge_contacts[uz(e)] < 3; });
    };
    for (Index f = 0; f < count(dual_.triangles); ++f)
      if (is_flap(f)) queue.push({importance[uz(f)], f});
    while (!queue.empty()) {
      const Index f = queue.top().second;
      queue.pop();
      if (!is_flap(f)) continue;
      edge_alive[uz(free_edge(f, edge_rank))] = 0;
      remove_face(f);
      for (const Index g : face_edges[uz(f)])
        for (Index k = edge_face_start[uz(g)]; k < edge_face_start[uz(g) + 1]; ++k)
          if (is_flap(edge_faces[uz(k)])) queue.push({importance[uz(edge_faces[uz(k)])], edge_faces[uz(k)]});
    }
  }

  // Removes invalid edges of no face that end in a vertex of no other edge, with that vertex, if its ball is `cover`ed
  // by the other one.
  void remove_loose_edges(const std::vector<std::uint8_t>& edge_contacts, const std::vector<TangentSphere>& medial,
                          double cover) {
    std::vector<Index> degree(vertex_alive.size(), 0);
    for (std::size_t e = 0; e < dual_.edges.size(); ++e)
      if (edge_alive[e])
        for (const Index v : dual_.edges[e]) ++degree[uz(v)];
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t e = 0; e < dual_.edges.size(); ++e) {
        if (!edge_alive[e] || edge_contacts[e] > 0 || edge_degree[e] != 0 || edge_protected[e]) continue;
        const auto& [a, b] = dual_.edges[e];
        if (degree[uz(a)] != 1 && degree[uz(b)] != 1) continue;
        const Index end = degree[uz(a)] == 1 ? a : b;
        const TangentSphere &ball = medial[uz(end)], &other = medial[uz(a + b - end)];
        if (distance(ball.center, other.center) + ball.radius > other.radius + cover) continue;
        edge_alive[e] = 0;
        vertex_alive[uz(end)] = 0;
        --degree[uz(a)], --degree[uz(b)];
        changed = true;
      }
    }
  }

 private:
  // Of a flat tet the face that it was removed through and the one that makes the flattest pair with it, and the edge
  // that the two share.
  struct Partners {
    Index tet, removed, partner, diagonal;
  };

  template <std::size_t N>
  static Index find(const std::vector<std::array<Index, N>>& simplices, const std::array<Index, N>& key) {
    const auto found = std::lower_bound(simplices.begin(), simplices.end(), key);
    return found != simplices.end() && *found == key ? static_cast<Index>(found - simplices.begin()) : kInvalid;
  }
  Index edge_id(const Edge& e) const { return find(dual_.edges, e); }
  Index face_id(const Triangle& f) const { return find(dual_.triangles, f); }

  void build_cofaces() {
    face_tets.assign(dual_.triangles.size(), {kInvalid, kInvalid});
    for (std::size_t t = 0; t < dual_.tets.size(); ++t)
      for (const Index f : tet_faces[t])
        face_tets[uz(f)][face_tets[uz(f)][0] == kInvalid ? 0 : 1] = static_cast<Index>(t);
    edge_face_start.assign(dual_.edges.size() + 1, 0);
    for (std::size_t e = 0; e < dual_.edges.size(); ++e) edge_face_start[e + 1] = edge_face_start[e] + edge_degree[e];
    edge_faces.resize(uz(edge_face_start.back()));
    std::vector<Index> next = edge_face_start;
    for (std::size_t f = 0; f < dual_.triangles.size(); ++f)
      for (const Index e : face_edges[f]) edge_faces[uz(next[uz(e)]++)] = static_cast<Index>(f);
  }

  // Of the faces that remain of tet t after face f the one that makes the flattest pair with it.
  void note_partner(Index t, Index f, const std::vector<TangentSphere>& centers) {
    const auto normal_from = [&](const Edge& e, Index apex) {  // unit, across the edge, towards the apex
      const Vec3 &a = centers[uz(e[0])].center, along = normalized(centers[uz(e[1])].center - a);
      const Vec3 to = centers[uz(apex)].center - a;
      return normalized(to - along * dot(to, along));
    };
    const auto apex_of = [&](Index face, const Edge& e) {
      for (const Index v : dual_.triangles[uz(face)])
        if (v != e[0] && v != e[1]) return v;
      return kInvalid;
    };
    std::pair<Index, Index> best{kInvalid, kInvalid};
    double least = kFlat;
    for (const Index g : tet_faces[uz(t)]) {
      if (!face_alive[uz(g)]) continue;
      for (const Index e : face_edges[uz(g)]) {
        const auto& own = face_edges[uz(f)];
        if (std::find(own.begin(), own.end(), e) == own.end()) continue;
        const Edge& edge = dual_.edges[uz(e)];
        const double cosine = dot(normal_from(edge, apex_of(f, edge)), normal_from(edge, apex_of(g, edge)));
        if (cosine < least) best = {g, e}, least = cosine;
      }
    }
    if (best.first != kInvalid) partners_.push_back({t, f, best.first, best.second});
  }

  // Puts the removed face of a flat tet back for the two that are not its partner, through their common edge. Returns
  // whether that can be done.
  bool exchange(const Partners& p) {
    std::vector<Index> others;
    for (const Index g : tet_faces[uz(p.tet)])
      if (g != p.removed && g != p.partner) others.push_back(g);
    const auto is_bare = [&](Index f) { return face_alive[uz(f)] && face_degree[uz(f)] == 0; };
    const auto is_alive = [&](Index e) { return edge_alive[uz(e)] != 0; };
    const auto& back = face_edges[uz(p.removed)];
    if (!is_bare(others[0]) || !is_bare(others[1]) || !std::all_of(back.begin(), back.end(), is_alive)) return false;
    const auto &first = face_edges[uz(others[0])], &second = face_edges[uz(others[1])];
    const Index common = *std::find_first_of(first.begin(), first.end(), second.begin(), second.end());
    if (edge_degree[uz(common)] != 2 || edge_protected[uz(common)]) return false;
    for (const Index g : others) remove_face(g);
    edge_alive[uz(common)] = 0;
    face_alive[uz(p.removed)] = 1;
    for (const Index e : back) ++edge_degree[uz(e)];
    return true;
  }

  void remove_face(Index f) {
    face_alive[uz(f)] = 0;
    for (const Index e : face_edges[uz(f)]) --edge_degree[uz(e)];
  }

  // The free and unprotected edge of greatest rank of a face without tets, or kInvalid.
  Index free_edge(Index f, const std::vector<double>& edge_rank) const {
    if (face_degree[uz(f)] != 0) return kInvalid;
    Index best = kInvalid;
    for (const Index e : face_edges[uz(f)])
      if (edge_degree[uz(e)] == 1 && !edge_protected[uz(e)] &&
          (best == kInvalid || edge_rank[uz(e)] > edge_rank[uz(best)]))
        best = e;
    return best;
  }

  const DualComplex& dual_;
  std::vector<Partners> partners_;

 public:
  std::vector<Triangle> face_edges;
  std::vector<Tetrahedron> tet_faces;
  std::vector<Edge> face_tets;  // the one or two tets on a face
  std::vector<Index> edge_face_start, edge_faces;
  std::vector<std::uint8_t> edge_alive, face_alive, tet_alive, edge_protected;
  std::vector<Index> edge_degree, face_degree;  // number of alive cofaces
  std::vector<std::uint8_t> vertex_alive;       // by sphere
};

bool is_feature(const SphereSeed& s) {
  return s.type == SphereType::kSharpEdge || s.type == SphereType::kCorner;
}

std::vector<double> face_importance(const Spheres& spheres, const DualComplex& dual) {
  std::vector<double> importance(dual.triangles.size(), 0);
  for (std::size_t f = 0; f < dual.triangles.size(); ++f) {
    double sum = 0;
    int n = 0;
    for (const Index s : dual.triangles[f])
      if (!is_feature(spheres.seeds[uz(s)])) sum += spheres.seeds[uz(s)].radius, ++n;
    if (n > 0) importance[f] = dual.lengths[f] / (2 * sum / n);
  }
  return importance;
}

// How far a face is from the medial axis: interpolated radius against the distance to the surface, at its centroid.
std::vector<double> face_deviation(const Domain& domain, const Spheres& spheres, const DualComplex& dual,
                                   const Context& context) {
  std::vector<double> deviation(dual.triangles.size(), 0);
  parallel_for(context, count(dual.triangles), kFaceGrain, [&](Index begin, Index end) {
    for (Index f = begin; f < end; ++f) {
      Vec3 center;
      double radius = 0;
      for (const Index s : dual.triangles[uz(f)]) {
        center += spheres.seeds[uz(s)].center / 3;
        radius += spheres.seeds[uz(s)].radius / 3;
      }
      deviation[uz(f)] = std::abs(std::sqrt(domain.query.closest(center).distance2) - radius);
    }
  });
  return deviation;
}

ThinMesh mesh_of(const Spheres& spheres, const std::vector<TangentSphere>& medial, const DualComplex& dual,
                 const SimplexClasses& classes, const Collapser& c) {
  ThinMesh thin;
  MedialMesh& mesh = thin.mesh;
  std::vector<Index> vertex(spheres.seeds.size(), kInvalid);
  for (const Index s : dual.vertices) {
    if (!c.vertex_alive[uz(s)]) continue;
    vertex[uz(s)] = count(mesh.centers);
    mesh.centers.push_back(medial[uz(s)].center);
    mesh.radii.push_back(medial[uz(s)].radius);
    mesh.types.push_back(spheres.seeds[uz(s)].type);
    thin.spheres.push_back(s);
  }
  for (std::size_t e = 0; e < dual.edges.size(); ++e)
    if (c.edge_alive[e]) {
      mesh.edges.push_back({vertex[uz(dual.edges[e][0])], vertex[uz(dual.edges[e][1])]});
      thin.edge_contacts.push_back(classes.edge_contacts[e]);
    }
  for (std::size_t f = 0; f < dual.triangles.size(); ++f)
    if (c.face_alive[f]) {
      const auto& [i, j, k] = dual.triangles[f];
      mesh.faces.push_back({vertex[uz(i)], vertex[uz(j)], vertex[uz(k)]});
      thin.face_invalid.push_back(!classes.face_valid[f]);
    }
  return thin;
}

}  // namespace

InvalidEdges invalid_edges(const ThinMesh& thin) {
  const MedialMesh& mesh = thin.mesh;
  std::vector<std::uint8_t> has_face(mesh.edges.size(), 0);
  for (const Triangle& edges : edges_of_faces(mesh.edges, mesh.faces))
    for (const Index e : edges) has_face[uz(e)] = 1;
  InvalidEdges result;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    if (thin.edge_contacts[e] == 0)
      (has_face[e] ? result.shortcuts : result.loose)
          .push_back({thin.spheres[uz(mesh.edges[e][0])], thin.spheres[uz(mesh.edges[e][1])]});
  return result;
}

ThinMesh thin(const Domain& domain, const Spheres& spheres, const std::vector<TangentSphere>& medial,
              const DualComplex& dual, const SimplexClasses& classes, const std::vector<Edge>& feature_edges,
              const ThinningOptions& options, const Context& context) {
  Collapser collapser(dual, feature_edges);
  // Lengths in the internal frame are at most 1: an offset of 2 ranks the invalid before the valid, before these those
  // with an invalid edge (in a bend of a sheet or seam the middle of a face may be in no stratum, though all its edges
  // are), and first of all those with an edge from one sharp line to another that is in no sheet: on a face of the
  // solid between two lines they deviate by nothing.
  constexpr double kInvalidFirst = 2;
  std::vector<double> badness = face_deviation(domain, spheres, dual, context);
  std::vector<double> importance = face_importance(spheres, dual);
  std::vector<double> edge_rank;
  for (std::size_t f = 0; f < dual.triangles.size(); ++f)
    if (!classes.face_valid[f]) {
      const auto& edges = collapser.face_edges[f];
      const bool across = std::any_of(edges.begin(), edges.end(), [&](Index e) {
        const auto& [a, b] = dual.edges[uz(e)];
        return classes.edge_contacts[uz(e)] < 2 && is_feature(spheres.seeds[uz(a)]) && is_feature(spheres.seeds[uz(b)]);
      });
      const bool edge_invalid =
          std::any_of(edges.begin(), edges.end(), [&](Index e) { return classes.edge_contacts[uz(e)] == 0; });
      badness[f] += across ? 3 * kInvalidFirst : edge_invalid ? 2 * kInvalidFirst : kInvalidFirst;
      importance[f] = -badness[f];
    }
  for (std::size_t e = 0; e < dual.edges.size(); ++e)
    edge_rank.push_back(
        distance(spheres.seeds[uz(dual.edges[e][0])].center, spheres.seeds[uz(dual.edges[e][1])].center) +
        (classes.edge_contacts[e] > 0 ? 0 : kInvalidFirst));
  collapser.remove_tets(badness, medial);
  collapser.remove_faces(importance, edge_rank, 0);
  collapser.remove_partners(classes.face_valid);
  collapser.remove_flaps(importance, edge_rank, classes.edge_contacts);
  collapser.remove_faces(importance, edge_rank, 0);
  collapser.remove_loose_edges(classes.edge_contacts, medial, options.cover);
  collapser.remove_faces(importance, edge_rank, options.importance);
  collapser.remove_flaps(importance, edge_rank, classes.edge_contacts);
  return mesh_of(spheres, medial, dual, classes, collapser);
}

}  // namespace matstruct
