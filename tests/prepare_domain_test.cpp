// prepare_domain(): what it computes on solids with known answers, and what it refuses.
#include "prepare/domain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <random>

#include <matstruct/error.h>
#include <matstruct/io.h>

#include "base/index.h"
#include "shapes.h"
#include "solids.h"

namespace matstruct {
namespace {

Domain prepare(const TetMesh& mesh) {
  Context context;
  return prepare_domain(mesh, {}, context);
}

std::string refusal(const TetMesh& mesh) {
  try {
    prepare(mesh);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expect_mentions(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " is not in: " << text;
}

Index lines_of_kind(const Features& features, EdgeKind kind) {
  return static_cast<Index>(std::count_if(features.lines.begin(), features.lines.end(),
                                          [&](const FeatureLine& line) { return line.kind == kind; }));
}

// The same solid with its vertices, tets and tet corners in another order.
TetMesh shuffled(const TetMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Index> id(mesh.vertices.size());
  std::iota(id.begin(), id.end(), 0);
  std::shuffle(id.begin(), id.end(), random);
  TetMesh result{.vertices = mesh.vertices, .tets = mesh.tets};
  for (std::size_t v = 0; v < id.size(); ++v) result.vertices[uz(id[v])] = mesh.vertices[v];
  for (Tetrahedron& tet : result.tets) {
    for (Index& v : tet) v = id[uz(v)];
    std::shuffle(tet.begin(), tet.end(), random);
  }
  std::shuffle(result.tets.begin(), result.tets.end(), random);
  return result;
}

TEST(Domain, KnownShapesHaveTheirVolumeTopologyAndFeatures) {
  for (const shapes::Shape& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const Domain domain = prepare(shape.mesh);
    EXPECT_EQ(domain.topology, shape.topology);
    const double scale = domain.frame.scale;
    EXPECT_NEAR(domain.volume / (scale * scale * scale), shape.volume, 1e-12 * shape.volume);
    EXPECT_EQ(lines_of_kind(domain.features, EdgeKind::kConvex), shape.convex_lines);
    EXPECT_EQ(lines_of_kind(domain.features, EdgeKind::kConcave), shape.concave_lines);
    EXPECT_EQ(count(domain.features.corners), shape.corners);
  }
}

TEST(Domain, OrderOfTheInputDoesNotMatter) {
  for (const shapes::Shape& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const Domain domain = prepare(shuffled(shape.mesh, 7));
    EXPECT_EQ(domain.topology, shape.topology);
    EXPECT_EQ(count(domain.surface.triangles), count(shapes::boundary(shape.mesh).triangles));
    EXPECT_EQ(lines_of_kind(domain.features, EdgeKind::kConvex), shape.convex_lines);
    EXPECT_EQ(lines_of_kind(domain.features, EdgeKind::kConcave), shape.concave_lines);
    EXPECT_EQ(count(domain.features.corners), shape.corners);
  }
}

TEST(Domain, AdjacencyIsMutualAndTrianglesAreFacets) {
  for (const shapes::Shape& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const Domain d = prepare(shape.mesh);
    for (Index t = 0; t < count(d.solid.tets); ++t)
      for (std::size_t k = 0; k < 4; ++k) {
        const Index other = d.tet_neighbors[uz(t)][k], triangle = d.tet_triangles[uz(t)][k];
        ASSERT_NE(other == kInvalid, triangle == kInvalid);
        if (other != kInvalid) {
          const auto& back = d.tet_neighbors[uz(other)];
          ASSERT_EQ(std::count(back.begin(), back.end(), t), 1);
          continue;
        }
        ASSERT_EQ(d.triangle_tets[uz(triangle)], t);
        Tetrahedron tet = d.solid.tets[uz(t)];
        for (const Index v : d.surface.triangles[uz(triangle)]) {
          ASSERT_NE(v, tet[k]);
          ASSERT_EQ(std::count(tet.begin(), tet.end(), v), 1);
          ASSERT_EQ(d.surface.vertices[uz(v)], d.solid.vertices[uz(v)]);
        }
      }
  }
}

TEST(Domain, TrianglesLookOutwardAndMeetTheirNeighbours) {
  for (const shapes::Shape& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const Domain d = prepare(shape.mesh);
    for (Index t = 0; t < count(d.surface.triangles); ++t) {
      const Triangle& v = d.surface.triangles[uz(t)];
      const Vec3& p = d.surface.vertices[uz(v[0])];
      EXPECT_NEAR(norm(d.triangle_normals[uz(t)]), 1, 1e-15);
      for (const Index w : d.solid.tets[uz(d.triangle_tets[uz(t)])])
        EXPECT_LE(dot(d.solid.vertices[uz(w)] - p, d.triangle_normals[uz(t)]), 1e-15);
      for (std::size_t k = 0; k < 3; ++k) {
        const Triangle& other = d.surface.triangles[uz(d.triangle_neighbors[uz(t)][k])];
        for (const Index end : {v[(k + 1) % 3], v[(k + 2) % 3]})
          EXPECT_EQ(std::count(other.begin(), other.end(), end), 1);
      }
    }
  }
}

TEST(Domain, FrameScalesByPowersOfTwoAndMapsBack) {
  for (const double unit : {1e-6, 1.0, 3.7, 1e6}) {
    SCOPED_TRACE(unit);
    const TetMesh mesh = shapes::transformed(shapes::box({1, 2, 3}), [&](Vec3 p) {
      return p * unit + Vec3{5, -7, 2} * unit;
    });
    const Domain domain = prepare(mesh);
    int exponent = 0;
    EXPECT_EQ(std::frexp(domain.frame.scale, &exponent), 0.5);
    EXPECT_GT(domain.diagonal, 0.5);
    EXPECT_LE(domain.diagonal, 1);
    EXPECT_NEAR(domain.diagonal / domain.frame.scale, std::sqrt(14.0) * unit, 1e-14 * unit);
    for (const Vec3& p : mesh.vertices)
      EXPECT_LE(distance(domain.frame.to_input(domain.frame.to_internal(p)), p), 1e-14 * unit);
  }
}

TEST(Frame, FollowsTheSolid) {
  // Without symmetry, so that one pose is the greatest: the moved solid has the internal points of the unmoved one.
  const TetMesh mesh = shapes::transformed(shapes::l_profile(3), [](Vec3 p) { return Vec3{p.x, 1.3 * p.y, p.z}; });
  const Domain domain = prepare(mesh);
  const double c = std::cos(0.7), s = std::sin(0.7);
  const auto turned = [&](const Vec3& p) {
    const Vec3 q{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    return Vec3{q.x, c * q.y - s * q.z, s * q.y + c * q.z};
  };
  for (const double unit : {1.0, 1024.0}) {
    const Domain moved = prepare(shapes::transformed(mesh, [&](Vec3 p) { return turned(p) * unit + Vec3{3, 4, 5}; }));
    EXPECT_NEAR(moved.diagonal, domain.diagonal, 1e-14);
    ASSERT_EQ(moved.solid.vertices.size(), domain.solid.vertices.size());
    for (std::size_t v = 0; v < moved.solid.vertices.size(); ++v)
      EXPECT_NEAR(distance(moved.solid.vertices[v], domain.solid.vertices[v]), 0, 1e-14);
  }
}

TEST(Frame, RoundedCoordinatesAreTheSameBitsForAMovedSolid) {
  const TetMesh mesh = shapes::transformed(shapes::l_profile(3), [](Vec3 p) { return Vec3{p.x, 1.3 * p.y, p.z}; });
  const auto prepared = [](const TetMesh& solid) {
    Context context;
    return prepare_domain(solid, {}, context, nullptr, Coordinates::kRounded);
  };
  const Domain domain = prepared(mesh);
  EXPECT_NEAR(domain.diagonal, 1, 1e-8);
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (const double unit : {1.0, 1e-3, 1e3}) {
    SCOPED_TRACE(unit);
    const Domain moved = prepared(shapes::transformed(mesh, [&](Vec3 p) {
      return Vec3{c * p.x - s * p.y, s * p.x + c * p.y, p.z} * unit + Vec3{300, -400, 500} * unit;
    }));
    EXPECT_EQ(moved.solid.vertices, domain.solid.vertices);
    for (std::size_t v = 0; v < moved.unrounded.size(); ++v)
      EXPECT_NEAR(distance(moved.unrounded[v], domain.unrounded[v]), 0, 1e-12);
  }
}

TEST(Frame, IsNotRoundedWhereThatWouldTurnATetOver) {
  TetMesh mesh = shapes::box({1, 1, 1});
  mesh.vertices.push_back({3, 0, 0});
  const Index low = count(mesh.vertices);
  for (const Vec3& p : {Vec3{4, 0, 0}, Vec3{3, 1, 0}, Vec3{3, 0, 1e-10}}) mesh.vertices.push_back(p);
  mesh.tets.push_back({low - 1, low, low + 1, low + 2});
  Context context;
  const Domain domain = prepare_domain(mesh, {}, context, nullptr, Coordinates::kRounded);
  EXPECT_EQ(domain.frame.grid, 0);
  EXPECT_EQ(domain.topology.b0, 2);
}

TEST(Frame, IsRightHandedAndExactForAnyBox) {
  for (const Vec3& size : {Vec3{1, 2, 3}, Vec3{3, 2, 1}, Vec3{1, 1, 1}, Vec3{2, 2, 5}, Vec3{7, 1, 7}}) {
    const TetMesh mesh = shapes::box(size);
    const Domain domain = prepare(mesh);
    const auto& axes = domain.frame.axes;
    EXPECT_EQ(cross(axes[0], axes[1]), axes[2]);
    for (const Vec3& axis : axes) EXPECT_EQ(std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z), 1);
    for (const Vec3& p : mesh.vertices) EXPECT_EQ(domain.frame.to_input(domain.frame.to_internal(p)), p);
  }
}

TEST(Frame, KeepsTheAxesOfAShapeWithoutPlanes) {
  const Domain domain = prepare(shapes::star(shapes::ellipsoid({3, 2, 1}, 24)));
  EXPECT_EQ(domain.frame.axes[0], (Vec3{1, 0, 0}));
  EXPECT_EQ(domain.frame.axes[1], (Vec3{0, 1, 0}));
}

TEST(Domain, BoundaryVerticesComeFirst) {
  const Domain domain = prepare(shapes::pyramid());  // the centre, last in the input, is the only inner vertex
  EXPECT_EQ(count(domain.surface.vertices), 5);
  EXPECT_EQ(count(domain.solid.vertices), 6);
  TetMesh first = shapes::pyramid();
  std::rotate(first.vertices.begin(), first.vertices.end() - 1, first.vertices.end());
  for (Tetrahedron& tet : first.tets)
    for (Index& v : tet) v = (v + 1) % 6;
  const Domain rotated = prepare(first);
  EXPECT_EQ(rotated.solid.vertices, domain.solid.vertices);
  EXPECT_EQ(rotated.surface.triangles, domain.surface.triangles);
}

TEST(Domain, NegativeTetsAreFlippedWithAWarning) {
  TetMesh mesh = shapes::box({1, 1, 1});
  std::swap(mesh.tets[2][0], mesh.tets[2][1]);
  Context context;
  const Domain domain = prepare_domain(mesh, {}, context);
  EXPECT_EQ(domain.topology, (Betti{1, 0, 0}));
  ASSERT_EQ(context.warnings.size(), 1u);
  expect_mentions(context.warnings[0], {"1 of 6 tets", "flipped"});
}

TEST(Domain, EqualVerticesAreWeldedAndUnusedOnesDropped) {
  TetMesh soup{.vertices = {{100, 100, 100}}, .tets = {}};
  const TetMesh box = shapes::box({1, 2, 3}, 2, 2, 2);
  for (const Tetrahedron& tet : box.tets) {
    const Index first = count(soup.vertices);
    for (const Index v : tet) soup.vertices.push_back(box.vertices[uz(v)]);
    soup.tets.push_back({first, first + 1, first + 2, first + 3});
  }
  const Domain domain = prepare(soup);
  EXPECT_EQ(count(domain.solid.vertices), count(box.vertices));
  EXPECT_EQ(domain.topology, (Betti{1, 0, 0}));
  EXPECT_EQ(domain.frame.offset, (Vec3{0.5, 1, 1.5}));
}

// Prepares a solid that must be cut apart, with one warning about it that contains the words.
Domain cut_apart(const TetMesh& mesh, const std::vector<std::string>& words) {
  Context context;
  Domain domain = prepare_domain(mesh, {}, context);
  EXPECT_EQ(context.warnings.size(), 1u);
  expect_mentions(context.warnings.at(0), {"cut apart"});
  expect_mentions(context.warnings.at(0), words);
  const double unit = domain.frame.scale;
  EXPECT_NEAR(domain.volume / (unit * unit * unit), shapes::volume(mesh), 1e-12);
  return domain;
}

std::ptrdiff_t vertices_at(const Domain& domain, const Vec3& input) {
  const auto& points = domain.surface.vertices;
  return std::count(points.begin(), points.end(), domain.frame.to_internal(input));
}

const std::vector<double> kTwo = {0, 1, 2}, kThree = {0, 1, 2, 3}, kFour = {0, 1, 2, 3, 4};

TEST(DomainCuts, BoxesThatShareAnEdge) {
  const TetMesh mesh = shapes::grid(kTwo, kTwo, {0, 1}, [](int i, int j, int) { return i == j; });
  const Domain domain = cut_apart(mesh, {"2 vertices were copied", "(1, 1, "});
  EXPECT_EQ(domain.topology, (Betti{2, 0, 0}));
  EXPECT_EQ(vertices_at(domain, {1, 1, 0}), 2);
  EXPECT_EQ(count(domain.features.lines), 23);  // the shared edge is one line
  EXPECT_EQ(cut_apart(shapes::positive(shuffled(mesh, 5)), {}).topology, (Betti{2, 0, 0}));
}

TEST(DomainCuts, BoxesThatShareAVertex) {
  const auto diagonal = [](int i, int j, int k) { return i == j && j == k; };
  const TetMesh mesh = shapes::grid(kTwo, kTwo, kTwo, diagonal);
  EXPECT_EQ(cut_apart(mesh, {"1 vertex was copied", "vertex 3 (1, 1, 1)"}).topology, (Betti{2, 0, 0}));
  const TetMesh tet = shapes::tetrahedron();
  const TetMesh two = shapes::together(tet, shapes::transformed(tet, [](Vec3 q) { return -q; }));
  EXPECT_EQ(cut_apart(two, {"vertex 0 (0, 0, 0)"}).topology, (Betti{2, 0, 0}));
}

TEST(DomainCuts, EightBoxesAroundAVertexOfWhichNoneShareAFace) {
  const auto checkered = [](int i, int j, int k) { return (i + j + k) % 2 == 0; };
  const Domain domain = cut_apart(shapes::grid(kTwo, kTwo, kTwo, checkered), {});
  EXPECT_EQ(domain.topology, (Betti{4, 0, 0}));
  EXPECT_EQ(vertices_at(domain, {1, 1, 1}), 4);
}

TEST(DomainCuts, ARingWhoseEndsTouch) {
  const auto ring = [](int i, int j, int) { return !(i == 1 && j == 1) && !(i == 0 && j == 0); };
  EXPECT_EQ(cut_apart(shapes::grid(kThree, kThree, {0, 1}, ring), {}).topology, (Betti{1, 0, 0}));
}

TEST(DomainCuts, AnEdgeWhoseEndsStayCommon) {
  // Two floors that two columns connect; the columns touch along an edge from floor to floor.
  const auto columns = [](int i, int j, int k) { return k != 1 || i == j; };
  const TetMesh mesh = shapes::grid(kTwo, kTwo, kThree, columns);
  const Domain domain = cut_apart(mesh, {"1 vertex was copied", "a new vertex (1, 1, 1.5)"});
  EXPECT_EQ(domain.topology, (Betti{1, 1, 0}));
  EXPECT_EQ(vertices_at(domain, {1, 1, 1.5}), 2);
  EXPECT_EQ(vertices_at(domain, {1, 1, 1}), 1);
  EXPECT_EQ(cut_apart(shapes::positive(shuffled(mesh, 9)), {}).topology, (Betti{1, 1, 0}));
}

TEST(DomainCuts, ManyEdgesWhoseEndsStayCommon) {
  // A checkerboard of columns between two floors touches itself along nine edges: nothing but corners between floors.
  const auto columns = [](int i, int j, int k) { return k != 1 || (i + j) % 2 == 0; };
  const Domain domain = cut_apart(shapes::grid(kFour, kFour, kThree, columns), {"9 vertices were copied"});
  EXPECT_EQ(domain.topology, (Betti{1, 7, 0}));  // eight columns
}

TEST(DomainCuts, VoidsThatTouchAlongAnEdge) {
  const auto around_voids = [](int i, int j, int k) { return !(k == 1 && i == j && (i == 1 || i == 2)); };
  EXPECT_EQ(cut_apart(shapes::grid(kFour, kFour, kThree, around_voids), {}).topology, (Betti{1, 0, 1}));
}

TEST(DomainCuts, WhatWeldingHasJoined) {
  TetMesh soup;
  const TetMesh mesh = shapes::grid(kTwo, kTwo, {0, 1}, [](int i, int j, int) { return i == j; });
  for (const Tetrahedron& tet : mesh.tets) {
    const Index first = count(soup.vertices);
    for (const Index v : tet) soup.vertices.push_back(mesh.vertices[uz(v)]);
    soup.tets.push_back({first, first + 1, first + 2, first + 3});
  }
  EXPECT_EQ(cut_apart(soup, {"2 vertices were copied"}).topology, (Betti{2, 0, 0}));
}

TEST(ModelsDomain, SolidOfExtrusionsThatTouchIsCutApart) {
  const auto file = std::filesystem::path(MATSTRUCT_SHARED_DATA) / "tet" / "not_convex.msh";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the shared models are not here";
  const Domain domain = cut_apart(read_tet_mesh(file), {"29 vertices"});
  EXPECT_EQ(domain.topology.b2, 0);
}

TEST(DomainRefuses, EmptyAndBrokenElements) {
  expect_mentions(refusal({}), {"no tetrahedra"});
  TetMesh mesh = shapes::tetrahedron();
  mesh.vertices[2].y = std::numeric_limits<double>::quiet_NaN();
  expect_mentions(refusal(mesh), {"vertex 2", "not a finite number", "nan"});
  mesh = shapes::tetrahedron();
  mesh.vertices[0].z = -std::numeric_limits<double>::infinity();
  expect_mentions(refusal(mesh), {"vertex 0", "inf"});
  mesh = shapes::tetrahedron();
  mesh.tets[0][3] = 4;
  expect_mentions(refusal(mesh), {"tet 0", "vertex 4", "0 to 3"});
  mesh.tets[0][3] = -1;
  expect_mentions(refusal(mesh), {"tet 0", "vertex -1"});
}

TEST(DomainRefuses, FlatTetsWithTheirCoordinatesInInputUnits) {
  TetMesh mesh = shapes::box({1, 1, 1});
  mesh.vertices.push_back({0, 0, 2});
  mesh.tets.push_back({0, 1, 0, 8});
  expect_mentions(refusal(mesh), {"tet 6", "vertices 0 1 0 8", "zero volume", "(0, 0, 2)"});
  mesh = {.vertices = {{1000, 0, 0}, {2000, 0, 0}, {1000, 1000, 0}, {2000, 1000, 0}, {0, 0, 1000}},
          .tets = {{0, 1, 2, 4}, {0, 1, 2, 3}}};
  expect_mentions(refusal(mesh), {"tet 1", "zero volume", "(2000, 1000, 0)"});
}

TEST(DomainRefuses, ExtremeUnits) {
  const auto scaled = [](double s) {
    return shapes::transformed(shapes::tetrahedron(), [&](Vec3 p) { return p * s; });
  };
  EXPECT_EQ(prepare(scaled(1e-200)).topology, (Betti{1, 0, 0}));
  EXPECT_EQ(prepare(scaled(1e200)).topology, (Betti{1, 0, 0}));
  TetMesh huge = shapes::tetrahedron();
  for (Vec3& p : huge.vertices) p = (p * 2 - Vec3{1, 1, 1}) * 1.5e308;
  expect_mentions(refusal(huge), {"extent", "unit"});
}

TEST(DomainRefuses, FacetsSharedByThreeTetsAndOverlaps) {
  TetMesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 1, 1}},
               .tets = {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}}};
  expect_mentions(refusal(mesh), {"3 tets", "tets 0 and 2", "vertex 1 (1, 0, 0)"});
  mesh.tets.erase(mesh.tets.begin() + 1);
  expect_mentions(refusal(mesh), {"tets 0 and 1 overlap", "same side"});
}

TEST(DomainRefuses, VoidsThatTouchInAVertex) {
  const auto around_voids = [](int i, int j, int k) { return !(i == j && j == k && (i == 1 || i == 2)); };
  const std::vector<double> p = {0, 1, 2, 3, 4};
  expect_mentions(refusal(shapes::grid(p, p, p, around_voids)), {"pinched at vertex", "(2, 2, 2)", "2 fans"});
}

TEST(DomainRefuses, BadOptions) {
  Context context;
  EXPECT_THROW(prepare_domain(shapes::tetrahedron(), {.gamma = -1}, context), Error);
}

TEST(Domain, CanBeCancelled) {
  Context context;
  context.progress = [](const std::string&, double) { return false; };
  EXPECT_THROW(prepare_domain(shapes::tetrahedron(), {}, context), Cancelled);
}

}  // namespace
}  // namespace matstruct
