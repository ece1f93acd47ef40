// Spheres of radius 0 on the convex sharp features.
#pragma once

#include <vector>

#include "model/spheres.h"
#include "prepare/domain.h"

namespace matstruct {

/// Point at `position` of a feature line: k + t is at parameter t in [0, 1] of the line's k-th edge.
Vec3 point_on_line(const Domain& domain, const FeatureLine& line, double position);
/// The line's vertices as points; a closed line repeats its first one at the end.
std::vector<Vec3> points_of_line(const Domain& domain, const FeatureLine& line);
/// Position half-way, by arc length, between two positions of a line; 0 <= `from` <= `to` <= number of edges (a closed
/// line may be passed round once: `to` up to twice the number of edges; the result is reduced to the first round).
double middle_of_line(const Domain& domain, const FeatureLine& line, double from, double to);

/// A corner sphere at every end of an open convex line, then spheres along every convex line at equal arc lengths of at
/// most `spacing` (internal units), at least one between two corners and three on a closed line. Their reach is
/// tolerance::kFeatureReach.
std::vector<SphereSeed> feature_spheres(const Domain& domain, double spacing);

}  // namespace matstruct
