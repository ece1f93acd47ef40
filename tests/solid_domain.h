// A prepared solid with a contact finder, addressed in input units.
#pragma once

#include <cmath>
#include <numbers>

#include "convex_oracle.h"
#include "prepare/domain.h"
#include "spheres/contacts.h"
#include "spheres/tangency.h"

namespace matstruct {

constexpr double kSmoothAngle = std::numbers::pi / 6;

struct PreparedSolid {
  explicit PreparedSolid(const TetMesh& mesh)
      : domain(prepare_domain(mesh, {}, context)), finder(domain, kSmoothAngle) {}

  /// Where the surface is nearest to a point; input units.
  Contact contact_near(const Vec3& place) {
    const SurfaceHit hit = domain.query.closest(domain.frame.to_internal(place));
    return {hit.point, hit.triangle, std::sqrt(hit.distance2)};
  }
  Contacts contacts_near(const std::vector<Vec3>& places) {
    Contacts contacts;
    for (const Vec3& place : places) contacts.push_back(contact_near(place));
    return contacts;
  }
  /// The largest ball about a centre, with its contacts.
  TangentSphere sphere_at(const Vec3& center) {
    const Vec3 c = domain.frame.to_internal(center);
    const double radius = std::sqrt(domain.query.closest(c).distance2);
    TangentSphere sphere{c, radius, finder.find(c, radius, 1e-7)};
    if (sphere.contacts.size() == 1) sphere.spread = finder.spread(sphere.contacts[0], c);
    return sphere;
  }
  double to_input(double length) const { return length / domain.frame.scale; }
  double to_internal(double length) const { return length * domain.frame.scale; }

  Context context;
  Domain domain;
  ContactFinder finder;
};

/// A box around the origin.
struct Box : PreparedSolid {
  Box(double a, double b, double c) : PreparedSolid(oracle::tet_mesh_of(oracle::box(a, b, c))) {}
};

}  // namespace matstruct
