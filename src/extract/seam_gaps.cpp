#include "extract/seam_gaps.h"

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

/// The neighbours of a vertex on a seam to which only one face leads.
std::vector<Index> ends_of_sheets(const MedialMesh& mesh, const Incidence& around, Index v) {
  std::map<Index, int> faces_at;
  for (const Index f : around.of(v))
    for (const Index w : mesh.faces[uz(f)])
      if (w != v) ++faces_at[w];
  const bool on_seam =
      std::any_of(faces_at.begin(), faces_at.end(), [](const auto& entry) { return entry.second > 2; });
  std::vector<Index> ends;
  if (!on_seam) return ends;
  for (const auto& [w, faces] : faces_at)
    if (faces == 1) ends.push_back(w);
  return ends;
}

Triangle ascending(Index a, Index b, Index c) {
  Triangle t{a, b, c};
  std::sort(t.begin(), t.end());
  return t;
}

}  // namespace

Index fill_seam_gaps(FinderPool& finders, const std::vector<TangentSphere>& medial, const std::vector<Index>& spheres,
                     MedialMesh& mesh) {
  const Incidence around(mesh.centers.size(), mesh.faces);
  std::set<Edge> new_edges;
  std::vector<Triangle> new_faces;
  finders.with_one([&](ContactFinder& finder) {
    const auto sphere = [&](Index v) { return &medial[uz(spheres[uz(v)])]; };
    for (Index v = 0; v < count(mesh.centers); ++v) {
      const std::vector<Index> ends = ends_of_sheets(mesh, around, v);
      struct Gap {
        double width;
        Edge edge;
      };
      std::optional<Gap> least;
      for (std::size_t j = 1; j < ends.size(); ++j)
        for (std::size_t i = 0; i < j; ++i) {
          const Edge edge{ends[i], ends[j]};
          const double width = distance(mesh.centers[uz(edge[0])], mesh.centers[uz(edge[1])]);
          if ((least && width >= least->width) || new_edges.contains(edge) ||
              std::binary_search(mesh.edges.begin(), mesh.edges.end(), edge))
            continue;
          const std::array<const TangentSphere*, 3> corners{sphere(v), sphere(edge[0]), sphere(edge[1])};
          if (common_stratum(finder, corners, tolerance::kInSheet * width) >= 2) least = Gap{width, edge};
        }
      if (!least) continue;
      new_edges.insert(least->edge);
      new_faces.push_back(ascending(v, least->edge[0], least->edge[1]));
    }
  });
  mesh.edges.insert(mesh.edges.end(), new_edges.begin(), new_edges.end());
  std::sort(mesh.edges.begin(), mesh.edges.end());
  mesh.faces.insert(mesh.faces.end(), new_faces.begin(), new_faces.end());
  std::sort(mesh.faces.begin(), mesh.faces.end());
  return count(new_faces);
}

}  // namespace matstruct
