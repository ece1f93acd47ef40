// The seams of the medial axis as curves: traced from the corners of the solid and from seed spheres, junction by
// junction, so that a connected network is found whole, however short its parts are.
#pragma once

#include <optional>
#include <vector>

#include <matstruct/context.h>

#include "spheres/tangency.h"

namespace matstruct {

/// Where seams end: a junction (four contacts or more, not on one seam) or a convex corner (radius 0).
struct SeamNode {
  TangentSphere sphere;     ///< with all its contacts
  Index corner = kInvalid;  ///< surface vertex of a corner
  /// A curve that passes through, and where: traced without notice of the contact that makes it a node. kInvalid: none.
  Index curve = kInvalid;
  double position = 0;
};

/// A curve of spheres with the same three or more contacts.
struct SeamCurve {
  std::vector<TangentSphere> spheres;  ///< in order, the ends included; a closed curve does not repeat its first one
  Index begin = kInvalid, end = kInvalid;  ///< nodes; kInvalid where the seam ends freely (two contacts become one)
  bool closed = false;
};

struct SeamNetwork {
  std::vector<SeamNode> nodes;
  std::vector<SeamCurve> curves;
};

struct SeamOptions {
  double spacing = 0;  ///< target distance of spheres along a seam, internal units
};

/// Adds to the network, if it is empty, all seams that leave the convex corners; then those of each seed that is on no
/// curve yet; and from every junction on the way all seams that leave it and are not known. `seeds`: spheres tangent to
/// three contacts or more, as of shrunk_to_next_contact(). Nodes and curves that are there stay. Spheres of a curve are
/// at equal distances of about the spacing; every ball is empty to tolerance::kSameDistance.
void trace_seams(ContactFinder& finder, const std::vector<TangentSphere>& seeds, const SeamOptions& options,
                 SeamNetwork& network, const Context& context);

/// A sphere inside a seam, next to its `k`-th one, with the contacts of the seam: its ends may have more. Of a curve of
/// two spheres it is one of them, with the contacts that both have.
TangentSphere inside_seam(ContactFinder& finder, const SeamCurve& curve, std::size_t k);

/// A place on a curve of the network: `position` k + t is at parameter t between its spheres k and k + 1.
struct SeamPlace {
  Index curve = kInvalid;
  double position = 0;
};
/// Where a seam that passes within `reach` of the sphere has three contacts with it. Curves that begin or end at the
/// node `end` are left out.
std::optional<SeamPlace> place_on_network(ContactFinder& finder, const SeamNetwork& network,
                                          const TangentSphere& sphere, double reach, Index end = kInvalid);

/// Contacts shared by two spheres, as positions in `a.contacts`: those that run into one basin half-way between the two
/// centres.
std::vector<Index> shared_contacts(ContactFinder& finder, const Vec3& center_a, const Contacts& a, const Vec3& center_b,
                                   const Contacts& b);

}  // namespace matstruct
