// Points of the surface from which spheres are shrunk.
#pragma once

#include <cstdint>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "prepare/domain.h"

namespace matstruct {

/// A point of the surface with a direction in which the solid's outside lies.
struct Pin {
  Vec3 point;
  Vec3 normal;                ///< unit, outward; on a concave edge any direction of the fan between its two normals
  Index triangle = kInvalid;  ///< a surface triangle that holds the point
};

/// Poisson-disk sample of the whole surface, by dart throwing on a dense area-weighted sample: pins are at least
/// `spacing` apart, and every surface point lies within about 1.3 of it from one. `spacing` > 0, internal units;
/// distances are in space. Deterministic for a seed, whatever the number of threads.
std::vector<Pin> sample_surface(const Domain& domain, double spacing, std::uint64_t seed, const Context& context);

/// Pins along the concave feature lines: on every stretch of `spacing` one for each direction of a fan that spans the
/// two face normals in steps of about `fan_step` radians, at different points of the stretch.
std::vector<Pin> sample_concave_lines(const Domain& domain, double spacing, double fan_step);

}  // namespace matstruct
