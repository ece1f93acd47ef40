// Object File Format in text form (Geomview manual): OFF, and with the prefixes ST, C, N, whose additional values per
// vertex follow the coordinates. One vertex or face per line; colours behind them are passed over.
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/cursor.h"
#include "io/mixed_mesh.h"
#include "io/parsers.h"

namespace matstruct {

namespace {

/// The next line with something on it.
Cursor next_line(Cursor& cursor, Item item) {
  if (cursor.at_end()) cursor.fail_truncated(item);
  return cursor.line();
}

void read_header(Cursor& cursor) {
  std::string_view word = cursor.word({"the header"});
  if (word.substr(0, 2) == "ST") word.remove_prefix(2);
  if (word.substr(0, 1) == "C") word.remove_prefix(1);
  if (word.substr(0, 1) == "N") word.remove_prefix(1);
  if (word == "OFF" && !cursor.accept("BINARY")) return;
  if (word == "OFF" || word == "4OFF" || word == "nOFF" || word == "4nOFF")
    cursor.fail("binary OFF and OFF of other than three dimensions are not handled", "export plain text OFF");
  cursor.fail("the file does not begin with OFF", "export it as OFF, or correct the extension if it is another format");
}

void read_face(Cursor line, Item item, std::vector<Index>& corners, MixedMesh& mesh) {
  const std::size_t n = line.check_count(line.integer(item), 2, "corners");
  corners.clear();
  for (std::size_t k = 0; k < n; ++k)
    corners.push_back(line.check_index(line.integer(item), mesh.vertices.size(), 0, item));
  add_polygon(corners, item, line, mesh.triangles);
}

}  // namespace

TriSurface parse_off(std::string_view bytes, const std::string& name) {
  Cursor cursor(bytes, name, '#');
  read_header(cursor);
  Cursor counts = next_line(cursor, {"the counts of vertices and faces"});
  const std::int64_t announced_vertices = counts.integer({"the number of vertices"});
  const std::int64_t announced_faces = counts.integer({"the number of faces"});

  MixedMesh mesh;
  const std::size_t vertices = cursor.check_count(announced_vertices, 6, "vertices");
  mesh.vertices.reserve(vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    const Item item{"vertex", static_cast<std::int64_t>(i)};
    mesh.vertices.push_back(next_line(cursor, item).point(item));
  }
  const std::size_t faces = cursor.check_count(announced_faces, 2, "faces");
  std::vector<Index> corners;
  for (std::size_t i = 0; i < faces; ++i) {
    const Item item{"face", static_cast<std::int64_t>(i)};
    read_face(next_line(cursor, item), item, corners, mesh);
  }
  if (!cursor.at_end())
    cursor.fail(fmt::format("there is more after the {} vertices and {} faces announced", vertices, faces),
                "correct the counts or export the file again");
  return surface_of(std::move(mesh), name);
}

}  // namespace matstruct
