// MSER, spikes and medialness: none on the exact axis of convex solids, found where spheres or faces leave it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include <matstruct/error.h>
#include <matstruct/metrics.h>

#include "convex_oracle.h"
#include "refined.h"
#include "solids.h"

namespace matstruct {
namespace {

constexpr double kAnyEdge = 0.5;  // every edge of the solids below is sharper than this, in degrees

struct Exact {
  MedialMesh mesh;
  TriSurface surface;
};

Exact exact(const oracle::ConvexPolyhedron& solid, int subdivisions) {
  return {refined(oracle::medial_mesh_of(oracle::medial_axis(solid)), subdivisions), oracle::surface_of(solid)};
}

StructureErrors errors_of(const Exact& e, int threads = 2) {
  Context context;
  context.threads = threads;
  return structure_errors(e.mesh, e.surface, kAnyEdge, context);
}

std::vector<oracle::ConvexPolyhedron> solids() {
  std::vector<oracle::ConvexPolyhedron> list{
      oracle::box(1, 1, 1),       oracle::box(1, 1, 2),       oracle::box(1, 2, 2),       oracle::box(0.1, 1, 2),
      oracle::tetrahedron(),      oracle::prism(3, 0.5, 2),   oracle::prism(6, 0.5, 1),   oracle::prism(5, 0.4, 0.5),
      oracle::pyramid(4, 0.5, 1), oracle::pyramid(7, 1, 0.4), oracle::prism(12, 1, 1.125)};
  for (int faces = 6; faces <= 20; faces += 2)
    list.push_back(oracle::random_convex_polyhedron(static_cast<std::uint64_t>(200 + faces), faces));
  return list;
}

TEST(StructureErrors, NoneOnTheExactAxisOfConvexSolids) {
  const auto all = solids();
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (const int subdivisions : {0, 1, 3}) {
      SCOPED_TRACE(testing::Message() << "solid " << k << ", subdivided " << subdivisions << " times");
      const StructureErrors errors = errors_of(exact(all[k], subdivisions));
      EXPECT_TRUE(errors.told_by_types);
      EXPECT_EQ(errors.seam_spheres_wrong, 0);
      EXPECT_EQ(errors.junction_spheres_wrong, 0);
      EXPECT_EQ(errors.junction_spheres, oracle::medial_axis(all[k]).junctions());
      EXPECT_EQ(errors.spikes, 0);
      EXPECT_EQ(errors.mser(), 0);
      EXPECT_EQ(errors.spike_share(), 0);
      if (subdivisions > 0) {
        EXPECT_GT(errors.seam_spheres, 0);
      }
      if (subdivisions > 1) {
        EXPECT_GT(errors.sheet_spheres, 0);
      }
    }
  }
}

TEST(StructureErrors, NoneOnTheExactAxesOfManyPolyhedra) {
  Index claimed = 0, wrong = 0;
  for (int k = 0; k < 200; ++k)
    for (const int subdivisions : {0, 2}) {
      const auto solid = oracle::random_convex_polyhedron(static_cast<std::uint64_t>(k), 6 + k % 15);
      const StructureErrors errors = errors_of(exact(solid, subdivisions));
      claimed += errors.seam_spheres + errors.junction_spheres;
      wrong += errors.seam_spheres_wrong + errors.junction_spheres_wrong;
    }
  EXPECT_GT(claimed, 30000);
  EXPECT_EQ(wrong, 0);
}

TEST(StructureErrors, NoneWhereTwoJunctionsAreNearEachOther) {
  for (const double side : {1.3, 1.1, 1.03, 1.01, 1.003})
    for (const int subdivisions : {0, 1, 2}) {
      SCOPED_TRACE(testing::Message() << side << ", subdivided " << subdivisions << " times");
      const StructureErrors errors = errors_of(exact(oracle::box(1, side, 2), subdivisions));
      EXPECT_EQ(errors.junction_spheres, 4);
      EXPECT_EQ(errors.junction_spheres_wrong, 0);
      EXPECT_EQ(errors.seam_spheres_wrong, 0);
    }
}

TEST(StructureErrors, WithoutTypesTheFacesAtEdgesTell) {
  Exact e = exact(oracle::box(1, 2, 3), 3);
  const StructureErrors by_types = errors_of(e);
  std::fill(e.mesh.types.begin(), e.mesh.types.end(), SphereType::kSheet);
  const StructureErrors by_strata = errors_of(e);
  EXPECT_FALSE(by_strata.told_by_types);
  EXPECT_EQ(by_strata.seam_spheres, by_types.seam_spheres);
  EXPECT_EQ(by_strata.junction_spheres, 4);
  EXPECT_EQ(by_strata.sheet_spheres, by_types.sheet_spheres);
  EXPECT_EQ(by_strata.mser(), 0);
}

TEST(StructureErrors, AFacetedSmoothPatchIsOneContact) {
  // A high prism with 48 side faces is a cylinder of 7.5 degrees per edge: its medial "sheets" between neighbouring
  // facets are noise of the tessellation, and every seam of theirs is wrong.
  const Exact e = exact(oracle::prism(48, 1, 4), 2);
  Context context;
  const StructureErrors smooth = structure_errors(e.mesh, e.surface, 30, context);
  EXPECT_GT(smooth.mser(), 0.9);
  EXPECT_EQ(errors_of(e).mser(), 0);  // taken for a prism, it is exact
}

/// A ball of the plane, for a solid that is extruded along z.
struct Disk {
  double x, y, radius;
};

// Strips on three sheets along z, from their common seam to a line of spheres each.
MedialMesh strips(const Disk& seam, const std::array<Disk, 3>& sheets, const std::array<double, 3>& heights) {
  MedialMesh mesh;
  const auto column = [&](const Disk& d, SphereType type) {
    for (const double z : heights) {
      mesh.centers.push_back({d.x, d.y, z});
      mesh.radii.push_back(d.radius);
      mesh.types.push_back(type);
    }
  };
  column(seam, SphereType::kSeam);
  for (const Disk& d : sheets) column(d, SphereType::kSheet);
  std::set<Edge> edges;
  for (const Index side : {3, 6, 9})
    for (Index k = 0; k < 2; ++k)
      for (const Triangle& t : {Triangle{k, k + 1, side + k}, Triangle{k + 1, side + k, side + k + 1}}) {
        mesh.faces.push_back(t);
        edges.insert({{t[0], t[1]}, {t[0], t[2]}, {t[1], t[2]}});
      }
  std::sort(mesh.faces.begin(), mesh.faces.end());
  mesh.edges.assign(edges.begin(), edges.end());
  return mesh;
}

// Around the seam in the middle of the T of solids.h, at (3/2, 19/8): its web downwards, and to both sides what is
// equally far from the top and from a concave edge (x = 3/2 -+ 1/2, y = 2).
MedialMesh strips_in_a_t() {
  const double y = (5 - 0.2 * 0.2) / 2;  // at 1/5 from the edge's x
  return strips({1.5, 2.375, 0.625}, {Disk{1.5, 1.8, 0.5}, Disk{1.2, y, 3 - y}, Disk{1.8, y, 3 - y}}, {1.5, 2, 2.5});
}

TEST(StructureErrors, ASeamBesideFilletsIsRight) {
  // A plate of thickness 2 with a rounded end: its middle sheet forks at (0, 1) to the axes of both fillets. The ball
  // around the fork that reaches the contacts of a sphere a radius up the middle holds the fillets, by which all the
  // surface there is joined; the fork is right all the same.
  constexpr int kSegments = 8;
  std::vector<Vec3> outline{{1, 6, 0}, {-1, 6, 0}};
  for (const double side : {-1.0, 1.0})
    for (int k = 0; k <= kSegments; ++k) {
      const double turn = (side < 0 ? k : kSegments - k) * std::numbers::pi / (2 * kSegments);
      outline.push_back({side * (0.5 + 0.5 * std::cos(turn)), 0.5 - 0.5 * std::sin(turn), 0});
    }
  std::vector<Triangle> fan;
  for (Index k = 1; k + 1 < static_cast<Index>(outline.size()); ++k) fan.push_back({0, k, k + 1});
  const TriSurface surface = shapes::boundary(shapes::extruded(outline, fan, 8));
  MedialMesh mesh = strips({0, 1, 1}, {Disk{0, 2, 1}, Disk{-0.5, 0.5, 0.5}, Disk{0.5, 0.5, 0.5}}, {3, 4, 5});
  Context context;
  EXPECT_EQ(structure_errors(mesh, surface, 30, context).mser(), 0);
  // A fork that is put too high has the walls for contacts only, wherever its sheets end.
  for (std::size_t v = 0; v < 3; ++v) mesh.centers[v].y = 1.6;
  for (std::size_t v = 3; v < 6; ++v) mesh.centers[v].y = 2.6;
  EXPECT_EQ(structure_errors(mesh, surface, 30, context).mser(), 1);
}

TEST(StructureErrors, AConcaveEdgeAndItsFacesAreOneContact) {
  const TriSurface surface = shapes::boundary(shapes::extruded({"###", ".#.", ".#."}, 4));
  Context context;
  const StructureErrors right = structure_errors(strips_in_a_t(), surface, 30, context);
  EXPECT_EQ(right.seam_spheres, 3);
  EXPECT_EQ(right.seam_spheres_wrong, 0);
  EXPECT_EQ(right.sheet_spheres, 9);
  EXPECT_EQ(right.spikes, 0);
  MedialMesh without = strips_in_a_t();  // the web alone touches the web's two sides
  std::erase_if(without.faces, [](const Triangle& t) { return t[2] >= 6; });
  EXPECT_EQ(structure_errors(without, surface, 30, context).seam_spheres_wrong, 3);
}

// The axis of a coin of radius 1 and height 4/5, a prism of n sides taken for a cylinder: a disc around `middle`, which
// meets two frusta to the rims along a circle of seam spheres above the middles of the sides.
MedialMesh axis_of_a_coin(int n, double middle_z) {
  MedialMesh mesh{{{0, 0, middle_z}}, {0.4}, {SphereType::kSheet}, {}, {}};
  const double side = std::cos(std::numbers::pi / n);  // distance of the sides from the axis
  std::set<Edge> edges;
  const auto add = [&](Triangle t) {
    std::sort(t.begin(), t.end());
    mesh.faces.push_back(t);
    edges.insert({{t[0], t[1]}, {t[0], t[2]}, {t[1], t[2]}});
  };
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.5) / n;
    const Vec3 out{std::cos(angle), std::sin(angle), 0};
    for (const auto& [center, radius, type] : {std::tuple{out * (side - 0.4), 0.4, SphereType::kSeam},
                                               {out * side + Vec3{0, 0, 0.4}, 0.0, SphereType::kSharpEdge},
                                               {out * side - Vec3{0, 0, 0.4}, 0.0, SphereType::kSharpEdge}}) {
      mesh.centers.push_back(center);
      mesh.radii.push_back(radius);
      mesh.types.push_back(type);
    }
    const Index seam = 1 + 3 * k, next = 1 + 3 * ((k + 1) % n);
    add({0, seam, next});
    for (const Index rim : {1, 2}) {
      add({seam, next, seam + rim});
      add({next, seam + rim, next + rim});
    }
  }
  std::sort(mesh.faces.begin(), mesh.faces.end());
  mesh.edges.assign(edges.begin(), edges.end());
  return mesh;
}

