// J.-M. Thiery, E. Guy and T. Boubekeur, "Sphere-Meshes: Shape Approximation using Spherical Quadric Error Metrics",
// 2013; freedom by singular values after MATStruct 2025, eq. 3-4.
//
// Notation: the unknown of a sphere is m = (d, s), the change of its centre and radius. A sample with foot p and normal
// n gives the row a = (n, 1) and the value b = (p - theta).n - r, and the error (a.m - b)^2. Rows have length sqrt(2)
// whatever the scale, so eigenvalues of the mean of a a^T compare between spheres.
#include "optimise/freedom.h"

#include <cmath>

#include <Eigen/Dense>

#include "base/index.h"
#include "base/parallel.h"

namespace matstruct {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

constexpr Index kGrain = 64;

/// A contact on a concave line has a fan of normals: what counts is where the sphere sees it.
Vec3 direction(const VolumeSample& sample, const Ball& sphere) {
  const Vec3 seen = normalized(sample.foot - sphere.center);
  return sample.line == kInvalid || norm2(seen) == 0 ? sample.normal : seen;
}

Vector4d row(const Vec3& n) {
  return {n.x, n.y, n.z, 1};
}

Vec3 center_part(const Vector4d& v) {
  return {v[0], v[1], v[2]};
}

/// Quadric of the samples, and of one plane per cluster.
struct Quadrics {
  Matrix4d samples = Matrix4d::Zero();  // mean of a a^T
  Vector4d values = Vector4d::Zero();   // mean of a b
  double constant = 0;                  // mean of b^2
  Matrix4d planes = Matrix4d::Zero();
  int most_rank = 0;
  Vec3 end_normal;  // of a cell with one contact that is hardly bent: where its sheet ends
};

Quadrics quadrics_of(const VolumeSamples& samples, const CellContacts& contacts, Index s, const Ball& sphere,
                     double bent) {
  Quadrics q;
  const Index begin = contacts.start[uz(s)], end = contacts.start[uz(s) + 1];
  double n_samples = 0;
  for (Index c = begin; c < end; ++c) {
    Matrix4d cluster = Matrix4d::Zero();
    Vec3 mean;
    double n = 0;
    for (Index k = contacts.member_start[uz(c)]; k < contacts.member_start[uz(c) + 1]; ++k) {
      const VolumeSample& sample = samples.samples[uz(contacts.members[uz(k)])];
      const Vec3 normal = direction(sample, sphere);
      const Vector4d a = row(normal);
      const double b = dot(sample.foot - sphere.center, normal) - sphere.radius;
      cluster += a * a.transpose();
      q.values += a * b;
      q.constant += b * b;
      mean += normal;
      n += 1;
    }
    q.samples += cluster;
    n_samples += n;
    const bool is_bent = norm(mean) < bent * n;
    if (end - begin == 1 && !is_bent) q.end_normal = normalized(mean);
    if (end - begin > 1 && !is_bent) {
      const Vector4d a = row(normalized(mean));
      q.planes += a * a.transpose();
      q.most_rank += 1;
    } else {
      q.planes += cluster / n;
      q.most_rank += 4;
    }
  }
  if (n_samples > 0) {
    q.samples /= n_samples, q.values /= n_samples, q.constant /= n_samples;
    q.planes /= static_cast<double>(end - begin);
  }
  return q;
}

/// The directions that `null`, an orthonormal basis of the null space, leaves to the centre. A null vector cannot
/// change the radius alone, so the centre parts are independent.
Projector free_directions(const Eigen::Matrix<double, 4, Eigen::Dynamic>& null) {
  if (null.cols() == 1) return along(normalized(center_part(null.col(0))));
  if (null.cols() == 2) return across(normalized(cross(center_part(null.col(0)), center_part(null.col(1)))));
  return kNoDirection;
}

/// The sphere at the end of a sheet may not leave it: nothing would push it back. Along the end it may slide.
void stay_on_end(const Vec3& normal, SphereFreedom& freedom) {
  const Vec3 outward = normalized(project(freedom.free, normal));
  const bool plane = freedom.kind == Freedom::kPlane;
  const Projector out = along(outward);
  for (std::size_t k = 0; k < 9; ++k) freedom.free[k] = plane ? freedom.free[k] - out[k] : 0;
  freedom.kind = plane ? Freedom::kLine : Freedom::kFixed;
}

/// Least SQEM over moves in the span of `range`.
void solve(const Quadrics& q, const Eigen::Matrix<double, 4, Eigen::Dynamic>& range, const Ball& sphere,
           SphereFreedom& out) {
  const Eigen::MatrixXd matrix = range.transpose() * q.samples * range;
  const Eigen::VectorXd values = range.transpose() * q.values;
  const Vector4d move = range * matrix.ldlt().solve(values);
  out.solution = {sphere.center + center_part(move), sphere.radius + move[3]};
  const double error2 = move.dot(q.samples * move) - 2 * move.dot(q.values) + q.constant;
  out.error = std::sqrt(std::max(0.0, error2));
}

SphereFreedom freedom_of(const Quadrics& q, const Ball& sphere, int most_rank, double threshold) {
  SphereFreedom result;
  result.solution = sphere;
  const Eigen::SelfAdjointEigenSolver<Matrix4d> eigen(q.planes);  // ascending
  int rank = 0;
  for (int k = 0; k < 4; ++k)
    if (eigen.eigenvalues()[k] > threshold * eigen.eigenvalues()[3]) ++rank;
  rank = std::min({rank, q.most_rank, most_rank});
  if (rank <= 1) return result;
  result.kind = rank == 2 ? Freedom::kPlane : rank == 3 ? Freedom::kLine : Freedom::kFixed;
  result.free = free_directions(eigen.eigenvectors().leftCols(4 - rank));
  if (q.end_normal != Vec3{}) stay_on_end(q.end_normal, result);
  solve(q, eigen.eigenvectors().rightCols(rank), sphere, result);
  return result;
}

}  // namespace

std::vector<SphereFreedom> sphere_freedoms(const VolumeSamples& samples, const CellContacts& contacts,
                                           std::span<const Ball> spheres, std::span<const std::int8_t> most_rank,
                                           const FreedomOptions& options, const Context& context) {
  std::vector<SphereFreedom> result(spheres.size());
  parallel_for(context, count(spheres), kGrain, [&](Index begin, Index end) {
    for (Index s = begin; s < end; ++s) {
      const Quadrics q = quadrics_of(samples, contacts, s, spheres[uz(s)], options.bent);
      result[uz(s)] = freedom_of(q, spheres[uz(s)], most_rank.empty() ? 4 : most_rank[uz(s)], options.rank);
    }
  });
  return result;
}

}  // namespace matstruct
