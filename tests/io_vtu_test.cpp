// VTK XML unstructured grids: every way of storing the arrays, and how broken ones are told.
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <matstruct/io.h>

#include "io_testing.h"

namespace matstruct {
namespace {

using testing::cube_solid;
using testing::error_of;
using testing::TempFolder;

/// A file of one piece with points and cells, each array given as its attributes and contents.
std::string grid(const std::string& points, const std::string& connectivity, const std::string& offsets,
                 const std::string& types, const std::string& counts = R"(NumberOfPoints="4" NumberOfCells="1")") {
  return "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\"><UnstructuredGrid><Piece " + counts +
         "><PointData><DataArray type=\"String\" format=\"??\"/></PointData>"
         "<Points><DataArray NumberOfComponents=\"3\" " +
         points + "</DataArray></Points><Cells><DataArray Name=\"connectivity\" " + connectivity +
         "</DataArray><DataArray Name=\"offsets\" " + offsets + "</DataArray><DataArray Name=\"types\" " + types +
         "</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>";
}

constexpr const char* kPoints = "type=\"Float32\">0 0 0 1 0 0 0 1 0 0 0 1";
constexpr const char* kCorners = "type=\"Int32\">0 1 2 3";
constexpr const char* kOffsets = "type=\"Int32\">4";
constexpr const char* kTypes = "type=\"UInt8\">10";

const TetMesh kTetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};

void expect_solid(const std::string& text, const TetMesh& expected) {
  const Model model = parse_vtu(text, "f");
  ASSERT_TRUE(std::holds_alternative<TetMesh>(model));
  EXPECT_EQ(std::get<TetMesh>(model).vertices, expected.vertices);
  EXPECT_EQ(std::get<TetMesh>(model).tets, expected.tets);
}

TEST(VtuFiles, EveryWayOfStoringGivesTheBitsOfTheLegacyFile) {
  const TempFolder folder;
  if (!testing::make_files(folder.path(), "--seeds")) GTEST_SKIP() << "needs python3";
  const auto legacy = std::get<TetMesh>(parse_vtk(testing::bytes_of(folder / "vtk/seed0"), "f"));
  EXPECT_EQ(legacy.tets, cube_solid().tets);
  // Text; 2 byte orders, 2 types of lengths and numbers, 3 compressions, 3 places.
  for (int i = 0; i < 37; ++i) {
    const auto solid = std::get<TetMesh>(parse_vtu(testing::bytes_of(folder / fmt::format("vtu/seed{}", i)), "f"));
    EXPECT_EQ(solid.vertices, legacy.vertices) << i;
    EXPECT_EQ(solid.tets, legacy.tets) << i;
  }
  // Two pieces, each with all points.
  const auto pieces = std::get<TetMesh>(parse_vtu(testing::bytes_of(folder / "vtu/seed37"), "f"));
  EXPECT_EQ(pieces.vertices.size(), 16u);
  ASSERT_EQ(pieces.tets.size(), legacy.tets.size());
  for (std::size_t t = 0; t < pieces.tets.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(pieces.tets[t][k], legacy.tets[t][k] + (t < 3 ? 0 : 8));
}

TEST(Vtu, FilesOfVtkItself) {
  // Written by vtkXMLUnstructuredGridWriter of VTK 9.1: every mode, byte order and type of lengths, blocks of 64 bytes.
  const std::filesystem::path folder = MATSTRUCT_SOURCE "/tests/files/vtu";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    ++files;
    const TetMesh solid = read_tet_mesh(entry.path());
    EXPECT_EQ(solid.vertices, kTetrahedron.vertices) << entry.path();
    EXPECT_EQ(solid.tets, kTetrahedron.tets) << entry.path();
  }
  EXPECT_GE(files, 4);
}

TEST(Vtu, WithoutTetrahedraItIsASurface) {
  const Model model = parse_vtu(grid(kPoints, "type=\"Int32\">0 0 1 0 1 2 0 1 2 3 3 2 1", "type=\"Int32\">1 3 6 10 13",
                                     "type=\"UInt8\">1 3 5 9 7", R"(NumberOfPoints="4" NumberOfCells="5")"),
                                "f");
  EXPECT_EQ(std::get<TriSurface>(model).triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {3, 2, 1}}));
}

