#include "spheres/unround.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "base/index.h"
#include "base/tolerances.h"

namespace matstruct {

namespace {

// Contacts whose planes are nearer to each other than this (singular values, relative) leave a sphere free that way.
constexpr double kFree = 1e-3;

// How far rounding has moved the surface at a point of a triangle, times -1.
Vec3 displacement(const Domain& domain, Index triangle, const Vec3& p) {
  const Triangle& t = domain.surface.triangles[uz(triangle)];
  const auto at = [&](std::size_t k) -> const Vec3& { return domain.surface.vertices[uz(t[k])]; };
  const auto back = [&](std::size_t k) { return domain.unrounded[uz(t[k])] - at(k); };
  for (std::size_t k = 0; k < 3; ++k)
    if (p == at(k)) return back(k);
  const Vec3 normal = cross(at(1) - at(0), at(2) - at(0));
  const double area2 = norm2(normal);
  if (area2 == 0) return back(0);
  const double v = dot(cross(p - at(0), at(2) - at(0)), normal) / area2;
  const double w = dot(cross(at(1) - at(0), p - at(0)), normal) / area2;
  return back(0) * (1 - v - w) + back(1) * v + back(2) * w;
}

// Contacts go to the points of their triangles that are nearest to the centre, nearest first.
void follow(const SurfaceQuery& surface, const Vec3& center, Index begin, Index rows, VertexContacts& contacts) {
  std::vector<std::pair<Index, SurfaceHit>> found;
  for (Index k = begin; k < begin + rows; ++k)
    found.emplace_back(contacts.triangles[uz(k)], surface.closest_on(contacts.triangles[uz(k)], center));
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.second.distance2 < b.second.distance2; });
  for (Index k = 0; k < rows; ++k) {
    contacts.triangles[uz(begin + k)] = found[uz(k)].first;
    contacts.points[uz(begin + k)] = found[uz(k)].second.point;
  }
}

}  // namespace

void unround(const Domain& domain, const SurfaceQuery& surface, VertexContacts& contacts, MedialMesh& mesh) {
  if (domain.frame.grid == 0) return;
  const double touch = tolerance::kTouch * domain.diagonal;
  const auto error = [&](const Vec3& center, double radius) {
    return std::abs(radius - std::sqrt(surface.closest(center).distance2));
  };
  for (Index v = 0; v < count(mesh.centers); ++v) {
    Vec3& center = mesh.centers[uz(v)];
    double& radius = mesh.radii[uz(v)];
    const Index begin = contacts.start[uz(v)], rows = contacts.of(v);
    Eigen::MatrixXd planes(rows, 4);
    Eigen::VectorXd moved(rows);
    for (Index k = 0; k < rows; ++k) {
      const Vec3& foot = contacts.points[uz(begin + k)];
      const Vec3 back = displacement(domain, contacts.triangles[uz(begin + k)], foot);
      const double gap = distance(foot, center) - radius;
      const Vec3 normal = normalized(foot - center);
      planes.row(k) << normal.x, normal.y, normal.z, 1;
      // Faces are bent by rounding, which the search for a tangent sphere does not follow to the end.
      moved[k] = dot(normal, back) + (std::abs(gap) < touch ? gap : 0);
    }
    if (rows == 0) continue;
    if (radius == 0) {
      center += displacement(domain, contacts.triangles[uz(begin)], contacts.points[uz(begin)]);
      follow(surface, center, begin, rows, contacts);
      continue;
    }
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(planes, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(kFree);
    const Eigen::Vector4d step = svd.solve(moved);
    // Contacts that are nearly opposite or many may ask for more than first order can give.
    const Vec3 moved_center = center + Vec3{step[0], step[1], step[2]};
    const double moved_radius = radius + step[3];
    if (moved_radius > 0 && error(moved_center, moved_radius) < error(center, radius)) {
      center = moved_center;
      radius = moved_radius;
    }
    follow(surface, center, begin, rows, contacts);
  }
}

}  // namespace matstruct
