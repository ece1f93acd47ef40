// repair_slivers(): flat and inverted tets become positive without a change of the boundary.
#include "prepare/slivers.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <matstruct/error.h>

#include "base/index.h"
#include "geometry/exact.h"
#include "shapes.h"

namespace matstruct {
namespace {

// A pyramid over the unit square cut along the diagonal 1-3, with a tet laid under the square so that the boundary
// shows the other diagonal. `sag` moves vertex 0 out of the plane of the others.
TetMesh pyramid_with_flat_base(double sag) {
  return {.vertices = {{0, 0, sag}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}},
          .tets = {{0, 1, 3, 4}, {1, 2, 3, 4}, {0, 1, 2, 3}}};
}

std::vector<Triangle> boundary_triangles(const TetMesh& mesh) {
  return shapes::boundary(mesh).triangles;
}

bool all_positive(const TetMesh& mesh) {
  return std::all_of(mesh.tets.begin(), mesh.tets.end(), [&](const Tetrahedron& t) {
    const auto p = [&](std::size_t k) { return mesh.vertices[uz(t[k])]; };
    return orientation(p(0), p(1), p(2), p(3)) > 0;
  });
}

TEST(Slivers, FlatAndInvertedTetsBecomePositive) {
  for (const double sag : {0.0, 1e-300, -1e-300, 1e-12, -1e-12, 1e-3, -1e-3}) {
    SCOPED_TRACE(sag);
    TetMesh mesh = pyramid_with_flat_base(sag);
    const auto before = boundary_triangles(mesh);
    const double volume = shapes::volume(mesh);
    ASSERT_TRUE(repair_slivers(mesh, {}));
    EXPECT_TRUE(all_positive(mesh));
    EXPECT_EQ(boundary_triangles(mesh), before);
    EXPECT_NEAR(shapes::volume(mesh), volume, 1e-15);
  }
}

TEST(Slivers, GoodMeshesStayAsTheyAre) {
  TetMesh mesh = shapes::hollow_box();
  const TetMesh before = mesh;
  EXPECT_TRUE(repair_slivers(mesh, {}));
  EXPECT_EQ(mesh.vertices, before.vertices);
  EXPECT_EQ(mesh.tets, before.tets);
}

TEST(Slivers, ATetWithoutInnerEdgesCannotBeRepaired) {
  TetMesh flat{.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, .tets = {{0, 1, 2, 3}}};
  EXPECT_FALSE(repair_slivers(flat, {}));
}

TEST(Slivers, MixedOrientationsAreRefused) {
  TetMesh mesh = pyramid_with_flat_base(0);
  std::swap(mesh.tets[0][0], mesh.tets[0][1]);
  EXPECT_THROW(repair_slivers(mesh, {}), Error);
}

}  // namespace
}  // namespace matstruct
