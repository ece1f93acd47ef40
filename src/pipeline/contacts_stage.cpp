#include "pipeline/contacts_stage.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/tolerances.h"

namespace matstruct {

namespace {

constexpr Index kGrain = 64;

}  // namespace

VertexContacts vertex_contacts(FinderPool& finders, const MedialMesh& mesh, const Context& context) {
  const Domain& domain = finders.domain();
  const double touch = tolerance::kSameDistance * domain.diagonal;
  std::vector<Contacts> found(mesh.centers.size());
  finders.for_each(context, count(found), kGrain, [&](ContactFinder& finder, Index v) {
    // From the true distance, not the radius: a sphere that is off the axis has its contacts all the same.
    const Vec3& center = mesh.centers[uz(v)];
    found[uz(v)] = finder.find(center, std::sqrt(domain.query.closest(center).distance2), touch);
  });
  VertexContacts result;
  result.start.push_back(0);
  for (const Contacts& contacts : found) {
    for (const Contact& c : contacts) {
      result.points.push_back(c.point);
      result.triangles.push_back(c.triangle);
    }
    result.start.push_back(count(result.points));
  }
  result.patch_of_triangle = patches(domain);
  return result;
}

Report::Strata strata_facts(const SurfaceQuery& surface, double diagonal, const MedialMesh& mesh,
                            const Structure& structure, const VertexContacts& contacts) {
  Report::Strata facts;
  facts.sheets = count(structure.sheets);
  facts.seams = count(structure.seams);
  facts.boundaries = count(structure.boundaries);
  facts.curves = count(structure.curves);
  for (Index v = 0; v < count(mesh.centers); ++v) {
    const double distance = std::sqrt(surface.closest(mesh.centers[uz(v)]).distance2);
    facts.worst_tangency = std::max(facts.worst_tangency, std::abs(mesh.radii[uz(v)] - distance) / diagonal);
    // A ball that is not as large as the distance to the surface touches nothing.
    const bool fits = std::abs(mesh.radii[uz(v)] - distance) <= tolerance::kSameDistance * diagonal;
    const Index touched = fits ? contacts.of(v) : 0;
    switch (mesh.types[uz(v)]) {
      case SphereType::kSeam:
        ++facts.seam_spheres;
        facts.seam_spheres_tangent += touched >= 3 ? 1 : 0;
        break;
      case SphereType::kJunction:
        ++facts.junctions;
        ++facts.junction_spheres;
        facts.junction_spheres_tangent += touched >= 4 ? 1 : 0;
        break;
      case SphereType::kSheet:
        facts.stray_seam_spheres += touched >= 3 ? 1 : 0;
        break;
      case SphereType::kSharpEdge:
      case SphereType::kCorner:
        break;
    }
  }
  return facts;
}

}  // namespace matstruct
