// tetrahedralise(): the surface's triangles come back as facets, nesting is found, bad surfaces and bad meshers are
// answered with a sentence.
#include "prepare/tetrahedralise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <thread>

#include <matstruct/error.h>
#include <matstruct/io.h>

#include "base/index.h"
#include "prepare/domain.h"
#include "prepare/self_intersection.h"
#include "shapes.h"
#include "temp_folder.h"

namespace matstruct {
namespace {

namespace fs = std::filesystem;

std::string refusal(const TriSurface& surface) {
  Context context;
  try {
    tetrahedralise(surface, context);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expect_mentions(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " is not in: " << text;
}

using Corners = std::array<std::array<double, 3>, 3>;

// Triangles by their coordinates, each starting at its least corner, sorted: equal for equal oriented surfaces.
std::vector<Corners> by_coordinates(const TriSurface& surface) {
  std::vector<Corners> result;
  for (const Triangle& t : surface.triangles) {
    Corners c;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = surface.vertices[uz(t[k])];
      c[k] = {p.x, p.y, p.z};
    }
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    result.push_back(c);
  }
  std::sort(result.begin(), result.end());
  return result;
}

TriSurface soup_of(const TriSurface& surface) {
  TriSurface soup;
  for (const Triangle& t : surface.triangles) {
    const Index first = count(soup.vertices);
    for (const Index v : t) soup.vertices.push_back(surface.vertices[uz(v)]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TriSurface together(TriSurface a, const TriSurface& b) {
  const Index shift = count(a.vertices);
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

TriSurface cube(double low, double high) {
  return shapes::boundary(shapes::transformed(shapes::box({1, 1, 1}), [=](Vec3 p) {
    return Vec3{low, low, low} + p * (high - low);
  }));
}

TEST(Tetrahedralise, KeepsTheSurfaceAndFillsItsSolid) {
  for (const shapes::Shape& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const TriSurface surface = shapes::boundary(shape.mesh);
    Context context;
    const TetMesh solid = tetrahedralise(surface, context);
    EXPECT_EQ(by_coordinates(shapes::boundary(solid)), by_coordinates(surface));
    EXPECT_NEAR(shapes::volume(solid), shape.volume, 1e-12 * shape.volume);
    EXPECT_EQ(prepare_domain(solid, {}, context).topology, shape.topology);
    EXPECT_TRUE(context.warnings.empty());
  }
}

TEST(Tetrahedralise, OrientationOfTheInputDoesNotMatter) {
  const TriSurface surface = shapes::boundary(shapes::box_in_box());
  TriSurface mixed = surface;
  std::mt19937 random(3);
  for (Triangle& t : mixed.triangles)
    if (random() % 2) std::swap(t[0], t[1]);
  Context context;
  EXPECT_EQ(by_coordinates(shapes::boundary(tetrahedralise(mixed, context))), by_coordinates(surface));
}

TEST(Tetrahedralise, NestsShellsToAnyDepth) {
  TriSurface nested;
  double expected = 0;
  for (int k = 1; k <= 5; ++k) {  // material between 5 and 4, 3 and 2, and inside 1
    nested = together(nested, cube(-k, k));
    expected += (k % 2 ? 1 : -1) * std::pow(2.0 * k, 3);
  }
  Context context;
  const TetMesh solid = tetrahedralise(nested, context);
  EXPECT_NEAR(shapes::volume(solid), expected, 1e-9);
  EXPECT_EQ(prepare_domain(solid, {}, context).topology, (Betti{3, 0, 2}));
}

TEST(Tetrahedralise, SameInputSameResult) {
  const TriSurface surface = shapes::boundary(shapes::torus(3, 1, 12, 8));
  Context context;
  const TetMesh first = tetrahedralise(surface, context), second = tetrahedralise(surface, context);
  EXPECT_EQ(first.vertices, second.vertices);
  EXPECT_EQ(first.tets, second.tets);
}

TEST(Tetrahedralise, UnitsDoNotMatter) {
  for (const double unit : {1e-6, 1e6}) {
    TriSurface surface = shapes::boundary(shapes::plate_with_hole());
    for (Vec3& p : surface.vertices) p = (p + Vec3{10, 20, 30}) * unit;
    Context context;
    EXPECT_EQ(prepare_domain(tetrahedralise(surface, context), {}, context).topology, (Betti{1, 1, 0}));
  }
}

TEST(Tetrahedralise, WeldsSoup) {
  const TriSurface surface = shapes::boundary(shapes::l_profile());
  Context context;
  EXPECT_EQ(by_coordinates(shapes::boundary(tetrahedralise(soup_of(surface), context))), by_coordinates(surface));
  EXPECT_TRUE(context.warnings.empty());
}

TEST(Tetrahedralise, WeldsWithinToleranceButNoFarther) {
  const auto jittered = [](double size) {
    TriSurface soup = soup_of(shapes::boundary(shapes::l_profile()));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shift(-size, size);
    for (Vec3& p : soup.vertices) p += {shift(random), shift(random), shift(random)};
    return soup;
  };
  Context context;
  EXPECT_NEAR(shapes::volume(tetrahedralise(jittered(1e-8), context)), 9, 1e-6);
  ASSERT_EQ(context.warnings.size(), 1u);
  expect_mentions(context.warnings[0], {"vertices", "welded"});
  expect_mentions(refusal(jittered(1e-3)), {"open", "edges"});
}

TEST(Tetrahedralise, DropsUselessTriangles) {
  TriSurface surface = shapes::boundary(shapes::box({1, 1, 1}));
  const auto clean = by_coordinates(surface);
  surface.triangles.push_back(surface.triangles[3]);
  surface.triangles.push_back({1, 1, 4});
  Context context;
  EXPECT_EQ(by_coordinates(shapes::boundary(tetrahedralise(surface, context))), clean);
  ASSERT_EQ(context.warnings.size(), 1u);
  expect_mentions(context.warnings[0], {"2 triangles"});
}

TEST(Tetrahedralise, RemovesTrianglesWithoutArea) {
  // Vertices 8 and 9 lie on an edge that the lower face has in one piece; two caps, one across the other, fill the gap.
  const TriSurface box = {.vertices = {{0, 0, 0},
                                       {4, 0, 0},
                                       {4, 1, 0},
                                       {0, 1, 0},
                                       {0, 0, 1},
                                       {4, 0, 1},
                                       {4, 1, 1},
                                       {0, 1, 1},
                                       {1, 0, 0},
                                       {2, 0, 0}},
                          .triangles = {{0, 3, 2},
                                        {0, 2, 1},
                                        {4, 5, 6},
                                        {4, 6, 7},
                                        {1, 2, 6},
                                        {1, 6, 5},
                                        {2, 3, 7},
                                        {2, 7, 6},
                                        {3, 0, 4},
                                        {3, 4, 7},
                                        {0, 8, 4},
                                        {8, 9, 4},
                                        {9, 5, 4},
                                        {9, 1, 5},  // the front face, with 8 and 9 on its lower edge
                                        {0, 9, 8},
                                        {0, 1, 9}}};  // caps between it and the lower face
  Context context;
  const TetMesh solid = tetrahedralise(box, context);
  EXPECT_NEAR(shapes::volume(solid), 4, 1e-14);
  EXPECT_EQ(count(shapes::boundary(solid).triangles), 16);
  ASSERT_EQ(context.warnings.size(), 1u);
  expect_mentions(context.warnings[0], {"of zero area"});
}

TEST(Tetrahedralise, SurfacesThatTouchInAVertexStayWhole) {
  const auto diagonal = [](int i, int j, int k) { return i == j && j == k; };
  const TriSurface surface = shapes::boundary(shapes::grid({0, 1, 2}, {0, 1, 2}, {0, 1, 2}, diagonal));
  Context context;
  const TetMesh solid = tetrahedralise(surface, context);
  EXPECT_EQ(by_coordinates(shapes::boundary(solid)), by_coordinates(surface));
  EXPECT_EQ(count(solid.vertices), 15);
  EXPECT_EQ(prepare_domain(solid, {}, context).topology, (Betti{2, 0, 0}));
}

TEST(Tetrahedralise, ACavityMayTouchItsShellInAVertex) {
  // A tetrahedron inside a cube, with one vertex at a corner of the cube: the first one of both.
  TriSurface surface = cube(0, 1);
  const TriSurface inner = shapes::boundary(shapes::transformed(shapes::tetrahedron(), [](Vec3 p) {
    return Vec3{0.3 * p.x + 0.2 * p.y + 0.1 * p.z, 0.1 * p.x + 0.3 * p.y + 0.2 * p.z,
                0.2 * p.x + 0.1 * p.y + 0.3 * p.z};
  }));
  surface = together(inner, surface);
  Context context;
  const TetMesh solid = tetrahedralise(surface, context);
  EXPECT_EQ(count(solid.vertices), 11);
  const double det = 0.3 * (0.09 - 0.02) - 0.2 * (0.03 - 0.04) + 0.1 * (0.01 - 0.06);
  EXPECT_NEAR(shapes::volume(solid), 1 - det / 6, 1e-14);
}

TEST(TetrahedraliseRefuses, BrokenElements) {
  expect_mentions(refusal({}), {"no triangles"});
  TriSurface surface = cube(0, 1);
  surface.vertices[uz(surface.triangles[0][0])].x = std::numeric_limits<double>::quiet_NaN();
  expect_mentions(refusal(surface), {"not a finite number", "nan"});
  surface = cube(0, 1);
  surface.triangles[5][1] = 8;
  expect_mentions(refusal(surface), {"triangle 5", "vertex 8", "0 to 7"});
}

TEST(TetrahedraliseRefuses, OpenSurfaces) {
  TriSurface surface = cube(0, 1);
  surface.triangles.pop_back();
  expect_mentions(refusal(surface), {"open", "3 edges", "(1, 1, 1)"});
}

TEST(TetrahedraliseRefuses, EdgesWithManyTriangles) {
  const auto diagonal = [](int i, int j, int) { return i == j; };
  expect_mentions(refusal(shapes::boundary(shapes::grid({0, 1, 2}, {0, 1, 2}, {0, 1}, diagonal))),
                  {"more than two triangles", "1 edge", "(1, 1, 0)", "(1, 1, 1)"});
}

TEST(TetrahedraliseRefuses, OneSidedSurfaces) {
  TriSurface projective_plane{// the projective plane with 6 vertices, put anywhere in space
                              .vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 2, 3}, {3, 1, 2}},
                              .triangles = {{0, 1, 2},
                                            {0, 2, 3},
                                            {0, 3, 4},
                                            {0, 4, 5},
                                            {0, 5, 1},
                                            {1, 2, 4},
                                            {2, 3, 5},
                                            {3, 4, 1},
                                            {4, 5, 2},
                                            {5, 1, 3}}};
  expect_mentions(refusal(projective_plane), {"cannot be oriented", "one-sided"});
}

TEST(TetrahedraliseRefuses, SelfIntersections) {
  const std::string text = refusal(together(cube(0, 2), cube(1, 3)));
  expect_mentions(text, {"cuts itself", "pairs of triangles", "(2, 2, "});
}

TEST(SelfIntersection, ExactlyTouchingIsFoundAndAGapOfOneUlpIsNot) {
  // Two cubes, the second above the first: a common plane is contact, one unit in the last place above it is not.
  const auto stacked = [](double height) {
    TriSurface upper = cube(0, 1);
    for (Vec3& p : upper.vertices) p = {p.x + 0.25, p.y + 0.25, p.z + height};
    return together(cube(0, 1), upper);
  };
  EXPECT_TRUE(find_self_intersection(stacked(1)).has_value());
  EXPECT_FALSE(find_self_intersection(stacked(std::nextafter(1.0, 2.0))).has_value());
}

TEST(SelfIntersection, TrianglesOfTwoFansAtAVertexMayTouchThereButNotCut) {
  // Two tetrahedra with the origin in common: apart, and with one reaching through a face of the other.
  const auto pair = [](const Vec3& turned) {
    TriSurface a = shapes::boundary(shapes::tetrahedron());
    TriSurface b = a;
    for (Vec3& p : b.vertices) p = {p.x * turned.x, p.y * turned.y, p.z * turned.z};
    const Index origin =
        static_cast<Index>(std::find(a.vertices.begin(), a.vertices.end(), Vec3{}) - a.vertices.begin());
    const Index shift = count(a.vertices);
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (const Triangle& t : b.triangles) {
      Triangle moved = t;
      for (Index& v : moved) v = v == origin ? origin : v + shift;
      if (turned.x * turned.y * turned.z < 0) std::swap(moved[0], moved[1]);
      a.triangles.push_back(moved);
    }
    return a;
  };
  EXPECT_FALSE(find_self_intersection(pair({-1, -1, -1})).has_value());
  EXPECT_TRUE(find_self_intersection(pair({2, 0.5, 0.5})).has_value());
  EXPECT_TRUE(find_self_intersection(pair({-1, 1, -1})).has_value());  // an axis in common
}

// Puts another program in the mesher's place for the time of a test.
class OtherMesher : public ::testing::Test {
 protected:
  void use(const std::string& script) {
    const fs::path program = folder_ / "other_mesher.sh";
    std::ofstream(program) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(program, fs::perms::owner_all);
    setenv("MATSTRUCT_MESHER", program.c_str(), 1);
  }
  void TearDown() override { unsetenv("MATSTRUCT_MESHER"); }

 private:
  matstruct::testing::TempFolder folder_;
};

TEST_F(OtherMesher, Missing) {
  setenv("MATSTRUCT_MESHER", "/nowhere/mesher", 1);
  expect_mentions(refusal(cube(0, 1)), {"/nowhere/mesher"});
}

TEST_F(OtherMesher, Crashes) {
  use("kill -SEGV $$");
  expect_mentions(refusal(cube(0, 1)), {"could not be filled", "HXT crashed with signal 11", "Delaunay crashed"});
}

TEST_F(OtherMesher, SaysNothing) {
  use("exit 0");
  expect_mentions(refusal(cube(0, 1)), {"ended without a result"});
}

TEST_F(OtherMesher, SaysNonsense) {
  use("seq 1 20000");
  expect_mentions(refusal(cube(0, 1)), {"ended without a result"});
}

TEST_F(OtherMesher, HangsUntilCancelled) {
  use("exec sleep 600");
  std::atomic<bool> stop = false;
  Context context;
  context.stop = &stop;
  std::thread impatient([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    stop = true;
  });
  EXPECT_THROW(tetrahedralise(cube(0, 1), context), Cancelled);
  impatient.join();
}

TEST(ModelsTetrahedralise, EveryClosedSurfaceWorks) {
  const fs::path folder = fs::path(MATSTRUCT_SHARED_DATA) / "surface";
  if (!fs::exists(folder)) GTEST_SKIP() << "the shared models are not here";
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().filename().string());
    const TriSurface surface = read_surface(entry.path());
    Context context;
    if (entry.path().stem() == "not_convex") {
      EXPECT_THROW(tetrahedralise(surface, context), Error);
      continue;
    }
    const Domain domain = prepare_domain(tetrahedralise(surface, context), {}, context);
    EXPECT_EQ(domain.topology.b0, 1);
    EXPECT_EQ(domain.topology.b2, 0);
  }
}

TEST(ModelsTetrahedralise, ShippedModelsWork) {
  const auto topology = [](const char* name) {
    Context context;
    const TriSurface surface = read_surface(fs::path(MATSTRUCT_DATA) / name);
    return prepare_domain(tetrahedralise(surface, context), {}, context).topology;
  };
  EXPECT_EQ(topology("bracket.stl"), (Betti{1, 2, 0}));
  EXPECT_EQ(topology("l_profile.off"), (Betti{1, 0, 0}));
  EXPECT_EQ(topology("hollow_box.stl"), (Betti{1, 0, 1}));
  Context context;
  EXPECT_EQ(prepare_domain(read_tet_mesh(fs::path(MATSTRUCT_DATA) / "box.msh"), {}, context).topology,
            (Betti{1, 0, 0}));
}

}  // namespace
}  // namespace matstruct
