#include "extract/dual.h"

#include <algorithm>
#include <numeric>

#include "base/index.h"

namespace matstruct {

namespace {

template <class T>
void sort_unique(std::vector<T>& v) {
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

}  // namespace

DualComplex dual_complex(const Rpd& rpd) {
  DualComplex dual;
  for (const RpdCell& c : rpd.cells) dual.vertices.push_back(c.sphere);
  sort_unique(dual.vertices);
  for (const RpdFacet& f : rpd.facets) dual.edges.push_back(f.spheres);
  sort_unique(dual.edges);
  for (const RpdVertex& v : rpd.vertices) dual.tets.push_back(v.spheres);
  sort_unique(dual.tets);

  // A stable order of the segments makes the sums of their lengths reproducible.
  std::vector<Index> order(rpd.edges.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return rpd.edges[uz(a)].spheres < rpd.edges[uz(b)].spheres; });
  for (const Index e : order) {
    const RpdEdge& segment = rpd.edges[uz(e)];
    if (dual.triangles.empty() || dual.triangles.back() != segment.spheres) {
      dual.triangles.push_back(segment.spheres);
      dual.lengths.push_back(0);
    }
    dual.lengths.back() += segment.length;
  }
  return dual;
}

}  // namespace matstruct
