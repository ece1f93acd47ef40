// Guards: helper spheres on concave sharp lines that keep the power diagram simple there.
//
// Every medial sphere that touches a concave edge has power distance 0 at its contact. Along the edge, spheres of all
// the sheets that end there alternate, and on the side that a sphere is turned away from, tiny parts of its cell
// remain: the diagram has non-contractible pieces at every scale, and inserting spheres makes more of them. A guard is
// a sphere centred on the edge, of radius 0 with a small reach, its radius in the power diagram. Guards overlap along
// the line, so that the power distance to one of them is negative on all of it: they own a tube around the edge,
// outside which only spheres turned that way compete. A guard is no medial sphere. It stays in the diagram to the end:
// its star is cut out of the dual complex (extract/guards.h) before thinning.
#pragma once

#include <optional>
#include <vector>

#include <matstruct/context.h>

#include "model/spheres.h"
#include "prepare/domain.h"
#include "spheres/point_grid.h"

namespace matstruct {

/// Guards of all concave lines, line by line, then one for every vertex that ends concave lines and has no corner
/// sphere. `spacing` in internal units. Their reach is at most a fixed part of it, and smaller near ends of a line that
/// have a corner sphere and where the medial spheres at the edge are small; neighbours on a line overlap.
std::vector<SphereSeed> guard_spheres(const Domain& domain, double spacing, const Context& context);

/// The reach of feature spheres: tolerance::kFeatureReach, but inside guards that of the greatest of them. A guard is
/// larger than a step or wall far thinner than the spacing, and the feature sphere would have no cell inside it; at
/// equal reach each has what is nearer to it. The guards come and stay with the initial spheres.
class FeatureReach {
 public:
  FeatureReach(const Domain& domain, const std::vector<SphereSeed>& seeds);
  FeatureReach(const FeatureReach&) = delete;  // the grid refers to the centres
  double at(const Vec3& x) const;

 private:
  double least_;
  std::vector<double> reach_;  // of the guards
  std::vector<Vec3> centers_;
  double greatest_;
  std::optional<PointGrid> grid_;
};

/// The medial sphere to take the place of a guard that has to stay in the mesh: the ball that touches the guard's line
/// where it stands, half-way between the faces. A guard that is off its line already stays where it is.
SphereSeed medial_sphere_at(const Domain& domain, const SphereSeed& guard);

}  // namespace matstruct