TEST(StructureErrors, NoneOnTheAxisOfACoin) {
  const TriSurface surface = shapes::boundary(shapes::transformed(shapes::prism(1, 0.8, 48), [](Vec3 p) {
    return p - Vec3{0, 0, 0.4};
  }));
  Context context;
  const StructureErrors right = structure_errors(axis_of_a_coin(48, 0), surface, 30, context);
  EXPECT_EQ(right.seam_spheres, 48);
  EXPECT_EQ(right.seam_spheres_wrong, 0);
  EXPECT_EQ(right.sheet_spheres, 1);
  EXPECT_EQ(right.spikes, 0);
  EXPECT_EQ(structure_errors(axis_of_a_coin(48, 0.2), surface, 30, context).spikes, 1);
}

TEST(StructureErrors, SeamSpheresBesideTheirSeamAreWrong) {
  // The faces of the middle rectangle's seams are dragged into the rectangle, where spheres touch top and bottom only.
  Exact e = exact(oracle::box(1, 4, 5), 4);
  Index moved = 0;
  for (std::size_t v = 0; v < e.mesh.centers.size(); ++v) {
    Vec3& c = e.mesh.centers[v];
    if (e.mesh.types[v] != SphereType::kSeam || std::abs(c.x) > 1e-9 || std::abs(c.y) < 1.5 - 1e-9) continue;
    c.y *= 0.5;
    ++moved;
  }
  ASSERT_GT(moved, 10);
  const StructureErrors errors = errors_of(e);
  EXPECT_GE(errors.seam_spheres_wrong, moved / 2);
  EXPECT_GT(errors.mser(), 0.1);
}

