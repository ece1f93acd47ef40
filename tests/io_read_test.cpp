// Reading of files that are right, in every format and flavour.
#include <gtest/gtest.h>

#include <matstruct/io.h>

#include "io_testing.h"

namespace matstruct {
namespace {

using testing::canonical;
using testing::cube_solid;
using testing::cube_surface;
using testing::error_of;
using testing::TempFolder;

class Flavours : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing::make_files(folder_.path())) GTEST_SKIP() << "needs python3";
  }
  TempFolder folder_;
};

TEST_F(Flavours, EverySurfaceFileGivesTheSameCube) {
  for (const char* name : {"cube.off", "comments.off", "cube.obj", "faces_first.obj", "negative.obj", "cube.ply",
                           "little.ply", "big.ply", "cube.stl", "binary.stl", "solid.stl", "nan_normal.stl"}) {
    const TriSurface surface = read_surface(folder_ / name);
    EXPECT_EQ(surface.vertices.size(), 8u) << name;
    EXPECT_EQ(canonical(surface), canonical(cube_surface())) << name;
  }
}

TEST_F(Flavours, EverySolidFileGivesTheSameCube) {
  for (const char* name : {"cube2.msh", "cube2_binary.msh", "cube2_big.msh", "cube4.msh", "cube4_binary.msh",
                           "cube4_big.msh", "mixed.msh", "cube.mesh", "cube.vtk", "cube_binary.vtk", "cube_offsets.vtk",
                           "cube.vtu", "cube_binary.vtu", "cube_raw.vtu", "cube_deflated.vtu"}) {
    const TetMesh solid = read_tet_mesh(folder_ / name);
    EXPECT_EQ(solid.vertices, cube_solid().vertices) << name;
    EXPECT_EQ(solid.tets, cube_solid().tets) << name;
  }
}

TEST(Obj, CornersMayHaveTexturesAndNormals) {
  const TriSurface s = parse_obj(
      "mtllib a.mtl\no part\nv 0 0 0 0.1 nan 0.3\nv 1 0 0\nvt 0 0\nvn 0 0 1\nv 0 1 0\ng f 9 9 9\ns off\n"
      "f 1 2 3\r\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 -1/-1/-1 # comment\nl 1 2\np 1\n",
      "f");
  EXPECT_EQ(s.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(s.triangles, std::vector<Triangle>(4, {0, 1, 2}));
}

TEST(Obj, NegativeIndicesCountFromTheVerticesSoFar) {
  const TriSurface s = parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -3 -2 -1\n", "f");
  EXPECT_EQ(s.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 2, 3}}));
}

TEST(Obj, PolygonsAreCutIntoFansWithoutDegenerateTriangles) {
  const TriSurface s = parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 2 3\nf 1 2 1\n", "f");
  EXPECT_EQ(s.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
}

TEST(Off, HeaderVariantsCommentsAndColours) {
  const std::string body =
      "\n# counts next\n4 1 0 # edges are not counted\n0 0 0 9 9\n1 0 0 9 9\n1 1 0 9 9\n0 1 0\n"
      "4 0 1 2 3  255 0 0\n";
  for (const char* header : {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCNOFF # comment"}) {
    const TriSurface s = parse_off(header + body, "f");
    EXPECT_EQ(s.vertices.size(), 4u) << header;
    EXPECT_EQ(s.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}})) << header;
  }
  EXPECT_EQ(parse_off("OFF 3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2", "f").triangles.size(), 1u);
}

TEST(Ply, PropertiesOfAnyKindAndOrderArePassedOver) {
  const TriSurface s = parse_ply(
      "ply\r\nformat ascii 1.0\r\nobj_info made by hand\r\nelement camera 1\r\nproperty list int float zoom\r\n"
      "element face 1\r\nproperty uchar red\r\nproperty list uint8 uint32 vertex_index\r\n"
      "property list uchar float texcoord\r\nelement vertex 3\r\nproperty double z\r\nproperty float32 quality\r\n"
      "property int16 x\r\nproperty float y\r\nend_header\r\n2 0.5 1.5\r\n255 3 2 1 0 2 nan 0\r\n"
      "0.5 nan 1 2\r\n0.25 1 3 4\r\n0 1 5 6\r\n",
      "f");
  EXPECT_EQ(s.vertices, (std::vector<Vec3>{{1, 2, 0.5}, {3, 4, 0.25}, {5, 6, 0}}));
  EXPECT_EQ(s.triangles, (std::vector<Triangle>{{2, 1, 0}}));
}