TEST(Vtu, TextOfEveryKind) {
  expect_solid(grid(kPoints, kCorners, kOffsets, kTypes), kTetrahedron);
  // Comments, a declaration, a byte-order mark; what VTK adds to an array; integers as coordinates; a cell of no
  // corners.
  expect_solid("\xEF\xBB\xBF<?xml version='1.0'?><!-- <AppendedData> -->\n" +
                   grid("type=\"Int8\"><InformationKey name=\"RANGE\"><Value>1</Value></InformationKey>"
                        "0 0 0 1 0 0 0 1 0 0 0 1<!-- end -->",
                        "type=\"UInt64\" format=\"ascii\">0 1 2 3", kOffsets, kTypes),
               kTetrahedron);
  expect_solid(
      grid(kPoints, kCorners, "type=\"Int32\">0 4", "type=\"UInt8\">1 10", R"(NumberOfPoints="4" NumberOfCells="2")"),
      kTetrahedron);
}

TEST(Vtu, Base64MayBeWrappedAndLengthsEncodedByThemselves) {
  const std::string together = "type=\"Int8\" format=\"binary\">DAAAAAAAAAEAAAABAAAAAQ==";
  const std::string apart = "type=\"Int8\" format=\"binary\">\n  DAAAAA==\n  AAAAAQAA\n  AAEAAAAB\n";
  for (const std::string& points : {together, apart})
    expect_solid(grid(points, kCorners, kOffsets, kTypes), kTetrahedron);
}

TEST(Vtu, LengthsThatLieNameTheArrayAndItsPlace) {
  const auto error = [](const std::string& points) {
    return error_of([&] { parse_vtu("\n\n" + grid(points, kCorners, kOffsets, kTypes), "f"); });
  };
  const std::string start = "Name=\"Points\" type=\"Int8\" format=\"binary\">";
  EXPECT_EQ(error(start + "DQAAAAAAAAEAAAABAAAAAQ=="),
            "f, line 3: the array 'Points' has 13 bytes where its values take 12; export the file again.");
  EXPECT_EQ(error(start + "DAAAAAAAAAEAAAABAAAA"),
            "f, line 3: the array 'Points' has data of 12 bytes, but only 11 are stored; the file is truncated or "
            "damaged, copy or export it again.");
  EXPECT_EQ(error(start + "DAAA"),
            "f, line 3: the array 'Points' has a header of 4 bytes, but only 3 are stored; the file is truncated or "
            "damaged, copy or export it again.");
  EXPECT_NE(error(start + "DAA=AAAA").find("only"), std::string::npos);
  EXPECT_NE(error(start + "DA=AAAAA").find("behind '='"), std::string::npos);
  EXPECT_NE(error(start + "D===AAAA").find("'='"), std::string::npos);
}

TEST(Vtu, ConnectivityBeyondTheFileIsRefusedBeforeItIsRead) {
  const std::string message =
      error_of([] { parse_vtu(grid(kPoints, kCorners, "type=\"Int64\">2000000000", kTypes), "f"); });
  EXPECT_NE(message.find("2000000000 corners"), std::string::npos) << message;
  EXPECT_NE(error_of([] {
              parse_vtu(grid(kPoints, kCorners, "type=\"Int64\">9000000000000000000", kTypes), "f");
            }).find("out of order"),
            std::string::npos);
}

TEST(Vtu, IndicesCountWithinThePiece) {
  const std::string one = grid(kPoints, kCorners, kOffsets, kTypes);
  const std::size_t begin = one.find("<Piece"), end = one.find("</UnstructuredGrid>");
  const std::string piece = one.substr(begin, end - begin);
  std::string wrong = piece;
  wrong.replace(wrong.find("0 1 2 3<"), 7, "0 1 2 4");
  expect_solid(one.substr(0, end) + piece + one.substr(end),
               {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                {{0, 1, 2, 3}, {4, 5, 6, 7}}});
  const std::string message = error_of([&] { parse_vtu(one.substr(0, end) + wrong + one.substr(end), "f"); });
  EXPECT_NE(message.find("vertex 4, but the piece has 4 vertices"), std::string::npos) << message;
}

}  // namespace
}  // namespace matstruct