TEST(StructureErrors, AMeshThatCutsAcrossSeamsIsWrong) {
  // A sheet sphere of the axis of a cube, and all in the rings around it, said to be seams.
  Exact e = exact(oracle::box(1, 1, 1), 3);
  Index claimed = 0;
  for (std::size_t v = 0; v < e.mesh.types.size(); ++v)
    if (e.mesh.types[v] == SphereType::kSheet) e.mesh.types[v] = SphereType::kSeam, ++claimed;
  const StructureErrors errors = errors_of(e);
  EXPECT_EQ(errors.seam_spheres_wrong, claimed);
  EXPECT_EQ(errors.sheet_spheres, 0);
}

TEST(StructureErrors, SeamSpheresAreNoJunctions) {
  Exact e = exact(oracle::box(1, 2, 3), 3);
  for (SphereType& type : e.mesh.types)
    if (type == SphereType::kSeam) type = SphereType::kJunction;
  const StructureErrors errors = errors_of(e);
  // Of the sheets of a seam even the spheres next to a true junction touch the seam's three faces only: none passes.
  EXPECT_EQ(errors.junction_spheres_wrong, errors.junction_spheres - 4);
}

TEST(StructureErrors, AFinOnASheetIsWrongAtBothEndsOfItsSeam) {
  Exact e = exact(oracle::box(1, 3, 3), 3);
  const auto in_the_middle = [&](Index v) {
    const Vec3& c = e.mesh.centers[static_cast<std::size_t>(v)];
    return std::abs(c.x) < 1e-9 && std::abs(c.y) < 0.8 && std::abs(c.z) < 0.8;
  };
  const auto edge = std::find_if(e.mesh.edges.begin(), e.mesh.edges.end(),
                                 [&](const Edge& f) { return in_the_middle(f[0]) && in_the_middle(f[1]); });
  ASSERT_NE(edge, e.mesh.edges.end());
  const auto [a, b] = *edge;
  const Vec3 middle =
      lerp(e.mesh.centers[static_cast<std::size_t>(a)], e.mesh.centers[static_cast<std::size_t>(b)], 0.5);
  const auto tip = static_cast<Index>(e.mesh.centers.size());
  e.mesh.centers.push_back({0.2, middle.y, middle.z});
  e.mesh.radii.push_back(0.3);
  e.mesh.types.push_back(SphereType::kSheet);
  for (const Index v : {a, b}) {
    e.mesh.types[static_cast<std::size_t>(v)] = SphereType::kSeam;
    e.mesh.edges.push_back({v, tip});
  }
  e.mesh.faces.push_back({a, b, tip});
  std::sort(e.mesh.edges.begin(), e.mesh.edges.end());
  std::sort(e.mesh.faces.begin(), e.mesh.faces.end());
  EXPECT_EQ(errors_of(e).seam_spheres_wrong, 2);
}

