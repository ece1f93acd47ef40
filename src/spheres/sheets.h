// What a simplex of medial spheres is: part of one sheet, or a shortcut between sheets.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <matstruct/context.h>

#include "model/spheres.h"
#include "spheres/finder_pool.h"
#include "spheres/tangency.h"

namespace matstruct {

/// Whether the middle of two or three spheres lies in a stratum that all of them touch: they share contacts (seen from
/// there), and the ball next to it that is tangent to these is empty but for `depth`. Returns the number of these
/// contacts: 3 or more on a seam, 2 in a sheet, 1 on a medial curve (a single contact that goes round; of two spheres
/// only), 0 if there is no such stratum. A sphere with a single contact in which two of the others' run together ends
/// their sheet, and is of it. Decides from the surface itself, not from samples.
Index common_stratum(ContactFinder& finder, std::span<const TangentSphere* const> corners, double depth);

/// Whether the sphere has a single contact, which goes round it.
bool on_medial_curve(const TangentSphere& sphere);

/// The ball of that stratum next to the middle of the corners; nothing in the cases 1 and 0.
std::optional<TangentSphere> common_ball(ContactFinder& finder, std::span<const TangentSphere* const> corners,
                                         double depth);

/// The spheres with their contacts, by id: guards and dead spheres have none. Those of type kSheet are moved to be
/// tangent to their two nearest contacts if they nearly are, within a part of `spacing`.
std::vector<TangentSphere> with_contacts(FinderPool& finders, const Spheres& spheres, double spacing,
                                         const Context& context);

/// For every pair of spheres that is no part of one sheet: where the sheets of the two end on the way to the other, in
/// the order of the pairs; then, in that order, where the sheets of those meet that do not end on that way. Seeds for
/// trace_seams().
std::vector<TangentSphere> seam_seeds(FinderPool& finders, const std::vector<TangentSphere>& spheres,
                                      const std::vector<Edge>& pairs, const Context& context);

}  // namespace matstruct
