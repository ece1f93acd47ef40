#include "extract/sheet_gaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <set>

#include "base/incidence.h"
#include "base/index.h"
#include "base/tolerances.h"

namespace matstruct {

namespace {

// A free border is a notch where the angle outside the sheet is less than this, radians.
constexpr double kNotch = 2 * std::numbers::pi / 3;

/// Neighbours of a vertex that a face might join.
struct Ends {
  Index seams = 0;               ///< edges of more than two faces
  std::vector<Index> inside;     ///< two faces lead there
  std::vector<Index> of_sheets;  ///< only one face does
  std::vector<Index> bare;       ///< none does
};

// #E: the number of faces at each edge.
std::vector<Index> face_counts(const MedialMesh& mesh) {
  std::vector<Index> counts(mesh.edges.size(), 0);
  for (const Triangle& edges : edges_of_faces(mesh.edges, mesh.faces))
    for (const Index e : edges) ++counts[uz(e)];
  return counts;
}

Ends ends_at(const MedialMesh& mesh, const Incidence& edges, const std::vector<Index>& counts, Index v) {
  Ends ends;
  for (const Index e : edges.of(v)) {
    const Index w = mesh.edges[uz(e)][0] + mesh.edges[uz(e)][1] - v, n = counts[uz(e)];
    if (n > 2) ++ends.seams;
    if (n == 2) ends.inside.push_back(w);
    if (n == 1) ends.of_sheets.push_back(w);
    if (n == 0) ends.bare.push_back(w);
  }
  return ends;
}

struct Gap {
  Edge edge;            ///< of a face with the vertex
  bool at_end = false;  ///< where a seam stops
  bool bare = false;    ///< at an edge of a sharp line
};

// Whether each vertex is on a seam and has a sheet end there, or is between two that do: where a seam that stops may go
// on.
std::vector<std::uint8_t> next_to_ends(const MedialMesh& mesh, const std::vector<Index>& counts) {
  std::vector<std::uint8_t> seam(mesh.centers.size(), 0), border = seam;
  for (std::size_t e = 0; e < counts.size(); ++e)
    for (const Index v : mesh.edges[e]) {
      if (counts[e] > 2) seam[uz(v)] = 1;
      if (counts[e] == 1) border[uz(v)] = 1;
    }
  const auto is_end = [&](Index v) { return seam[uz(v)] && border[uz(v)]; };
  std::vector<Index> ends(mesh.centers.size(), 0);  // among the neighbours
  for (const auto& [a, b] : mesh.edges) {
    ends[uz(a)] += is_end(b);
    ends[uz(b)] += is_end(a);
  }
  std::vector<std::uint8_t> result;
  for (Index v = 0; v < count(ends); ++v) result.push_back(is_end(v) || ends[uz(v)] > 1);
  return result;
}

std::vector<Gap> gaps_at(const MedialMesh& mesh, const Ends& ends, const std::vector<std::uint8_t>& goes_on, Index v) {
  std::vector<Gap> gaps;
  const auto join_all = [&](const std::vector<Index>& borders) {
    for (std::size_t j = 1; j < borders.size(); ++j)
      for (std::size_t i = 0; i < j; ++i) gaps.push_back({ordered_edge(borders[i], borders[j])});
  };
  if (ends.seams > 0) {
    join_all(ends.of_sheets);
  } else if (mesh.types[uz(v)] == SphereType::kSharpEdge) {
    std::vector<Index> inner;  // edges into the solid: the others run along the line
    for (const Index w : ends.of_sheets)
      if (mesh.radii[uz(w)] > 0) inner.push_back(w);
    join_all(inner);
  }
  for (const Index w : ends.bare)
    for (const Index end : ends.of_sheets)
      gaps.push_back({ordered_edge(w, end), false, mesh.radii[uz(v)] == 0 && mesh.radii[uz(w)] == 0});
  if (ends.seams == 1 && ends.of_sheets.size() == 1)
    for (const Index w : ends.inside)
      if (goes_on[uz(w)]) gaps.push_back({ordered_edge(w, ends.of_sheets[0]), true});
  return gaps;
}

// The ends of a free border beside the vertex, if it makes a notch there.
std::optional<Edge> notch_at(const MedialMesh& mesh, const Incidence& faces, const Ends& ends, Index v) {
  if (mesh.radii[uz(v)] == 0 || ends.seams > 0 || !ends.bare.empty() || ends.of_sheets.size() != 2) return {};
  const Vec3& center = mesh.centers[uz(v)];
  double outside = 2 * std::numbers::pi;
  for (const Index f : faces.of(v)) {
    const Triangle& t = mesh.faces[uz(f)];
    const std::size_t k = static_cast<std::size_t>(std::find(t.begin(), t.end(), v) - t.begin());
    outside -= angle_between(mesh.centers[uz(t[(k + 1) % 3])] - center, mesh.centers[uz(t[(k + 2) % 3])] - center);
  }
  if (outside <= 0 || outside >= kNotch) return {};
  return ordered_edge(ends.of_sheets[0], ends.of_sheets[1]);
}

// Three spheres on sharp lines span a piece of the surface, not of a sheet.
bool on_surface(const MedialMesh& mesh, const Edge& edge, Index v) {
  return mesh.radii[uz(v)] == 0 && mesh.radii[uz(edge[0])] == 0 && mesh.radii[uz(edge[1])] == 0;
}

// How far a face is off the axis in its middle: the radius there against the distance to the surface. Near the end of a
// line, where contacts run together, it tells what they do not.
double deviation_of(const Domain& domain, const std::array<const TangentSphere*, 3>& corners) {
  Vec3 middle;
  double radius = 0;
  for (const TangentSphere* c : corners) middle += c->center / 3, radius += c->radius / 3;
  return std::abs(std::sqrt(domain.query.closest(middle).distance2) - radius);
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
  const std::vector<Index> counts = face_counts(mesh);
  const std::vector<std::uint8_t> goes_on = next_to_ends(mesh, counts);
  std::set<Edge> new_edges, taken;  // taken: of new faces
  std::vector<Triangle> new_faces;
  finders.with_one([&](ContactFinder& finder) {
    const auto sphere = [&](Index v) { return &medial[uz(spheres[uz(v)])]; };
    for (Index v = 0; v < count(mesh.centers); ++v) {
      std::optional<Edge> narrowest;
      double least = std::numeric_limits<double>::infinity();
      const Ends ends = ends_at(mesh, edges, counts, v);
      std::vector<Gap> gaps = gaps_at(mesh, ends, goes_on, v);
      if (const auto notch = notch_at(mesh, faces, ends, v)) gaps.push_back({*notch});
      for (const auto& [edge, at_end, bare] : gaps) {
        const double width = distance(mesh.centers[uz(edge[0])], mesh.centers[uz(edge[1])]);
        if (width >= least || on_surface(mesh, edge, v) || taken.contains(edge) ||
            taken.contains(ordered_edge(v, edge[0])) || taken.contains(ordered_edge(v, edge[1])) ||
            std::binary_search(mesh.edges.begin(), mesh.edges.end(), edge))
          continue;
        const std::array<const TangentSphere*, 3> corners{sphere(v), sphere(edge[0]), sphere(edge[1])};
        const double depth = std::max(at_end ? 0 : deviation, tolerance::kInSheet * width);
        if (common_stratum(finder, corners, depth) < 2 &&
            !(bare && deviation_of(finders.domain(), corners) <= deviation))
          continue;
        narrowest = edge;
        least = width;
      }
      if (!narrowest) continue;
      const auto [a, b] = *narrowest;
      new_edges.insert(*narrowest);
      taken.insert({*narrowest, ordered_edge(v, a), ordered_edge(v, b)});
      new_faces.push_back(ascending(v, a, b));
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
