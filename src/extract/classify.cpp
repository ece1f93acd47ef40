#include "extract/classify.h"

#include <algorithm>
#include <array>

#include "base/index.h"
#include "base/tolerances.h"

namespace matstruct {

namespace {

constexpr Index kGrain = 128;

}  // namespace

SimplexClasses classify(FinderPool& finders, const std::vector<TangentSphere>& spheres, const DualComplex& dual,
                        const std::vector<Edge>& feature_edges, const Context& context) {
  SimplexClasses classes;
  classes.edge_contacts.assign(dual.edges.size(), 0);
  classes.face_valid.assign(dual.triangles.size(), 0);
  finders.for_each(context, count(dual.edges), kGrain, [&](ContactFinder& finder, Index e) {
    const Edge& edge = dual.edges[uz(e)];
    const std::array<const TangentSphere*, 2> ends{&spheres[uz(edge[0])], &spheres[uz(edge[1])]};
    const bool sharp = std::binary_search(feature_edges.begin(), feature_edges.end(), edge);
    const Index contacts =
        sharp ? 2 : common_stratum(finder, ends, tolerance::kInSheet * distance(ends[0]->center, ends[1]->center));
    classes.edge_contacts[uz(e)] = static_cast<std::uint8_t>(std::min<Index>(contacts, 255));
  });
  finders.for_each(context, count(dual.triangles), kGrain, [&](ContactFinder& finder, Index f) {
    const auto& [a, b, c] = dual.triangles[uz(f)];
    double longest = 0;
    for (const Edge& edge : {Edge{a, b}, Edge{a, c}, Edge{b, c}}) {
      const auto found = std::lower_bound(dual.edges.begin(), dual.edges.end(), edge) - dual.edges.begin();
      if (classes.edge_contacts[static_cast<std::size_t>(found)] == 0) return;
      longest = std::max(longest, distance(spheres[uz(edge[0])].center, spheres[uz(edge[1])].center));
    }
    const std::array<const TangentSphere*, 3> corners{&spheres[uz(a)], &spheres[uz(b)], &spheres[uz(c)]};
    classes.face_valid[uz(f)] = common_stratum(finder, corners, tolerance::kInSheet * longest) >= 2;
  });
  return classes;
}

SimplexClasses classify_smooth(FinderPool& finders, const std::vector<TangentSphere>& spheres, const DualComplex& dual,
                               const Context& context) {
  std::vector<std::uint8_t> round(spheres.size(), 0);
  finders.for_each(context, count(dual.vertices), kGrain, [&](ContactFinder& finder, Index v) {
    const TangentSphere& sphere = spheres[uz(dual.vertices[uz(v)])];
    round[uz(dual.vertices[uz(v)])] = on_medial_curve(finder, sphere);
  });
  SimplexClasses classes;
  classes.edge_contacts.assign(dual.edges.size(), 3);
  for (const auto& [a, b, c] : dual.triangles)
    classes.face_valid.push_back(!(round[uz(a)] && round[uz(b)] && round[uz(c)]));
  return classes;
}

}  // namespace matstruct
