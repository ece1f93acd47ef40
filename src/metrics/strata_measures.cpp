// Measures of the strata: edge lengths, numbers.
#include <algorithm>
#include <cmath>

#include <matstruct/metrics.h>
#include <matstruct/strata.h>

#include "base/incidence.h"
#include "base/index.h"

namespace matstruct {

namespace {

EdgeLengths statistics(const std::vector<double>& lengths) {
  if (lengths.empty()) return {};
  EdgeLengths result;
  result.edges = count(lengths);
  const auto [least, greatest] = std::minmax_element(lengths.begin(), lengths.end());
  result.min = *least;
  result.max = *greatest;
  for (const double length : lengths) result.mean += length / result.edges;
  double variance = 0;
  for (const double length : lengths) variance += (length - result.mean) * (length - result.mean) / result.edges;
  result.variation = result.mean > 0 ? std::sqrt(variance) / result.mean : 0;
  return result;
}

/// Number of faces of each edge.
std::vector<Index> face_counts(const MedialMesh& mesh) {
  std::vector<Index> faces(mesh.edges.size(), 0);
  for (const Triangle& edges : edges_of_faces(mesh.edges, mesh.faces))
    for (const Index e : edges) ++faces[uz(e)];
  return faces;
}

Index closed(const std::vector<Curve>& curves) {
  return static_cast<Index>(std::count_if(curves.begin(), curves.end(), [](const Curve& c) { return c.closed(); }));
}

}  // namespace

Spacing spacing(const MedialMesh& mesh) {
  const std::vector<Index> faces = face_counts(mesh);
  std::vector<double> sheets, seams, boundaries, curves;
  for (std::size_t e = 0; e < faces.size(); ++e) {
    std::vector<double>& kind = faces[e] == 2 ? sheets : faces[e] > 2 ? seams : faces[e] == 1 ? boundaries : curves;
    kind.push_back(distance(mesh.centers[uz(mesh.edges[e][0])], mesh.centers[uz(mesh.edges[e][1])]));
  }
  return {statistics(sheets), statistics(seams), statistics(boundaries), statistics(curves)};
}

StructureCounts structure_counts(const MedialMesh& mesh) {
  const Strata strata = trace_strata(mesh);
  std::vector<char> corner(mesh.centers.size(), 0);
  for (const Curve& seam : strata.seams)
    for (const Index end : {seam.vertices.front(), seam.vertices.back()})
      if (mesh.radii[uz(end)] == 0) corner[uz(end)] = 1;
  StructureCounts result;
  result.sheets = strata.sheets;
  result.seams = count(strata.seams);
  result.closed_seams = closed(strata.seams);
  result.boundaries = count(strata.boundaries);
  result.closed_boundaries = closed(strata.boundaries);
  result.curves = count(strata.curves);
  result.closed_curves = closed(strata.curves);
  result.corners = static_cast<Index>(std::count(corner.begin(), corner.end(), 1));
  result.junctions = static_cast<Index>(
      std::count_if(strata.junctions.begin(), strata.junctions.end(), [&](Index v) { return corner[uz(v)] == 0; }));
  return result;
}

}  // namespace matstruct