TEST(StructureErrors, AShiftedSphereIsASpike) {
  Exact e = exact(oracle::box(1, 3, 3), 3);
  const auto inner = std::find_if(e.mesh.centers.begin(), e.mesh.centers.end(), [](const Vec3& c) {
    return std::abs(c.x) < 1e-9 && std::abs(c.y) < 0.5 && std::abs(c.z) < 0.5;
  });
  ASSERT_NE(inner, e.mesh.centers.end());
  const auto shifted = [&](double x) {
    inner->x = x;
    e.mesh.radii[static_cast<std::size_t>(inner - e.mesh.centers.begin())] = 0.5 - x;
    return errors_of(e).spikes;
  };
  EXPECT_EQ(shifted(0), 0);
  EXPECT_EQ(shifted(0.02), 0);  // within ten shifts by a hundredth of the radius
  EXPECT_EQ(shifted(0.06), 1);
  EXPECT_EQ(shifted(0.3), 1);
}

TEST(StructureErrors, EndsOfSmoothSheetsAndTouchingCirclesAreNoSpikes) {
  // A triangle on the axis of a cylinder, another in the focal plane of an ellipsoid up to the end of its axis.
  Context context;
  MedialMesh mesh{{{0, 0, 1.4}, {0, 0, 1.5}, {0.001, 0, 1.6}}, {1, 1, 1}, {}, {{0, 1}, {0, 2}, {1, 2}}, {{0, 1, 2}}};
  mesh.types.resize(3);
  EXPECT_EQ(structure_errors(mesh, shapes::boundary(shapes::prism(1, 3, 48)), 30, context).spikes, 0);

  // Half axes 2, 1, 2: the disc of radius 3/2 around the y axis, with radius sqrt(1 - rho^2 / 3).
  const TriSurface ellipsoid = shapes::ellipsoid({2, 1, 2}, 48);
  mesh.centers = {{1.5, 0, 0}, {1.3, 0, 0.2}, {1.2, 0, -0.2}};
  for (std::size_t v = 0; v < 3; ++v) {
    const double rho2 = norm2(mesh.centers[v]);
    mesh.radii[v] = std::sqrt(1 - rho2 / 3);
  }
  const StructureErrors errors = structure_errors(mesh, ellipsoid, 30, context);
  EXPECT_EQ(errors.sheet_spheres, 3);
  EXPECT_EQ(errors.spikes, 0);
}

