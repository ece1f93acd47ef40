#include "extract/sheet_gaps.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "base/incidence.h"
#include "base/index.h"
#include "base/tolerances.h"

namespace matstruct {

namespace {

/// Neighbours of a vertex that a face might join.
struct Ends {
  bool on_seam = false;
  std::vector<Index> of_sheets;  ///< only one face leads there
  std::vector<Index> bare;       ///< none does
};

Ends ends_at(const MedialMesh& mesh, const Incidence& faces, const Incidence& edges, Index v) {
  std::map<Index, int> faces_at;
  for (const Index e : edges.of(v)) faces_at[mesh.edges[uz(e)][0] + mesh.edges[uz(e)][1] - v] = 0;
  for (const Index f : faces.of(v))
    for (const Index w : mesh.faces[uz(f)])
      if (w != v) ++faces_at[w];
  Ends ends;
  for (const auto& [w, n] : faces_at) {
    if (n > 2) ends.on_seam = true;
    if (n == 1) ends.of_sheets.push_back(w);
    if (n == 0) ends.bare.push_back(w);
  }
  return ends;
}

std::vector<Edge> gaps_at(const Ends& ends) {
  std::vector<Edge> gaps;
  if (ends.on_seam)
    for (std::size_t j = 1; j < ends.of_sheets.size(); ++j)
      for (std::size_t i = 0; i < j; ++i) gaps.push_back({ends.of_sheets[i], ends.of_sheets[j]});
  for (const Index w : ends.bare)
    for (const Index end : ends.of_sheets) gaps.push_back(ordered_edge(w, end));
  return gaps;
}

Triangle ascending(Index a, Index b, Index c) {
  Triangle t{a, b, c};
  std::sort(t.begin(), t.end());
  return t;
}

// As fill_sheet_gaps(), one face at most at each vertex and edge.
Index fill_once(FinderPool& finders, const std::vector<TangentSphere>& medial, const std::vector<Index>& spheres,
                double deviation, MedialMesh& mesh) {
  const Incidence faces(mesh.centers.size(), mesh.faces), edges(mesh.centers.size(), mesh.edges);
  std::set<Edge> new_edges, taken;  // taken: of new faces
  std::vector<Triangle> new_faces;
  finders.with_one([&](ContactFinder& finder) {
    const auto sphere = [&](Index v) { return &medial[uz(spheres[uz(v)])]; };
    for (Index v = 0; v < count(mesh.centers); ++v) {
      struct Gap {
        double width;
        Edge edge;
      };
      std::optional<Gap> least;
      for (const Edge& edge : gaps_at(ends_at(mesh, faces, edges, v))) {
        const double width = distance(mesh.centers[uz(edge[0])], mesh.centers[uz(edge[1])]);
        if ((least && width >= least->width) || taken.contains(edge) || taken.contains(ordered_edge(v, edge[0])) ||
            taken.contains(ordered_edge(v, edge[1])) || std::binary_search(mesh.edges.begin(), mesh.edges.end(), edge))
          continue;
        const std::array<const TangentSphere*, 3> corners{sphere(v), sphere(edge[0]), sphere(edge[1])};
        if (common_stratum(finder, corners, std::max(deviation, tolerance::kInSheet * width)) >= 2)
          least = Gap{width, edge};
      }
      if (!least) continue;
      new_edges.insert(least->edge);
      taken.insert({least->edge, ordered_edge(v, least->edge[0]), ordered_edge(v, least->edge[1])});
      new_faces.push_back(ascending(v, least->edge[0], least->edge[1]));
    }
  });
  mesh.edges.insert(mesh.edges.end(), new_edges.begin(), new_edges.end());
  std::sort(mesh.edges.begin(), mesh.edges.end());
  mesh.faces.insert(mesh.faces.end(), new_faces.begin(), new_faces.end());
  std::sort(mesh.faces.begin(), mesh.faces.end());
  return count(new_faces);
}

}  // namespace

Index fill_sheet_gaps(FinderPool& finders, const std::vector<TangentSphere>& medial, const std::vector<Index>& spheres,
                      double deviation, MedialMesh& mesh) {
  Index filled = 0;
  while (const Index faces = fill_once(finders, medial, spheres, deviation, mesh)) filled += faces;
  return filled;
}

}  // namespace matstruct
