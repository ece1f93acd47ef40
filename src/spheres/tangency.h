// Spheres tangent to given contacts: the balls of a sheet (two contacts), of a seam (three) and of a junction (four or
// more). Newton's method for "all contacts are equally far": the sphere optimisation of MATFP (2022) without weights,
// run to convergence. On planes one step is exact.
#pragma once

#include <array>
#include <optional>

#include "spheres/contacts.h"

namespace matstruct {

struct TangentSphere {
  Vec3 center;
  double radius = 0;  ///< mean distance to the contacts
  Contacts contacts;  ///< those asked for, in their order, followed to the centre
  double spread = 0;  ///< ContactFinder::spread() of a single contact, where with_contacts() has measured it
};

/// The sphere next to `guess` that is tangent to all contacts (to tolerance::kTangent, or, where a part has more
/// contacts than freedom by its symmetry, kSameDistance), reached by the least motion: what the contacts leave free
/// does not move. Nothing if there is none within `reach` of the guess, or two contacts run into one basin on the way.
/// The ball may hold other parts of the surface: see intruder().
std::optional<TangentSphere> tangent_sphere(ContactFinder& finder, const Vec3& guess, const Contacts& contacts,
                                            double reach);

/// Whether the centre is in the solid.
bool inside(const ContactFinder& finder, const TangentSphere& sphere);

/// The part of the surface deepest inside the ball, if it is deeper than `depth`; its distance is below the radius.
std::optional<Contact> intruder(ContactFinder& finder, const TangentSphere& sphere, double depth);

/// Whether a tangent sphere is a medial one: its centre in the solid, and no intruder.
bool is_medial(ContactFinder& finder, const TangentSphere& sphere, double depth);

/// Radius with which a tangent sphere may stand in the power diagram: no greater than the distance to the surface.
/// Where contacts are equally far up to kSameDistance only, the ball would hold bits of the sharp lines that it
/// touches, which no sphere of the line could win back.
double radius_to_surface(const Domain& domain, const TangentSphere& sphere);

/// The number of contacts in clearly different directions: where a solid touches itself, two of its faces may lie on
/// each other.
Index clear_contacts(const Domain& domain, const TangentSphere& sphere);

/// Whether all contacts lie within an angle (radians) of the first one, as between facets of one curved face.
bool is_faint(const Domain& domain, const TangentSphere& sphere, double angle);

/// The ball that keeps the contacts and gains one, the first that it meets on its way to `sphere`, which is tangent to
/// them but not empty: sphere shrinking one dimension up. `contacts` first, the new one last. Nothing if no such ball
/// is empty within `reach` of the sphere.
std::optional<TangentSphere> shrunk_to_next_contact(ContactFinder& finder, const TangentSphere& sphere, double depth,
                                                    double reach);

/// Directions in which a small ball may go such that three or more of its contacts stay its nearest: the seams that
/// leave its centre. With u such a direction, the contacts of greatest n . u are kept, n the directions to contacts:
/// the faces of the convex hull of the n.
struct SeamDirection {
  Vec3 direction;               ///< unit
  std::vector<Index> contacts;  ///< positions of three or more, ascending
};
std::vector<SeamDirection> seam_directions(const std::vector<Vec3>& contact_directions);

}  // namespace matstruct