TEST(StructureErrors, SphereOfAnEndThatIsTooFarOutIsASpike) {
  Context context;
  MedialMesh mesh{
      {{1.7, 0, 0}, {1.3, 0, 0.2}, {1.2, 0, -0.2}}, {0.3, 0.65, 0.7}, {}, {{0, 1}, {0, 2}, {1, 2}}, {{0, 1, 2}}};
  mesh.types.resize(3);
  EXPECT_EQ(structure_errors(mesh, shapes::ellipsoid({2, 1, 2}, 48), 30, context).spikes, 1);
}

TEST(StructureErrors, SameWhateverTheThreadsAndTheOrientation) {
  Exact e = exact(oracle::random_convex_polyhedron(3, 14), 3);
  for (std::size_t v = 0; v < e.mesh.centers.size(); ++v) {
    KeyedRandom random(1, 1, v);
    e.mesh.centers[v] += Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5} * 0.2;
  }
  const StructureErrors one = errors_of(e, 1), two = errors_of(e, 2);
  for (Triangle& t : e.surface.triangles) std::swap(t[1], t[2]);
  const StructureErrors turned = errors_of(e);
  EXPECT_GT(one.seam_spheres_wrong, 0);
  EXPECT_GT(one.spikes, 0);
  for (const StructureErrors& other : {two, turned}) {
    EXPECT_EQ(one.seam_spheres_wrong, other.seam_spheres_wrong);
    EXPECT_EQ(one.junction_spheres_wrong, other.junction_spheres_wrong);
    EXPECT_EQ(one.spikes, other.spikes);
  }
}

TEST(StructureErrors, RefusesWhatHasNoSurface) {
  Context context;
  EXPECT_THROW(structure_errors(MedialMesh{}, TriSurface{}, 30, context), Error);
  EXPECT_THROW(medialness(MedialMesh{}, TriSurface{}, 100, context), Error);
  EXPECT_EQ(structure_errors(MedialMesh{}, oracle::surface_of(oracle::box(1, 1, 1)), 30, context).mser(), 0);
}

TEST(Medialness, ZeroOnTheExactAxisOfConvexSolids) {
  for (const auto& solid : solids()) {
    const Exact e = exact(solid, 0);
    Context context;
    const Medialness m = medialness(e.mesh, e.surface, 2000, context);
    EXPECT_LE(m.max, 1e-9);
    EXPECT_LE(m.mean, m.max);
  }
}

TEST(Medialness, InClosedForm) {
  // The mid triangle of a plate of thickness 2, with radii 1, 1, 0.4: the error rises linearly to 0.6 at one corner;
  // mean over the triangle 0.2, in its middle 0.2.
  const TriSurface plate = oracle::surface_of(oracle::box(20, 20, 2));
  MedialMesh mesh{{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}}, {1, 1, 0.4}, {}, {{0, 1}, {0, 2}, {1, 2}}, {{0, 1, 2}}};
  Context context;
  const Medialness m = medialness(mesh, plate, 20000, context);
  EXPECT_NEAR(m.mean, 0.2, 1e-3);
  EXPECT_GT(m.max, 0.59);
  EXPECT_LE(m.max, 0.6);
  EXPECT_NEAR(medialness(mesh, plate, 1, context).max, 0.2, 0.1);
  mesh.faces.clear();
  EXPECT_EQ(medialness(mesh, plate, 1000, context).max, 0);
}

}  // namespace
}  // namespace matstruct