TEST(Stl, SeveralSolidsInOneFileAndKeywordsOfEitherCase) {
  const std::string facet =
      "FACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nvertex 1 0 0\nvertex -0 1 -0\n"
      "ENDLOOP\nENDFACET\n";
  const TriSurface s =
      parse_stl("Solid a solid facet\n" + facet + "ENDSOLID a solid\nsolid\n" + facet + "endsolid", "f");
  EXPECT_EQ(s.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(s.triangles, std::vector<Triangle>(2, {0, 1, 2}));
}

TEST(Stl, MinusZeroIsZero) {
  const TriSurface s = parse_stl(
      "solid\nfacet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n"
      "facet normal 0 0 0 outer loop vertex -0 0 -0.0 vertex 0 1 0 vertex 0 0 1 endloop endfacet\nendsolid\n",
      "f");
  EXPECT_EQ(s.vertices.size(), 4u);
  EXPECT_EQ(s.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Stl, FacetWithoutAreaIsLeftOut) {
  const TriSurface s = parse_stl(
      "solid\nfacet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n"
      "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 0 0 endloop endfacet\nendsolid\n",
      "f");
  EXPECT_EQ(s.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Msh, NodeNumbersMayHaveGapsAndAnyOrder) {
  const Model model = parse_msh(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"steel $Nodes\"\n$EndPhysicalNames\n"
      "$Nodes\n4\n70 0 0 0\n10 1 0 0\n30 0 1 0\n1000000 0 0 1\n$EndNodes\n"
      "$Elements\n2\n5 15 0 70\n6 4 3 1 1 7 70 10 30 1000000\n$EndElements\n$NodeData\nanything\n$EndNodeData\n",
      "f");
  const auto& solid = std::get<TetMesh>(model);
  EXPECT_EQ(solid.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(solid.tets, (std::vector<Tetrahedron>{{0, 1, 2, 3}}));
}

TEST(Msh, WildNodeNumbersDoNotOverflow) {
  const std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n-9223372036854775808 0 0 0\n-7 1 0 0\n0 0 1 0\n"
      "9223372036854775807 0 0 1\n$EndNodes\n$Elements\n1\n1 4 0 -9223372036854775808 -7 0 ";
  const Model model = parse_msh(text + "9223372036854775807\n$EndElements\n", "f");
  EXPECT_EQ(std::get<TetMesh>(model).tets, (std::vector<Tetrahedron>{{0, 1, 2, 3}}));
  EXPECT_NE(error_of([&] { parse_msh(text + "9223372036854775806\n$EndElements\n", "f"); }).find("no node"),
            std::string::npos);
}

TEST(Msh, Version41WithSeveralBlocksAndParametricNodes) {
  const Model model = parse_msh(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 0 0 0\n1 0 0 0 0\n$EndEntities\n"
      "$Nodes\n3 4 1 9\n2 1 1 2\n3\n9\n0 0 0 0.5 0.5\n1 0 0 0.25 0.75\n3 1 0 0\n3 2 0 2\n1\n2\n0 1 0\n0 0 "
      "1\n$EndNodes\n"
      "$Elements\n2 2 1 2\n2 1 2 1\n1 3 9 1\n3 1 4 1\n2 3 9 1 2\n$EndElements\n",
      "f");
  const auto& solid = std::get<TetMesh>(model);
  EXPECT_EQ(solid.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(solid.tets, (std::vector<Tetrahedron>{{0, 1, 2, 3}}));
}

TEST(Msh, WithoutTetrahedraItIsASurface) {
  const Model model = parse_msh(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
      "$Elements\n3\n1 1 0 1 2\n2 2 0 1 2 3\n3 3 0 1 2 3 4\n$EndElements\n",
      "f");
  EXPECT_EQ(std::get<TriSurface>(model).triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}}));
}

TEST(Medit, SectionsThatAreNotNeededArePassedOver) {
  const Model model = parse_medit(
      "MeshVersionFormatted\n1\n# comment\nDimension\n3\nVertices 4\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1.0\n"
      "Corners 2\n1 2\nEdges 1\n1 2 9\nTriangles\n1\n1 2 3 0\nNormals 1\n-1 0.5 .5\nHexahedra 0\nTetrahedra 1\n"
      "1 2 3 4 5\n",
      "f");
  EXPECT_EQ(std::get<TetMesh>(model).tets, (std::vector<Tetrahedron>{{0, 1, 2, 3}}));
}

TEST(Vtk, SurfacesAsUnstructuredGridAndAsPolygons) {
  const std::string start = "# vtk DataFile Version 4.2\nBINARY is only the title\nASCII\nDATASET ";
  const std::string points = "POINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n";
  const std::vector<Triangle> expected{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {1, 2, 3}};
  const Model grid =
      parse_vtk(start + "UNSTRUCTURED_GRID\nFIELD data 1\nTIME 1 2 double\n0.5 nan\n" + points +
                    "CELLS 4 15\n3 0 1 2\n4 0 1 2 3\n3 1 2 3\n1 0\nCELL_TYPES 4\n5\n9\n7\n1\nPOINT_DATA 4\n",
                "f");
  EXPECT_EQ(std::get<TriSurface>(grid).triangles, expected);
  const Model polygons = parse_vtk(
      start + "POLYDATA\n" + points + "LINES 1 3\n2 0 1\nPOLYGONS 3 13\n3 0 1 2\n4 0 1 2 3\n3 1 2 3\nCELL_DATA 4\n",
      "f");
  EXPECT_EQ(std::get<TriSurface>(polygons).triangles, expected);
}

TEST(ReadModel, TheExtensionMayHaveEitherCase) {
  const TempFolder folder;
  testing::write_text(folder / "A.OFF", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(read_surface(folder / "A.OFF").triangles.size(), 1u);
}

TEST(ReadModel, MissingFilesFoldersAndTheWrongKindAreRefused) {
  const TempFolder folder;
  testing::write_text(folder / "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  write_msh(cube_solid(), folder / "a.msh");
  EXPECT_NE(error_of([&] { read_model(folder / "b.off"); }).find("does not exist"), std::string::npos);
  EXPECT_NE(error_of([&] { read_ma(folder / "b.ma"); }).find("does not exist"), std::string::npos);
  std::filesystem::create_directory(folder / "folder.off");
  EXPECT_NE(error_of([&] { read_model(folder / "folder.off"); }).find("folder"), std::string::npos);
  EXPECT_NE(error_of([&] { read_tet_mesh(folder / "a.off"); }).find("surface"), std::string::npos);
  EXPECT_NE(error_of([&] { read_surface(folder / "a.msh"); }).find("solid"), std::string::npos);
}

}  // namespace
}  // namespace matstruct
