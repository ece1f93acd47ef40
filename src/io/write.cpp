// Writers of binary formats. Values are little endian whatever the machine.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include <matstruct/error.h>
#include <matstruct/io.h>

#include "base/index.h"
#include "io/bytes.h"
#include "io/stratum_ids.h"

namespace matstruct {

namespace {

/// A PLY face: the number of corners in one byte, then the corners.
void append_face(std::string& bytes, const Triangle& t) {
  append(bytes, std::uint8_t{3});
  for (const Index i : t) append(bytes, i);
}

std::string ply_header(std::size_t vertices, const char* vertex_properties, std::size_t faces) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment written by matstruct\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n{}"
      "element face {}\nproperty list uchar int vertex_indices\n",
      vertices, vertex_properties, faces);
}

/// A colour for a share in [0, 1], lighter as it grows, from blue over green to yellow.
std::array<std::uint8_t, 3> color_of(double share) {
  constexpr std::array<std::array<double, 3>, 5> kStops{
      {{53, 42, 135}, {24, 106, 196}, {26, 158, 150}, {142, 196, 84}, {250, 229, 56}}};
  const double place = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const double part = place - static_cast<double>(below);
  std::array<std::uint8_t, 3> color{};
  for (std::size_t k = 0; k < 3; ++k)
    color[k] = static_cast<std::uint8_t>(std::lround(kStops[below][k] * (1 - part) + kStops[below + 1][k] * part));
  return color;
}

struct Closer {
  void operator()(std::FILE* f) const { std::fclose(f); }
};

std::string reason(int error) {
  return std::generic_category().message(error);
}

[[noreturn]] void fail_to_write(const std::filesystem::path& file, const std::string& why) {
  throw Error(fmt::format("{}: the file cannot be written ({}); check the folder, its permissions and the free space.",
                          file.string(), why));
}

/// A file beside `file` that did not exist before, open for writing, and its path. Other runs may write `file` at the
/// same time, each through a temporary file of its own.
std::FILE* open_temporary(const std::filesystem::path& file, std::filesystem::path& temporary) {
  for (int k = 0;; ++k) {
    temporary = file;
    temporary += fmt::format(".part{}", k);
    if (std::FILE* f = std::fopen(temporary.c_str(), "wbx")) return f;
    if (errno != EEXIST) fail_to_write(file, reason(errno));
  }
}

}  // namespace

void write_whole(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::path temporary;
  std::unique_ptr<std::FILE, Closer> out(open_temporary(file, temporary));
  std::error_code ignored;
  errno = 0;
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), out.get()) == bytes.size();
  const bool closed = std::fclose(out.release()) == 0;  // what is buffered meets a full disk only here
  if (!written || !closed) {
    const int why = errno;
    std::filesystem::remove(temporary, ignored);
    fail_to_write(file, reason(why));
  }
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (error) {
    std::filesystem::remove(temporary, ignored);
    fail_to_write(file, error.message());
  }
}

void write_ply(const MedialMesh& mesh, const Strata& strata, const std::filesystem::path& file) {
  std::string bytes = ply_header(
      mesh.centers.size(), "property double radius\nproperty uchar type\nproperty int stratum\n", mesh.faces.size());
  bytes += fmt::format("property int sheet\nelement edge {}\nproperty int vertex1\nproperty int vertex2\nend_header\n",
                       mesh.edges.size());
  const std::vector<Index> stratum = stratum_of_vertices(mesh, strata);
  for (std::size_t i = 0; i < mesh.centers.size(); ++i) {
    append(bytes, mesh.centers[i]);
    append(bytes, mesh.radii[i]);
    append(bytes, static_cast<std::uint8_t>(mesh.types[i]));
    append(bytes, stratum[i]);
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    append_face(bytes, mesh.faces[f]);
    append(bytes, strata.sheet_of_face[f]);
  }
  for (const Edge& e : mesh.edges)
    for (const Index i : e) append(bytes, i);
  write_whole(file, bytes);
}

void write_ply(const TriSurface& surface, const std::filesystem::path& file) {
  std::string bytes = ply_header(surface.vertices.size(), "", surface.triangles.size()) + "end_header\n";
  for (const Vec3& p : surface.vertices) append(bytes, p);
  for (const Triangle& t : surface.triangles) append_face(bytes, t);
  write_whole(file, bytes);
}

void write_ply(const TriSurface& surface, const std::vector<double>& distances, const std::filesystem::path& file) {
  std::string bytes =
      ply_header(surface.vertices.size(),
                 "property double distance\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n",
                 surface.triangles.size()) +
      "end_header\n";
  const double greatest = distances.empty() ? 0 : *std::max_element(distances.begin(), distances.end());
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    append(bytes, surface.vertices[i]);
    append(bytes, distances[i]);
    for (const std::uint8_t channel : color_of(greatest > 0 ? distances[i] / greatest : 0)) append(bytes, channel);
  }
  for (const Triangle& t : surface.triangles) append_face(bytes, t);
  write_whole(file, bytes);
}

void write_msh(const TetMesh& mesh, const std::filesystem::path& file) {
  constexpr Index kTetrahedronType = 4, kTags = 2;
  std::string bytes = "$MeshFormat\n2.2 1 8\n";
  append(bytes, Index{1});
  bytes += fmt::format("\n$EndMeshFormat\n$Nodes\n{}\n", mesh.vertices.size());
  for (Index i = 0; i < count(mesh.vertices); ++i) {
    append(bytes, i + 1);
    append(bytes, mesh.vertices[uz(i)]);
  }
  bytes += fmt::format("\n$EndNodes\n$Elements\n{}\n", mesh.tets.size());
  if (!mesh.tets.empty())
    for (const Index i : {kTetrahedronType, count(mesh.tets), kTags}) append(bytes, i);
  for (Index i = 0; i < count(mesh.tets); ++i) {
    append(bytes, i + 1);
    for (Index k = 0; k < kTags; ++k) append(bytes, Index{1});  // physical and elementary entity
    for (const Index v : mesh.tets[uz(i)]) append(bytes, v + 1);
  }
  bytes += "\n$EndElements\n";
  write_whole(file, bytes);
}

}  // namespace matstruct
