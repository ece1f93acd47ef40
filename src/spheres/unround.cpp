#include "spheres/unround.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "base/index.h"
#include "base/parallel.h"
#include "base/tolerances.h"
#include "geometry/primitives.h"

namespace matstruct {

namespace {

// Contacts whose planes are nearer to each other than this (singular values, relative) leave a sphere free that way.
constexpr double kFree = 1e-3;

constexpr Index kGrain = 64;

// How far rounding has moved the surface at a point of a triangle, times -1.
Vec3 displacement(const Domain& domain, Index triangle, const Vec3& p) {
  const Triangle& t = domain.surface.triangles[uz(triangle)];
  const auto rounded = [&](std::size_t k) -> const Vec3& { return domain.surface.vertices[uz(t[k])]; };
  const std::array<double, 3> weights = closest_on_triangle(p, rounded(0), rounded(1), rounded(2)).weights;
  Vec3 result;
  for (std::size_t k = 0; k < 3; ++k) result += (domain.unrounded[uz(t[k])] - rounded(k)) * weights[k];
  return result;
}

// The change of centre and radius that makes the ball tangent to first order, the least one if there are several.
Eigen::Vector4d step_of(const Domain& domain, const VertexContacts& contacts, Index v, const Vec3& center,
                        double radius) {
  const double touch = tolerance::kTouch * domain.diagonal;
  const Index begin = contacts.start[uz(v)], rows = contacts.of(v);
  Eigen::MatrixXd planes(rows, 4);
  Eigen::VectorXd moved(rows);
  for (Index k = 0; k < rows; ++k) {
    const Vec3& foot = contacts.points[uz(begin + k)];
    const double gap = distance(foot, center) - radius;
    const Vec3 normal = normalized(foot - center);
    planes.row(k) << normal.x, normal.y, normal.z, 1;
    // Faces are bent by rounding, which the search for a tangent sphere does not follow to the end.
    moved[k] =
        dot(normal, displacement(domain, contacts.triangles[uz(begin + k)], foot)) + (std::abs(gap) < touch ? gap : 0);
  }
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(planes, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(kFree);
  return svd.solve(moved);
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

void unround(const Domain& domain, const SurfaceQuery& surface, const Context& context, VertexContacts& contacts,
             MedialMesh& mesh) {
  if (domain.frame.grid == 0) return;
  const auto error = [&](const Vec3& center, double radius) {
    return std::abs(radius - std::sqrt(surface.closest(center).distance2));
  };
  parallel_for(context, count(mesh.centers), kGrain, [&](Index first, Index last) {
    for (Index v = first; v < last; ++v) {
      Vec3& center = mesh.centers[uz(v)];
      double& radius = mesh.radii[uz(v)];
      const Index begin = contacts.start[uz(v)];
      if (contacts.of(v) == 0) continue;
      if (radius == 0) {
        center += displacement(domain, contacts.triangles[uz(begin)], contacts.points[uz(begin)]);
      } else {
        const Eigen::Vector4d step = step_of(domain, contacts, v, center, radius);
        // Contacts that are nearly opposite or many may ask for more than first order can give.
        const Vec3 moved_center = center + Vec3{step[0], step[1], step[2]};
        const double moved_radius = radius + step[3];
        if (moved_radius > 0 && error(moved_center, moved_radius) < error(center, radius)) {
          center = moved_center;
          radius = moved_radius;
        }
      }
      follow(surface, center, begin, contacts.of(v), contacts);
    }
  });
}

}  // namespace matstruct
