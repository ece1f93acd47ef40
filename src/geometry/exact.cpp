#include "geometry/exact.h"

#include <array>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>

#include "base/tolerances.h"

namespace matstruct {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Rational = CGAL::Exact_rational;

Kernel::Point_3 point(const Vec3& p) {
  return {p.x, p.y, p.z};
}

// The cross product in rational arithmetic, divided by its greatest component before it is rounded.
Vec3 exact_direction(const Vec3& a, const Vec3& b, const Vec3& c) {
  std::array<Rational, 3> u, v, n;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    u[i] = Rational(b[k]) - Rational(a[k]);
    v[i] = Rational(c[k]) - Rational(a[k]);
  }
  for (std::size_t i = 0; i < 3; ++i) n[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
  Rational greatest = 0;
  for (const Rational& x : n) greatest = std::max(greatest, Rational(CGAL::abs(x)));
  if (greatest == 0) return {};
  return {CGAL::to_double(Rational(n[0] / greatest)), CGAL::to_double(Rational(n[1] / greatest)),
          CGAL::to_double(Rational(n[2] / greatest))};
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return static_cast<int>(CGAL::orientation(point(a), point(b), point(c), point(d)));
}

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  return CGAL::collinear(point(a), point(b), point(c));
}

Vec3 triangle_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, n = cross(u, v);
  if (norm(n) > tolerance::kNeedle * norm(u) * norm(v)) return normalized(n);
  return normalized(exact_direction(a, b, c));
}

}  // namespace matstruct
