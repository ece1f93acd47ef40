#include "spheres/tangency.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "base/index.h"
#include "base/tolerances.h"

namespace matstruct {

namespace {

// Caps far above what is needed: planes take two steps, curved walls about five.
constexpr int kMaxSteps = 40;
constexpr int kMaxHalvings = 6;
constexpr int kMaxIntruders = 40;
// Directions along which the contacts' distances change by less than this, relative to the fastest, are free. Squared:
// of eigenvalues.
constexpr double kFree = 1e-10;
// Cosine of the angle (5 degrees) up to which two directions are not clearly different.
constexpr double kSameDirection = 0.9962;
// A contact direction belongs to a face of the hull if it is nearer to its plane than this.
constexpr double kCoplanar = 1e-6;

Eigen::Vector3d eigen(const Vec3& v) {
  return {v.x, v.y, v.z};
}

// Least motion after which all contacts are equally far, to first order: with n_k the direction to contact k at
// distance d_k, (n_k - n_0) . x = d_k - d_0.
Vec3 least_motion(const Domain& domain, const Vec3& center, const Contacts& contacts) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const Vec3 first = direction(domain, center, contacts[0]);
  for (std::size_t k = 1; k < contacts.size(); ++k) {
    const Eigen::Vector3d row = eigen(direction(domain, center, contacts[k]) - first);
    normal += row * row.transpose();
    right += row * (contacts[k].distance - contacts[0].distance);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normal);
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const double value = solver.eigenvalues()[k];
    if (value > kFree * solver.eigenvalues()[2])
      x += solver.eigenvectors().col(k) * (solver.eigenvectors().col(k).dot(right) / value);
  }
  return {x[0], x[1], x[2]};
}

double gap_of(const Contacts& contacts) {
  const auto [least, greatest] = std::minmax_element(
      contacts.begin(), contacts.end(), [](const Contact& a, const Contact& b) { return a.distance < b.distance; });
  return greatest->distance - least->distance;
}

bool distinct(const ContactFinder& finder, const Contacts& contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (finder.same(contacts[i], contacts[j])) return false;
  return true;
}

}  // namespace

std::optional<TangentSphere> tangent_sphere(ContactFinder& finder, const Vec3& guess, const Contacts& contacts,
                                            double reach) {
  const auto at = [&](const Vec3& center, const Contacts& from) {
    TangentSphere sphere{center, 0, from};
    for (Contact& c : sphere.contacts) c = finder.follow(c, center);
    return sphere;
  };
  TangentSphere sphere = at(guess, contacts);
  double gap = gap_of(sphere.contacts);
  for (int step = 0; step < kMaxSteps && gap > tolerance::kTangent * finder.domain().diagonal; ++step) {
    if (!distinct(finder, sphere.contacts)) return {};
    Vec3 motion = least_motion(finder.domain(), sphere.center, sphere.contacts);
    // Over a kink between facets a whole step may be too long.
    TangentSphere next;
    double next_gap = gap;
    for (int halving = 0; halving < kMaxHalvings && next_gap >= gap; ++halving, motion *= 0.5) {
      next = at(sphere.center + motion, sphere.contacts);
      next_gap = gap_of(next.contacts);
    }
    if (distance(next.center, guess) > reach) return {};
    if (next_gap >= gap) break;
    sphere = std::move(next);
    gap = next_gap;
  }
  // More contacts than a sphere has freedom agree to the precision of the input only.
  if (gap > tolerance::kSameDistance * finder.domain().diagonal || !distinct(finder, sphere.contacts)) return {};
  for (const Contact& c : sphere.contacts) sphere.radius += c.distance / static_cast<double>(contacts.size());
  return sphere;
}

bool inside(const ContactFinder& finder, const TangentSphere& sphere) {
  return finder.domain().query.signed_distance(sphere.center, sphere.contacts[0].triangle) < 0;
}

std::optional<Contact> intruder(ContactFinder& finder, const TangentSphere& sphere, double depth) {
  const SurfaceHit hit = finder.domain().query.closest_near(sphere.center, sphere.contacts[0].triangle);
  const double distance = std::sqrt(hit.distance2);
  if (distance >= sphere.radius - depth) return {};
  return finder.follow({hit.point, hit.triangle, distance}, sphere.center);
}

bool is_medial(ContactFinder& finder, const TangentSphere& sphere, double depth) {
  return inside(finder, sphere) && !intruder(finder, sphere, depth);
}

Index clear_contacts(const Domain& domain, const TangentSphere& sphere) {
  std::vector<Vec3> clear;
  for (const Contact& contact : sphere.contacts) {
    const Vec3 way = direction(domain, sphere.center, contact);
    if (std::none_of(clear.begin(), clear.end(), [&](const Vec3& other) { return dot(other, way) > kSameDirection; }))
      clear.push_back(way);
  }
  return count(clear);
}

bool is_faint(const Domain& domain, const TangentSphere& sphere, double angle) {
  if (sphere.contacts.empty()) return true;
  const Vec3 first = direction(domain, sphere.center, sphere.contacts[0]);
  return std::all_of(sphere.contacts.begin(), sphere.contacts.end(), [&](const Contact& contact) {
    return dot(first, direction(domain, sphere.center, contact)) > std::cos(angle);
  });
}

double radius_to_surface(const Domain& domain, const TangentSphere& sphere) {
  if (sphere.contacts.empty()) return sphere.radius;
  const SurfaceHit hit = domain.query.closest_near(sphere.center, sphere.contacts[0].triangle);
  return std::min(sphere.radius, std::sqrt(hit.distance2));
}

std::optional<TangentSphere> shrunk_to_next_contact(ContactFinder& finder, const TangentSphere& sphere, double depth,
                                                    double reach) {
  TangentSphere ball = sphere;
  const std::size_t kept = sphere.contacts.size();
  for (int step = 0; step < kMaxIntruders; ++step) {
    const std::optional<Contact> next = intruder(finder, ball, depth);
    if (!next) return step > 0 && inside(finder, ball) ? std::optional(ball) : std::nullopt;
    Contacts contacts(ball.contacts.begin(), ball.contacts.begin() + static_cast<std::ptrdiff_t>(kept));
    contacts.push_back(*next);
    const auto smaller = tangent_sphere(finder, ball.center, contacts, reach);
    if (!smaller) return {};
    ball = *smaller;
  }
  return {};
}

std::vector<SeamDirection> seam_directions(const std::vector<Vec3>& n) {
  std::vector<SeamDirection> result;
  const auto offer = [&](const Vec3& u, double height) {
    SeamDirection face{u, {}};
    for (Index m = 0; m < count(n); ++m) {
      const double above = dot(n[uz(m)], u) - height;
      if (above > kCoplanar) return;
      if (above > -kCoplanar) face.contacts.push_back(m);
    }
    if (std::none_of(result.begin(), result.end(),
                     [&](const SeamDirection& f) { return f.contacts == face.contacts && dot(f.direction, u) > 0; }))
      result.push_back(face);
  };
  for (std::size_t i = 0; i < n.size(); ++i)
    for (std::size_t j = i + 1; j < n.size(); ++j)
      for (std::size_t k = j + 1; k < n.size(); ++k) {
        const Vec3 across = cross(n[j] - n[i], n[k] - n[i]);
        if (norm(across) <= kCoplanar) continue;
        const Vec3 u = normalized(across);
        offer(u, dot(n[i], u));
        offer(-u, -dot(n[i], u));
      }
  return result;
}

}  // namespace matstruct
