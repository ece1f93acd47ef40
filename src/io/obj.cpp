// Wavefront OBJ: the statements v and f; normals, textures, groups and materials are passed over.
#include <cctype>
#include <charconv>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/index.h"
#include "io/cursor.h"
#include "io/mixed_mesh.h"
#include "io/parsers.h"

namespace matstruct {

namespace {

constexpr const char* kRemedy = "correct it or export the file again";

/// The greatest vertex that a face refers to, and where: a face may come before its vertices, so that this can only be
/// checked at the end.
struct Farthest {
  Index vertex = kInvalid;
  std::size_t offset = 0;
  std::int64_t face = 0;
};

/// The vertex in a corner "v", "v/vt", "v//vn" or "v/vt/vn", from 0; negative numbers count back from the last vertex.
Index read_corner(Cursor& line, Item face, Index vertices) {
  const std::string_view corner = line.word(face);
  const std::string_view first = corner.substr(0, corner.find('/'));
  std::int64_t i = 0;
  const auto [end, error] = std::from_chars(first.data(), first.data() + first.size(), i);
  if (error != std::errc{} || end != first.data() + first.size())
    line.fail(fmt::format("expected a vertex number in {} but found {}", face.text(), shown(corner)), kRemedy);
  if (i == 0) line.fail(fmt::format("{} refers to vertex 0, but the first is 1", face.text()), kRemedy);
  if (i < 0 && vertices + i < 0)
    line.fail(fmt::format("{} refers to vertex {}, counted back from the last, but only {} vertices come before it",
                          face.text(), i, vertices),
              kRemedy);
  if (i < 0) return static_cast<Index>(vertices + i);
  return line.check_index(i, uz(std::numeric_limits<Index>::max()), 1, face);
}

}  // namespace

TriSurface parse_obj(std::string_view bytes, const std::string& name) {
  Cursor cursor(bytes, name, '#');
  MixedMesh mesh;
  std::vector<Index> corners;
  Farthest farthest;
  Item face{"face", 0};
  while (!cursor.at_end()) {
    const std::size_t offset = cursor.offset();
    Cursor line = cursor.line();
    const std::string_view keyword = line.word({"a statement"});
    if (keyword == "v") {
      mesh.vertices.push_back(line.point({"vertex", count(mesh.vertices) + 1}));
    } else if (keyword == "f" || keyword == "fo") {
      ++face.id;
      corners.clear();
      while (!line.at_end()) corners.push_back(read_corner(line, face, count(mesh.vertices)));
      for (const Index c : corners)
        if (c > farthest.vertex) farthest = {c, offset, face.id};
      add_polygon(corners, face, line, mesh.triangles);
    } else if (std::isalpha(static_cast<unsigned char>(keyword[0])) == 0) {
      line.fail(fmt::format("{} is no statement of an OBJ file", shown(keyword)),
                "correct it, or the extension if the file has another format");
    }
  }
  cursor.mark_at(farthest.offset);
  if (farthest.vertex != kInvalid)
    cursor.check_index(farthest.vertex + 1, mesh.vertices.size(), 1, {"face", farthest.face});
  return surface_of(std::move(mesh), name);
}

}  // namespace matstruct
