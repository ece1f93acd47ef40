// Medial meshes made finer without changing their spheres as a set: every edge is halved, every face cut in four.
#pragma once

#include <algorithm>
#include <map>
#include <set>

#include <matstruct/types.h>

#include "base/index.h"

namespace matstruct {

/// One round. The middle of an edge is of the type of the edge: on a sharp line if it has one face and both its ends
/// have radius 0, on a seam if it has at least three faces, else on a sheet.
inline MedialMesh refined_once(const MedialMesh& mesh) {
  MedialMesh fine{mesh.centers, mesh.radii, mesh.types, {}, {}};
  std::map<Edge, int> faces;
  for (const Edge& e : mesh.edges) faces[e] = 0;
  for (const auto& [a, b, c] : mesh.faces) ++faces[{a, b}], ++faces[{a, c}], ++faces[{b, c}];
  std::map<Edge, Index> middle;
  std::set<Edge> edges;
  for (const auto& [e, n] : faces) {
    const Index a = e[0], b = e[1], m = count(fine.centers);
    middle[e] = m;
    fine.centers.push_back(lerp(mesh.centers[uz(a)], mesh.centers[uz(b)], 0.5));
    fine.radii.push_back((mesh.radii[uz(a)] + mesh.radii[uz(b)]) / 2);
    fine.types.push_back(n == 1 && fine.radii.back() == 0 ? SphereType::kSharpEdge
                         : n >= 3                         ? SphereType::kSeam
                                                          : SphereType::kSheet);
    edges.insert({{a, m}, {b, m}});
  }
  for (const auto& [a, b, c] : mesh.faces) {
    const Index ab = middle[{a, b}], ac = middle[{a, c}], bc = middle[{b, c}];
    for (Triangle t : {Triangle{a, ab, ac}, {b, ab, bc}, {c, ac, bc}, {ab, ac, bc}}) {
      std::sort(t.begin(), t.end());
      fine.faces.push_back(t);
      edges.insert({{t[0], t[1]}, {t[0], t[2]}, {t[1], t[2]}});
    }
  }
  std::sort(fine.faces.begin(), fine.faces.end());
  fine.edges.assign(edges.begin(), edges.end());
  return fine;
}

inline MedialMesh refined(MedialMesh mesh, int rounds) {
  for (int k = 0; k < rounds; ++k) mesh = refined_once(mesh);
  return mesh;
}

}  // namespace matstruct
