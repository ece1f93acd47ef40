// Contacts of a ball: the connected parts of the surface that it touches.
//
// Seen from the centre c of a ball, the distance to the surface has one local minimum for each contact. Facets of a
// curved surface give many more, but shallow ones. A contact is therefore a *basin* (0-dimensional persistence): two
// minima belong to one basin if they are connected through surface points that are farther from c than the lesser of
// them by at most the part `ridge`, without crossing a convex sharp edge. Two planes that meet at an angle of `smooth`
// rise by 1 / cos(smooth / 2) - 1 between the feet of a ball in their corner, so that is the ridge: what is no sharp
// edge is one contact.
#pragma once

#include <cstdint>
#include <vector>

#include <matstruct/types.h>

#include "prepare/domain.h"

namespace matstruct {

struct Contact {
  Vec3 point;                 ///< nearest to the centre among the basin's points
  Index triangle = kInvalid;  ///< a surface triangle that holds it
  double distance = 0;        ///< from the centre
};

/// The contacts of a ball about `center`, nearest first.
using Contacts = std::vector<Contact>;

/// Finds and follows contacts. Holds a workspace: one finder per thread.
class ContactFinder {
 public:
  /// Keeps a reference to `domain`. `smooth_angle` in radians, in (0, pi).
  ContactFinder(const Domain& domain, double smooth_angle);

  /// All basins that reach to within `radius + touch` of `center`; `radius` is the distance of the centre to the
  /// surface. Cost: a range query, and the triangles in the shell.
  Contacts find(const Vec3& center, double radius, double touch);
  /// The basin around `center` into which the contact runs down when the centre of its ball moves there: the walk is
  /// downhill over the surface, lowest edge first, never across a convex sharp edge.
  Contact follow(const Contact& from, const Vec3& center);
  /// Greatest angle, radians, between the middle of the directions to a contact's basin and one of them: about the
  /// smooth angle's half on a plane, half a right angle more in a fillet between two walls, pi on a cylinder around its
  /// axis.
  double spread(const Contact& contact, const Vec3& center);

  /// Whether two contacts are the same basin. Both must come from follow() or find() about one centre.
  bool same(const Contact& a, const Contact& b) const;

  const Domain& domain() const { return domain_; }

 private:
  struct Entry {
    double distance2;
    Index triangle;
  };
  struct Visited {
    double distance2;
    bool is_known = false;  // of a basin that was flooded before
  };
  template <class Visit>
  void flood(Index start, const Vec3& center, double least2, Visit visit);
  double edge_distance2(Index triangle, std::size_t local, const Vec3& center) const;
  double level2(double least2) const;

  const Domain& domain_;
  double rise_;                              // 1 + ridge
  double floor_;                             // least rise of a ridge, a length
  std::vector<std::uint32_t> stamp_, seen_;  // per triangle: the flood, the search that visited it last
  std::uint32_t flood_ = 0, search_ = 0;
  std::vector<std::int64_t> basin_;  // per triangle: its basin, one of the present search if >= first_basin_
  std::int64_t first_basin_ = 0;
  std::vector<SurfaceHit> basins_;  // of the present search
  std::vector<Entry> heap_, popped_;
  std::vector<Index> shell_;
  std::vector<Vec3> directions_;
};

/// Unit vector from the centre to the contact; at a radius of zero, the surface's normal there.
Vec3 direction(const Domain& domain, const Vec3& center, const Contact& contact);

/// Whether the edge opposite a triangle's local vertex is convex and sharp.
bool is_patch_border(const Domain& domain, Index triangle, std::size_t local);

/// Per surface triangle its patch: triangles are in one patch if they are connected over edges that are not convex and
/// sharp. Numbered by their first triangles. A basin never leaves its patch.
std::vector<Index> patches(const Domain& domain);

}  // namespace matstruct
