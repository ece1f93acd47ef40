// Preservation of the seams: each shall be a chain of dual edges between its own spheres.
#pragma once

#include <vector>

#include "model/spheres.h"
#include "preserve/edits.h"
#include "rpd/rpd.h"
#include "spheres/finder_pool.h"
#include "spheres/seams.h"
#include "spheres/sheets.h"

namespace matstruct {

/// Seams are found again in the spheres by SphereSeed::seam, node and corner.
struct SeamCheck {
  Index pairs = 0;    ///< of neighbours on a seam
  Index missing = 0;  ///< of these: their cells do not meet
  Edits edits;        ///< a sphere of the seam between each such pair, unless they are near each other already
};

/// `spacing`: target distance of spheres, internal units.
SeamCheck check_seams(FinderPool& finders, const SeamNetwork& network, const Spheres& spheres, const Rpd& rpd,
                      double spacing);

/// For each pair of spheres that no sheet joins: the spheres of known seams where their sheets end on the way to each
/// other. `medial`: spheres by id, with contacts.
Edits propose_on_seams(FinderPool& finders, const SeamNetwork& network, const std::vector<TangentSphere>& medial,
                       const std::vector<Edge>& pairs, double spacing, const Context& context);

/// Gives `seed`, which is `sphere`, its place on a seam of the network that passes within half the spacing. Returns
/// whether there is one.
bool place_on_seam(ContactFinder& finder, const SeamNetwork& network, const TangentSphere& sphere, double spacing,
                   SphereSeed& seed);

}  // namespace matstruct
