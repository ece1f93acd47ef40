// Sphere shrinking (Ma, Bae & Choi 2012): the medial sphere that touches the surface at a given pin.
#pragma once

#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "prepare/domain.h"
#include "spheres/pins.h"

namespace matstruct {

/// Outcome of a shrinking.
struct ShrunkSphere {
  Vec3 center;
  double radius = 0;  ///< exact distance from the centre to the surface: the ball is empty; internal units
  Vec3 contact;       ///< the second contact point
  Index contact_triangle = kInvalid;
  double separation = 0;   ///< angle at the centre between pin and second contact, radians in [0, pi]
  bool converged = false;  ///< false: no ball of use (pin on noise, centre outside); do not use the sphere
};

/// Shrinks a ball that stays tangent at `pin` until it is empty. `smooth_angle` (radians): when the next contact would
/// lie at a smaller angle from the pin, seen from the centre, the two are one smooth contact (facets of a curved
/// surface); the ball of the step before is taken, with its radius set to the distance of its centre to the surface.
/// Where that costs a noticeable part of the radius, shrinking goes on from the surface point nearest to the centre,
/// which climbs to the middle between curved walls: `center` may then lie off the pin's normal, by less than the smooth
/// angle. With smooth_angle 0 the ball is tangent at both contacts to rounding. Costs a handful of closest-point
/// queries.
ShrunkSphere shrink_sphere(const Domain& domain, const Pin& pin, double smooth_angle);

/// shrink_sphere() of every pin, in parallel; results in the order of the pins.
std::vector<ShrunkSphere> shrink_spheres(const Domain& domain, const std::vector<Pin>& pins, double smooth_angle,
                                         const Context& context);

}  // namespace matstruct
