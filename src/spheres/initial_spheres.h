// The first set of medial spheres: features, and spheres shrunk from a Poisson-disk sample of the surface.
#pragma once

#include <vector>

#include <matstruct/context.h>
#include <matstruct/options.h>

#include "model/spheres.h"
#include "prepare/domain.h"

namespace matstruct {

/// Distance between neighbouring pins and between spheres on sharp lines: diagonal / gamma, internal units.
double target_spacing(const Domain& domain, const Options& options);
/// Angle, in radians, below which two contacts of a ball count as one smooth contact: the convex angle, so that what is
/// no sharp edge is smooth.
double smooth_angle(const Options& options);

/// Feature spheres, then guards of the concave lines (spheres/guards.h), then sheet spheres without those that crowd
/// others of the same sheet (nearer than half the spacing to a greater sphere that contains their centre) and those
/// that hug a convex sharp line (nearer to it than half the spacing, with a sphere of about no less radius farther
/// inside).
Spheres initial_spheres(const Domain& domain, const Options& options, const Context& context);

}  // namespace matstruct
