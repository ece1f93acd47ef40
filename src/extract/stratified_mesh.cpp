#include "extract/stratified_mesh.h"

#include <algorithm>

#include <matstruct/strata.h>

#include "base/index.h"
#include "base/union_find.h"

namespace matstruct {

namespace {

bool holds(const std::vector<Edge>& edges, Index a, Index b) {
  return std::binary_search(edges.begin(), edges.end(), ordered_edge(a, b));
}

std::vector<Edge> curve_edges_of(const MedialMesh& mesh, const std::vector<Edge>& fixed_edges) {
  std::vector<Edge> sides;
  for (const auto& [a, b, c] : mesh.faces) sides.insert(sides.end(), {Edge{a, b}, Edge{a, c}, Edge{b, c}});
  std::sort(sides.begin(), sides.end());
  std::vector<Edge> result = fixed_edges;
  for (const Edge& e : mesh.edges) {
    const auto [first, last] = std::equal_range(sides.begin(), sides.end(), e);
    if (last - first != 2) result.push_back(e);
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// The star of one vertex: its faces, in fans that are connected over edges inside sheets.
class Star {
 public:
  Star(Index center, const std::vector<const Triangle*>& faces, const std::vector<Edge>& curve_edges)
      : sets_(count(faces)) {
    std::vector<std::array<Index, 2>> spokes;  // (neighbour, face)
    for (Index f = 0; f < count(faces); ++f)
      for (const Index v : *faces[uz(f)])
        if (v != center) spokes.push_back({v, f});
    std::sort(spokes.begin(), spokes.end());
    for (std::size_t k = 0; k < spokes.size(); ++k) {
      const auto [v, f] = spokes[k];
      if (holds(curve_edges, center, v))
        on_curves_.push_back(spokes[k]);
      else if (k > 0 && spokes[k - 1][0] == v)
        sets_.unite(f, spokes[k - 1][1]);
    }
    for (Index f = 0; f < count(faces); ++f) fans_ += sets_.find(f) == f ? 1 : 0;
  }

  Index fans() const { return fans_; }
  /// Whether every fan begins at one of the two curve edges and ends at the other.
  bool half_disks() {
    if (count(on_curves_) != 2 * fans_) return false;
    std::vector<std::array<Index, 2>> ends;  // (fan, neighbour)
    for (const auto& [v, f] : on_curves_) ends.push_back({sets_.find(f), v});
    std::sort(ends.begin(), ends.end());
    for (std::size_t k = 0; k < ends.size(); k += 2)
      if (ends[k][0] != ends[k + 1][0] || ends[k][1] == ends[k + 1][1]) return false;
    return true;
  }

 private:
  UnionFind sets_;
  std::vector<std::array<Index, 2>> on_curves_;  // (neighbour, face) of the faces at curve edges
  Index fans_ = 0;
};

/// Marks the inner vertices of a curve with two or more edges as free along it.
void release(const Curve& curve, std::vector<Freedom>& freedom) {
  for (std::size_t k = 1; k + 1 < curve.vertices.size(); ++k) freedom[uz(curve.vertices[k])] = Freedom::kCurve;
}

}  // namespace

StratifiedMesh stratify(MedialMesh mesh, const std::vector<Edge>& fixed_edges) {
  StratifiedMesh result;
  const Strata strata = trace_strata(mesh);
  result.curve_edges = curve_edges_of(mesh, fixed_edges);
  result.sheet_of_face = strata.sheet_of_face;

  result.freedom.assign(mesh.centers.size(), Freedom::kSheet);
  for (const Edge& e : result.curve_edges)
    for (const Index v : e) result.freedom[uz(v)] = Freedom::kFixed;
  for (const auto* curves : {&strata.seams, &strata.boundaries, &strata.curves})
    for (const Curve& c : *curves) release(c, result.freedom);
  for (const Edge& e : fixed_edges)
    for (const Index v : e) result.freedom[uz(v)] = Freedom::kFixed;

  std::vector<std::vector<const Triangle*>> faces(mesh.centers.size());
  for (const Triangle& f : mesh.faces)
    for (const Index v : f) faces[uz(v)].push_back(&f);
  for (Index v = 0; v < count(mesh.centers); ++v) {
    Freedom& freedom = result.freedom[uz(v)];
    const SphereType type = mesh.types[uz(v)];
    Star star(v, faces[uz(v)], result.curve_edges);
    if (type == SphereType::kSharpEdge || type == SphereType::kCorner || type == SphereType::kJunction ||
        (freedom == Freedom::kSheet && star.fans() != 1) || (freedom == Freedom::kCurve && !star.half_disks()))
      freedom = Freedom::kFixed;
  }
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace matstruct
