#include "extract/bare_lines.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "base/incidence.h"
#include "base/index.h"
#include "base/tolerances.h"

namespace matstruct {

namespace {

// The sphere stands up to this share of the stretch's length off it, or half as far, and so on.
constexpr double kFarthest = 0.25;
constexpr int kTrials = 6;

// Stretches of edges of no face between spheres of sharp lines, each from one end to the other; they end at corners,
// and where a face begins.
std::vector<std::vector<Index>> bare_stretches(const MedialMesh& mesh) {
  std::vector<std::uint8_t> bare(mesh.edges.size(), 1);
  for (const Triangle& edges : edges_of_faces(mesh.edges, mesh.faces))
    for (const Index e : edges) bare[uz(e)] = 0;
  for (std::size_t e = 0; e < bare.size(); ++e)
    for (const Index v : mesh.edges[e])
      if (mesh.radii[uz(v)] > 0) bare[e] = 0;
  const Incidence edges(mesh.centers.size(), mesh.edges);
  const auto goes_on = [&](Index v) {
    const auto at = edges.of(v);
    return mesh.types[uz(v)] == SphereType::kSharpEdge && at.size() == 2 && bare[uz(at[0])] && bare[uz(at[1])];
  };
  std::vector<std::vector<Index>> stretches;
  std::vector<std::uint8_t> seen(mesh.edges.size(), 0);
  for (Index start = 0; start < count(mesh.centers); ++start)
    for (const Index first : edges.of(start)) {
      if (!bare[uz(first)] || seen[uz(first)] || goes_on(start)) continue;
      std::vector<Index> stretch{start};
      for (Index e = first;;) {
        seen[uz(e)] = 1;
        const Index next = mesh.edges[uz(e)][0] + mesh.edges[uz(e)][1] - stretch.back();
        stretch.push_back(next);
        if (!goes_on(next)) break;
        e = edges.of(next)[0] == e ? edges.of(next)[1] : edges.of(next)[0];
      }
      stretches.push_back(std::move(stretch));
    }
  return stretches;
}

double length_of(const MedialMesh& mesh, const std::vector<Index>& stretch) {
  double length = 0;
  for (std::size_t k = 1; k < stretch.size(); ++k)
    length += distance(mesh.centers[uz(stretch[k - 1])], mesh.centers[uz(stretch[k])]);
  return length;
}

// A sphere in the middle of a stretch or, of a single edge, the middle of that.
Vec3 middle_of(const MedialMesh& mesh, const std::vector<Index>& stretch) {
  const Vec3 &a = mesh.centers[uz(stretch[(stretch.size() - 1) / 2])],
             &b = mesh.centers[uz(stretch[stretch.size() / 2])];
  return stretch.size() % 2 == 1 ? a : lerp(a, b, 0.5);
}

// The empty sphere tangent to both sides of a line beside one of its points.
std::optional<TangentSphere> beside_line(ContactFinder& finder, const Vec3& place, double farthest) {
  const Domain& domain = finder.domain();
  const double touch = tolerance::kSameDistance * domain.diagonal;
  const Contacts sides = finder.find(place, std::sqrt(domain.query.closest(place).distance2), touch);
  if (sides.size() != 2) return {};
  const Vec3 inward =
      -normalized(domain.triangle_normals[uz(sides[0].triangle)] + domain.triangle_normals[uz(sides[1].triangle)]);
  for (int k = 0; k < kTrials; ++k, farthest /= 2) {
    auto ball = tangent_sphere(finder, place + inward * farthest, sides, farthest);
    if (ball && inside(finder, *ball) && !intruder(finder, *ball, touch)) return ball;
  }
  return {};
}

}  // namespace

Index cover_bare_lines(FinderPool& finders, double longest, std::vector<TangentSphere>& medial,
                       std::vector<Index>& spheres, MedialMesh& mesh) {
  Index covered = 0;
  finders.with_one([&](ContactFinder& finder) {
    for (const std::vector<Index>& stretch : bare_stretches(mesh)) {
      const double length = length_of(mesh, stretch);
      if (length > longest) continue;
      auto ball = beside_line(finder, middle_of(mesh, stretch), kFarthest * length);
      if (!ball) continue;
      const Index v = count(mesh.centers);
      mesh.centers.push_back(ball->center);
      mesh.radii.push_back(ball->radius);
      mesh.types.push_back(SphereType::kSheet);
      for (std::size_t k = 0; k < stretch.size(); ++k) {
        mesh.edges.push_back({stretch[k], v});
        if (k == 0) continue;
        const Edge edge = ordered_edge(stretch[k - 1], stretch[k]);
        mesh.faces.push_back({edge[0], edge[1], v});
      }
      spheres.push_back(count(medial));
      medial.push_back(*std::move(ball));
      ++covered;
    }
  });
  std::sort(mesh.edges.begin(), mesh.edges.end());
  std::sort(mesh.faces.begin(), mesh.faces.end());
  return covered;
}

}  // namespace matstruct
