// Orthogonal projections of R^3 as plain data.
#pragma once

#include <array>

#include <matstruct/vec3.h>

namespace matstruct {

/// Symmetric 3 x 3 matrix, row by row, that projects on the directions in which a centre may move.
using Projector = std::array<double, 9>;

inline constexpr Projector kNoDirection{};
inline constexpr Projector kAllDirections{1, 0, 0, 0, 1, 0, 0, 0, 1};

constexpr Vec3 project(const Projector& p, const Vec3& v) {
  return {p[0] * v.x + p[1] * v.y + p[2] * v.z, p[3] * v.x + p[4] * v.y + p[5] * v.z,
          p[6] * v.x + p[7] * v.y + p[8] * v.z};
}
/// On the line along the unit vector d.
constexpr Projector along(const Vec3& d) {
  return {d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.x, d.y * d.y, d.y * d.z, d.z * d.x, d.z * d.y, d.z * d.z};
}
/// On the plane across the unit vector n.
constexpr Projector across(const Vec3& n) {
  const Projector p = along(n);
  return {1 - p[0], -p[1], -p[2], -p[3], 1 - p[4], -p[5], -p[6], -p[7], 1 - p[8]};
}

}  // namespace matstruct
