#include "extract/guards.h"

#include <algorithm>
#include <numeric>

#include "base/index.h"
#include "base/union_find.h"

namespace matstruct {

namespace {

// Simplices of the dual complex around one guard.
struct Star {
  std::vector<Index> edges, triangles, tets;
};

class GuardCutter {
 public:
  GuardCutter(const DualComplex& dual, const Spheres& spheres)
      : dual_(dual),
        edge_alive_(dual.edges.size(), true),
        triangle_alive_(dual.triangles.size(), true),
        tet_alive_(dual.tets.size(), true),
        star_of_(spheres.seeds.size(), kInvalid) {
    for (const Index v : dual.vertices)
      if (spheres.seeds[uz(v)].guard) star_of_[uz(v)] = count(guards_), guards_.push_back(v);
    stars_.resize(guards_.size());
    cut_.resize(guards_.size());
    gather(dual.edges, &Star::edges);
    gather(dual.triangles, &Star::triangles);
    gather(dual.tets, &Star::tets);
    rank_.assign(spheres.seeds.size(), kInvalid);
  }

  // Cuts guards until only those resist whose links are not contractible, and returns these.
  std::vector<Index> run() {
    std::vector<Index> waiting = guards_;
    while (!waiting.empty()) {
      std::vector<Index> resisting;
      for (const Index g : waiting)
        if (link_contractible(g))
          cut(g);
        else
          resisting.push_back(g);
      if (resisting.size() == waiting.size()) break;
      waiting = std::move(resisting);
    }
    return waiting;
  }

  std::vector<Edge> alive_edges_between(const std::vector<Index>& guards) const {
    std::vector<Edge> result;
    for (const Index g : guards)
      for (const Index e : stars_[uz(star_of_[uz(g)])].edges)
        if (edge_alive_[uz(e)] && dual_.edges[uz(e)][0] == g && star_of_[uz(dual_.edges[uz(e)][1])] != kInvalid)
          result.push_back(dual_.edges[uz(e)]);
    return result;
  }

  DualComplex rest() const {
    DualComplex result;
    for (const Index v : dual_.vertices)
      if (star_of_[uz(v)] == kInvalid || !cut_[uz(star_of_[uz(v)])]) result.vertices.push_back(v);
    for (std::size_t k = 0; k < dual_.edges.size(); ++k)
      if (edge_alive_[k]) result.edges.push_back(dual_.edges[k]);
    for (std::size_t k = 0; k < dual_.triangles.size(); ++k)
      if (triangle_alive_[k]) {
        result.triangles.push_back(dual_.triangles[k]);
        result.lengths.push_back(dual_.lengths[k]);
      }
    for (std::size_t k = 0; k < dual_.tets.size(); ++k)
      if (tet_alive_[k]) result.tets.push_back(dual_.tets[k]);
    return result;
  }

 private:
  void cut(Index guard) {
    cut_[uz(star_of_[uz(guard)])] = true;
    const Star& star = stars_[uz(star_of_[uz(guard)])];
    for (const Index e : star.edges) edge_alive_[uz(e)] = false;
    for (const Index t : star.triangles) triangle_alive_[uz(t)] = false;
    for (const Index t : star.tets) tet_alive_[uz(t)] = false;
  }

  template <class Simplex>
  void gather(const std::vector<Simplex>& simplices, std::vector<Index> Star::*member) {
    for (Index k = 0; k < count(simplices); ++k)
      for (const Index v : simplices[uz(k)])
        if (const Index g = star_of_[uz(v)]; g != kInvalid) (stars_[uz(g)].*member).push_back(k);
  }

  // Connected and of Euler characteristic 1: contractible, as a part of a 2-sphere.
  bool link_contractible(Index guard) {
    const Star& star = stars_[uz(star_of_[uz(guard)])];
    Index vertices = 0, edges = 0, triangles = 0;
    for (const Index e : star.edges)
      if (edge_alive_[uz(e)]) rank_[uz(other(dual_.edges[uz(e)], guard))] = vertices++;
    UnionFind sets(vertices);
    Index pieces = vertices;
    for (const Index t : star.triangles) {
      if (!triangle_alive_[uz(t)]) continue;
      ++edges;
      std::array<Index, 2> ends{};
      std::size_t n = 0;
      for (const Index v : dual_.triangles[uz(t)])
        if (v != guard) ends[n++] = rank_[uz(v)];
      pieces -= sets.unite(ends[0], ends[1]) ? 1 : 0;
    }
    for (const Index t : star.tets) triangles += tet_alive_[uz(t)] ? 1 : 0;
    return pieces == 1 && vertices - edges + triangles == 1;
  }

  static Index other(const Edge& e, Index v) { return e[0] == v ? e[1] : e[0]; }

  const DualComplex& dual_;
  std::vector<bool> edge_alive_, triangle_alive_, tet_alive_;
  std::vector<Index> star_of_;  // per sphere: its star, kInvalid if it is no guard
  std::vector<Index> guards_;
  std::vector<Star> stars_;
  std::vector<bool> cut_;    // per star
  std::vector<Index> rank_;  // scratch: number of a link vertex
};

}  // namespace

GuardRemoval remove_guards(const DualComplex& dual, const Spheres& spheres) {
  GuardCutter cutter(dual, spheres);
  GuardRemoval result;
  result.forced = cutter.run();
  for (const Edge& e : cutter.alive_edges_between(result.forced)) {
    const SphereSeed &a = spheres.seeds[uz(e[0])], &b = spheres.seeds[uz(e[1])];
    if (a.line != b.line || distance(a.center, b.center) > a.reach + b.reach) result.meeting.push_back(e);
  }
  result.dual = cutter.rest();
  return result;
}

}  // namespace matstruct
