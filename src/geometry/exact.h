// Exact signs of small determinants. CGAL stays inside the .cpp.
#pragma once

#include <matstruct/vec3.h>

namespace matstruct {

/// Sign of dot(cross(b - a, c - a), d - a), without rounding error: +1, 0 or -1.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// True if the three points lie on one line (or coincide), without rounding error.
bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);

/// Unit normal of the counter-clockwise triangle abc, accurate to rounding even for a needle; zero if collinear(a, b,
/// c).
Vec3 triangle_normal(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace matstruct
