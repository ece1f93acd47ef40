// unround(): spheres of the rounded solid become those of the solid as it came.
#include <gtest/gtest.h>

#include "convex_oracle.h"
#include "spheres/seams.h"
#include "spheres/unround.h"

namespace matstruct {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Seams, junctions and corners of a convex polyhedron as a mesh of spheres with their contacts.
struct Traced {
  MedialMesh mesh;
  VertexContacts contacts;
};

Traced trace(const Domain& domain) {
  Context context;
  ContactFinder finder(domain, 0.1 * kDegree);
  SeamNetwork network;
  trace_seams(finder, {}, {0.1}, network, context);
  Traced traced;
  const auto add = [&](const Vec3& center, double radius) {
    traced.mesh.centers.push_back(center);
    traced.mesh.radii.push_back(radius);
  };
  for (const SeamNode& node : network.nodes) add(node.sphere.center, node.sphere.radius);
  for (const SeamCurve& curve : network.curves)
    for (const TangentSphere& s : curve.spheres) add(s.center, s.radius);
  traced.contacts.start.push_back(0);
  for (std::size_t v = 0; v < traced.mesh.centers.size(); ++v) {
    const Vec3& center = traced.mesh.centers[v];
    for (const Contact& c : finder.find(center, std::sqrt(domain.query.closest(center).distance2), 1e-6)) {
      traced.contacts.points.push_back(c.point);
      traced.contacts.triangles.push_back(c.triangle);
    }
    traced.contacts.start.push_back(count(traced.contacts.points));
  }
  return traced;
}

double worst(const oracle::ConvexPolyhedron& solid, const Domain& domain, const MedialMesh& mesh) {
  double most = 0;
  for (std::size_t v = 0; v < mesh.centers.size(); ++v)
    most = std::max(most,
                    std::abs(solid.depth(domain.frame.to_input(mesh.centers[v])) * domain.frame.scale - mesh.radii[v]));
  return most;
}

TEST(Unround, SpheresOfRandomPolyhedraBecomeExact) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const oracle::ConvexPolyhedron solid = oracle::random_convex_polyhedron(seed, 12);
    Context context;
    const Domain domain =
        prepare_domain(oracle::tet_mesh_of(solid), {.convex_angle = 0.1}, context, nullptr, Coordinates::kRounded);
    ASSERT_GT(domain.frame.grid, 0);
    Traced traced = trace(domain);
    EXPECT_GT(worst(solid, domain, traced.mesh), 1e-10) << "rounding is felt";
    unround(domain, SurfaceQuery({domain.unrounded, domain.surface.triangles}), context, traced.contacts, traced.mesh);
    EXPECT_LT(worst(solid, domain, traced.mesh), 1e-12);
  }
}

}  // namespace
}  // namespace matstruct
