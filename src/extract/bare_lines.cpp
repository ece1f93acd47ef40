#include "extract/bare_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <matstruct/strata.h>

#include "base/index.h"
#include "base/tolerances.h"

namespace matstruct {

namespace {

// The sphere stands up to this share of the stretch's length off it, or half as far, and so on.
constexpr double kFarthest = 0.25;
constexpr int kTrials = 6;

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
    if (ball && is_medial(finder, *ball, touch)) return ball;
  }
  return {};
}

}  // namespace

Index cover_bare_lines(FinderPool& finders, double longest, std::vector<TangentSphere>& medial,
                       std::vector<Index>& spheres, MedialMesh& mesh) {
  Index covered = 0;
  finders.with_one([&](ContactFinder& finder) {
    for (const Curve& curve : trace_strata(mesh).curves) {
      const std::vector<Index>& stretch = curve.vertices;
      const double length = length_of(mesh, curve);
      const bool on_line = std::all_of(stretch.begin(), stretch.end(), [&](Index v) { return mesh.radii[uz(v)] == 0; });
      // Faces from one sphere to all of a closed line would fill a loop of the mesh.
      if (!on_line || curve.closed() || length > longest) continue;
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
