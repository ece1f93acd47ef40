// Writers: what is written reads back to the same bits, and a file appears whole or not at all.
#include <csignal>
#include <cstring>
#include <limits>

#include <sys/resource.h>

#include <gtest/gtest.h>

#include <matstruct/io.h>

#include "io_testing.h"

namespace matstruct {
namespace {

using testing::bytes_of;
using testing::error_of;
using testing::TempFolder;
using testing::write_text;

/// Numbers that a careless decimal form would change.
MedialMesh awkward_mesh() {
  constexpr double kTiny = std::numeric_limits<double>::denorm_min();
  return {.centers = {{0.1, 1.0 / 3, -0.0}, {1e300, -kTiny, 0.1 + 0.2}, {123456789.123456789, 5e-324, 1e-5}, {1, 2, 3}},
          .radii = {0, 0x1.fffffffffffffp-1, 2.0 / 7, 1e22},
          .types = {SphereType::kCorner, SphereType::kSheet, SphereType::kSharpEdge, SphereType::kJunction},
          .edges = {{0, 1}, {0, 2}, {1, 2}, {2, 3}},
          .faces = {{0, 1, 2}}};
}

TEST(Ma, RoundTripKeepsEveryBit) {
  const TempFolder folder;
  const MedialMesh mesh = awkward_mesh();
  write_ma(mesh, folder / "a.ma");
  const MedialMesh back = read_ma(folder / "a.ma");
  EXPECT_EQ(back.centers, mesh.centers);
  EXPECT_TRUE(std::signbit(back.centers[0].z));
  EXPECT_EQ(back.radii, mesh.radii);
  EXPECT_EQ(back.types, mesh.types);
  EXPECT_EQ(back.edges, mesh.edges);
  EXPECT_EQ(back.faces, mesh.faces);
  write_ma(back, folder / "b.ma");
  EXPECT_EQ(bytes_of(folder / "a.ma"), bytes_of(folder / "b.ma"));
}

TEST(Ma, TextIsWhatTheEarlierProgramsRead) {
  const TempFolder folder;
  write_ma({.centers = {{0, 0.5, 1}, {1, 0, 0}, {0, 1, 0}},
            .radii = {0.25, 1, 2},
            .types = {SphereType::kSheet, SphereType::kSeam, SphereType::kJunction},
            .edges = {{0, 1}, {0, 2}, {1, 2}},
            .faces = {{0, 1, 2}}},
           folder / "a.ma");
  EXPECT_EQ(bytes_of(folder / "a.ma"),
            "3 3 1\nv 0 0.5 1 0.25 0\nv 1 0 0 1 1\nv 0 1 0 2 2\ne 0 1\ne 0 2\ne 1 2\nf 0 1 2\n");
}

TEST(Ma, FilesOfEarlierProgramsAreMadeRegular) {
  // No types or foreign ones, more columns, unordered and repeated simplices, edges of faces left out.
  const MedialMesh mesh = parse_ma(
      "4 3 2\n# comment\nv 0 0 0 1\n\nv 1 0 0 1 17\nv 0 1 0 1 2 0 5\nv 0 0 1 1 -1\n"
      "e 2 1 0\ne 1 2\ne 3 0\nf 2 1 0\nf 0 1 2 8\n",
      "f");
  EXPECT_EQ(mesh.types, (std::vector<SphereType>{SphereType::kSheet, SphereType::kSheet, SphereType::kJunction,
                                                 SphereType::kSheet}));
  EXPECT_EQ(mesh.edges, (std::vector<Edge>{{0, 1}, {0, 2}, {0, 3}, {1, 2}}));
  EXPECT_EQ(mesh.faces, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Ma, BadFilesAreRefused) {
  const auto refusal = [](const char* text) { return error_of([&] { parse_ma(text, "f"); }); };
  EXPECT_NE(refusal("1 0 0\nv 0 0 0 -1 0\n").find("radius of vertex 0 is -1"), std::string::npos);
  EXPECT_NE(refusal("1 0 0\nv 0 0 0 nan 0\n").find("radius of vertex 0 is nan"), std::string::npos);
  EXPECT_NE(refusal("1 0 0\nv 0 inf 0 1 0\n").find("y coordinate of vertex 0"), std::string::npos);
  EXPECT_NE(refusal("1 0 0\nv 0 0 0\n").find("ends before vertex 0"), std::string::npos);
  EXPECT_NE(refusal("2 0 0\nv 0 0 0 1 0\n").find("truncated"), std::string::npos);
  EXPECT_NE(refusal("2 1 0\nv 0 0 0 1\nv 1 0 0 1\ne 0 2\n").find("line 4: edge 0 refers to vertex 2"),
            std::string::npos);
  EXPECT_NE(refusal("2 1 0\nv 0 0 0 1\nv 1 0 0 1\ne 1 1\n").find("twice"), std::string::npos);
  EXPECT_NE(refusal("1 0 0\nv 0 0 0 1\ne 0 0\n").find("more after"), std::string::npos);
  EXPECT_NE(refusal("1 0 0\ne 0 0 # no vertex\n").find("expected 'v'"), std::string::npos);
  EXPECT_NE(refusal("999999999 0 0\nv 0 0 0 1\n").find("bytes follow"), std::string::npos);
  EXPECT_NE(refusal("ply\n").find("'ply'"), std::string::npos);
}

TEST(Msh, RoundTripKeepsEveryBit) {
  const TempFolder folder;
  TetMesh mesh = testing::cube_solid();
  mesh.vertices[0] = {0.1, -1e-300, 1.0 / 3};
  write_msh(mesh, folder / "a.msh");
  const TetMesh back = read_tet_mesh(folder / "a.msh");
  EXPECT_EQ(back.vertices, mesh.vertices);
  EXPECT_EQ(back.tets, mesh.tets);
}

TEST(Ply, RoundTripOfASurfaceKeepsEveryBit) {
  const TempFolder folder;
  TriSurface surface = testing::cube_surface();
  surface.vertices[7] = {0.1, 1e300, 1.0 / 3};
  write_ply(surface, folder / "a.ply");
  const TriSurface back = read_surface(folder / "a.ply");
  EXPECT_EQ(back.vertices, surface.vertices);
  EXPECT_EQ(back.triangles, surface.triangles);
}

TEST(Ply, MedialMeshHasItsFieldsInThisOrder) {
  const TempFolder folder;
  const MedialMesh mesh = awkward_mesh();
  write_ply(mesh, trace_strata(mesh), folder / "a.ply");
  const TriSurface faces = read_surface(folder / "a.ply");
  EXPECT_EQ(faces.vertices, mesh.centers);
  EXPECT_EQ(faces.triangles, mesh.faces);

  const std::string bytes = bytes_of(folder / "a.ply");
  const std::size_t body = bytes.find("end_header\n") + 11;
  constexpr std::size_t kVertex = 4 * 8 + 1 + 4, kFace = 1 + 3 * 4 + 4, kEdge = 2 * 4;
  ASSERT_EQ(bytes.size(), body + 4 * kVertex + 1 * kFace + 4 * kEdge);
  for (std::size_t i = 0; i < 4; ++i) {
    double radius = 0;
    std::memcpy(&radius, bytes.data() + body + i * kVertex + 24, 8);
    EXPECT_EQ(radius, mesh.radii[i]);
    EXPECT_EQ(bytes[body + i * kVertex + 32], static_cast<char>(mesh.types[i]));
  }
  EXPECT_EQ(bytes[bytes.size() - 4], 3);  // the last edge is (2, 3)
}

TEST(WriteWhole, ReplacesAFileAndLeavesNothingElse) {
  const TempFolder folder;
  write_text(folder / "a.txt", "old");
  write_text(folder / "a.txt.part0", "left by a run that was killed");
  write_whole(folder / "a.txt", "new");
  EXPECT_EQ(bytes_of(folder / "a.txt"), "new");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.txt", "a.txt.part0"}));
  EXPECT_EQ(bytes_of(folder / "a.txt.part0"), "left by a run that was killed");
}

TEST(WriteWhole, RefusesWhatCannotBeWritten) {
  const TempFolder folder;
  write_text(folder / "file", "");
  std::filesystem::create_directory(folder / "folder");
  for (const char* name : {"missing/a.ma", "file/a.ma", "folder"}) {
    const std::string message = error_of([&] { write_whole(folder / name, "text"); });
    EXPECT_NE(message.find("cannot be written ("), std::string::npos) << name << ": " << message;
    EXPECT_NE(message.find((folder / name).string()), std::string::npos) << message;
  }
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"file", "folder"}));
}

/// A disk that is full after `bytes`, for as long as this object lives.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(WriteWhole, FullDiskKeepsTheOldFileAndRemovesThePart) {
  const TempFolder folder;
  write_text(folder / "a.ma", "old");
  for (const std::size_t size :
       {std::size_t{5000}, std::size_t{1} << 20}) {  // within and beyond the buffer of a stream
    std::string message;
    {
      const FullDisk full(1000);
      message = error_of([&] { write_whole(folder / "a.ma", std::string(size, 'x')); });
    }
    EXPECT_NE(message.find("cannot be written (File too large)"), std::string::npos) << message;
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.ma"});
    EXPECT_EQ(bytes_of(folder / "a.ma"), "old");
  }
}

}  // namespace
}  // namespace matstruct
