#include <matstruct/strata.h>

#include <algorithm>
#include <span>

#include "base/index.h"
#include "base/union_find.h"

namespace matstruct {

namespace {

enum class EdgeStratum : std::uint8_t { kSheet, kSeam, kBoundary, kCurve };

EdgeStratum stratum_of(std::size_t faces) {
  if (faces == 2) return EdgeStratum::kSheet;
  if (faces == 1) return EdgeStratum::kBoundary;
  return faces == 0 ? EdgeStratum::kCurve : EdgeStratum::kSeam;
}

// Lists of elements per element, one after the other.
struct Lists {
  std::vector<Index> start, items;
  std::span<const Index> of(Index k) const { return {items.data() + start[uz(k)], items.data() + start[uz(k) + 1]}; }
};

// `pairs`: (list, item), in any order; items of a list end up ascending.
Lists group(std::vector<std::array<Index, 2>> pairs, std::size_t lists) {
  std::sort(pairs.begin(), pairs.end());
  Lists result;
  result.start.assign(lists + 1, 0);
  for (const auto& [list, item] : pairs) {
    ++result.start[uz(list) + 1];
    result.items.push_back(item);
  }
  for (std::size_t k = 0; k < lists; ++k) result.start[k + 1] += result.start[k];
  return result;
}

Lists faces_of_edges(const MedialMesh& mesh) {
  std::vector<std::array<Index, 2>> pairs;
  for (Index f = 0; f < count(mesh.faces); ++f) {
    const auto& [a, b, c] = mesh.faces[uz(f)];
    for (const Edge& e : {Edge{a, b}, Edge{a, c}, Edge{b, c}}) {
      const auto at = std::lower_bound(mesh.edges.begin(), mesh.edges.end(), e);
      pairs.push_back({static_cast<Index>(at - mesh.edges.begin()), f});
    }
  }
  return group(std::move(pairs), mesh.edges.size());
}

// Walks along the edges that lie inside no sheet.
class CurveTracer {
 public:
  CurveTracer(const MedialMesh& mesh, const Lists& faces, Strata& strata)
      : mesh_(mesh), faces_(faces), strata_(strata), seen_(mesh.edges.size(), false) {
    std::vector<std::array<Index, 2>> pairs;
    for (Index e = 0; e < count(mesh.edges); ++e)
      if (kind(e) != EdgeStratum::kSheet)
        for (const Index v : mesh.edges[uz(e)]) pairs.push_back({v, e});
    edges_ = group(std::move(pairs), mesh.centers.size());
  }

  void run() {
    for (Index e = 0; e < count(mesh_.edges); ++e)
      if (kind(e) != EdgeStratum::kSheet && !seen_[uz(e)]) trace(e);
    for (Index v = 0; v < count(mesh_.centers); ++v) {
      const auto seams = std::count_if(edges_.of(v).begin(), edges_.of(v).end(),
                                       [&](Index e) { return kind(e) == EdgeStratum::kSeam; });
      if (seams >= 2 && is_end(v)) strata_.junctions.push_back(v);
    }
  }

 private:
  EdgeStratum kind(Index e) const { return stratum_of(faces_.of(e).size()); }

  std::vector<Index> sheets(Index e) const {
    std::vector<Index> result;
    for (const Index f : faces_.of(e)) result.push_back(strata_.sheet_of_face[uz(f)]);
    std::sort(result.begin(), result.end());
    return result;
  }

  // Curves pass a vertex only where there are just two of these edges and they are alike.
  bool is_end(Index v) const {
    const auto e = edges_.of(v);
    return e.size() != 2 || kind(e[0]) != kind(e[1]) || sheets(e[0]) != sheets(e[1]);
  }

  // The vertices from `from` across `edge` and on, up to an end of the curve or back to `from`.
  std::vector<Index> walk(Index from, Index edge) {
    std::vector<Index> chain{from};
    while (true) {
      seen_[uz(edge)] = true;
      const Edge& e = mesh_.edges[uz(edge)];
      chain.push_back(e[0] == chain.back() ? e[1] : e[0]);
      if (chain.back() == from || is_end(chain.back())) return chain;
      const auto next = edges_.of(chain.back());
      edge = next[0] == edge ? next[1] : next[0];
    }
  }

  void trace(Index edge) {
    const Edge& e = mesh_.edges[uz(edge)];
    Curve curve;
    curve.sheets = sheets(edge);
    curve.vertices = walk(e[0], edge);
    if (!curve.closed() && !is_end(e[0])) {
      const auto around = edges_.of(e[0]);
      const std::vector<Index> back = walk(e[0], around[0] == edge ? around[1] : around[0]);
      curve.vertices.insert(curve.vertices.begin(), back.rbegin(), back.rend() - 1);
    }
    switch (kind(edge)) {
      case EdgeStratum::kSeam:
        strata_.seams.push_back(std::move(curve));
        break;
      case EdgeStratum::kBoundary:
        strata_.boundaries.push_back(std::move(curve));
        break;
      case EdgeStratum::kCurve:
        strata_.curves.push_back(std::move(curve));
        break;
      case EdgeStratum::kSheet:
        break;
    }
  }

  const MedialMesh& mesh_;
  const Lists& faces_;
  Strata& strata_;
  Lists edges_;  // per vertex, those that lie inside no sheet
  std::vector<bool> seen_;
};

void number_sheets(const MedialMesh& mesh, const Lists& faces, Strata& strata) {
  UnionFind sets(count(mesh.faces));
  for (Index e = 0; e < count(mesh.edges); ++e)
    if (const auto f = faces.of(e); f.size() == 2) sets.unite(f[0], f[1]);
  std::vector<Index> number(mesh.faces.size(), kInvalid);
  for (Index f = 0; f < count(mesh.faces); ++f) {
    Index& n = number[uz(sets.find(f))];
    if (n == kInvalid) n = strata.sheets++;
    strata.sheet_of_face.push_back(n);
  }
}

}  // namespace

Strata trace_strata(const MedialMesh& mesh) {
  const Lists faces = faces_of_edges(mesh);
  Strata strata;
  number_sheets(mesh, faces, strata);
  CurveTracer(mesh, faces, strata).run();
  return strata;
}

double length_of(const MedialMesh& mesh, const Curve& curve) {
  double length = 0;
  for (std::size_t k = 1; k < curve.vertices.size(); ++k)
    length += distance(mesh.centers[uz(curve.vertices[k - 1])], mesh.centers[uz(curve.vertices[k])]);
  return length;
}

}  // namespace matstruct
