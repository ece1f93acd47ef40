// Medit .mesh, text (Frey, "MEDIT: an interactive mesh visualization software", INRIA RT-0253, 2001).
#include <array>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "io/cursor.h"
#include "io/mixed_mesh.h"
#include "io/parsers.h"

namespace matstruct {

namespace {

struct Section {
  std::string_view keyword;
  std::size_t corners;  ///< followed by a reference number; 0: not handled
};

constexpr std::array<Section, 12> kSections{{{"Triangles", 3},
                                             {"Quadrilaterals", 4},
                                             {"Tetrahedra", 4},
                                             {"Hexahedra", 0},
                                             {"Hexaedra", 0},
                                             {"Prisms", 0},
                                             {"Pyramids", 0},
                                             {"TrianglesP2", 0},
                                             {"QuadrilateralsQ2", 0},
                                             {"TetrahedraP2", 0},
                                             {"HexahedraQ2", 0},
                                             {"PrismsP2", 0}}};

void read_vertices(Cursor& cursor, MixedMesh& mesh) {
  if (!mesh.vertices.empty()) cursor.fail("there is a second section of vertices", "export the file again");
  const std::size_t n = cursor.check_count(cursor.integer({"the number of vertices"}), 8, "vertices");
  mesh.vertices.reserve(n);
  for (std::size_t i = 1; i <= n; ++i) {
    const Item item{"vertex", static_cast<std::int64_t>(i)};
    mesh.vertices.push_back(cursor.point(item));
    cursor.word(item);  // its reference, a whole number that some programs write as a real
  }
}

void read_elements(Cursor& cursor, const Section& section, MixedMesh& mesh) {
  const std::int64_t announced = cursor.integer({"the number of elements"});
  if (section.corners == 0) {
    if (announced == 0) return;
    cursor.fail(fmt::format("elements of the kind {} are not handled", section.keyword),
                "export a mesh of first-order tetrahedra");
  }
  const bool tets = section.keyword == "Tetrahedra";
  const char* kind = tets ? "tetrahedron" : section.corners == 3 ? "triangle" : "quadrilateral";
  const std::size_t n = cursor.check_count(announced, 2 * (section.corners + 1), "elements");
  for (std::size_t i = 1; i <= n; ++i) {
    const Item item{kind, static_cast<std::int64_t>(i)};
    std::array<Index, 4> corners{};
    for (std::size_t k = 0; k < section.corners; ++k)
      corners[k] = cursor.check_index(cursor.integer(item), mesh.vertices.size(), 1, item);
    cursor.word(item);
    if (tets)
      add_tetrahedron(corners, item, cursor, mesh.tets);
    else
      add_polygon({corners.data(), section.corners}, item, cursor, mesh.triangles);
  }
}

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

/// Passes over the numbers of a section that is not needed, up to the next keyword.
void skip_numbers(Cursor& cursor) {
  for (std::string_view next = cursor.peek(); !next.empty() && !is_letter(next[0]); next = cursor.peek())
    cursor.word({"a number"});
}

void read_section(Cursor& cursor, MixedMesh& mesh) {
  const std::string_view keyword = cursor.word({"a keyword"});
  for (const Section& section : kSections)
    if (keyword == section.keyword) return read_elements(cursor, section, mesh);
  if (keyword == "Vertices") return read_vertices(cursor, mesh);
  if (keyword == "Dimension") {
    const std::int64_t dimension = cursor.integer({"the dimension"});
    if (dimension != 3) cursor.fail(fmt::format("the mesh has dimension {}, not 3", dimension), "export a solid");
    return;
  }
  if (!is_letter(keyword[0]))
    cursor.fail(fmt::format("expected a keyword such as Tetrahedra but found {}", shown(keyword)),
                "the count before may be wrong, correct it or export the file again");
  skip_numbers(cursor);
}

}  // namespace

Model parse_medit(std::string_view bytes, const std::string& name) {
  Cursor cursor(bytes, name, '#');
  if (!cursor.accept("MeshVersionFormatted"))
    cursor.fail("the file does not begin with MeshVersionFormatted, so it is not a Medit mesh in text form",
                "export it as Medit .mesh, Gmsh .msh or .vtk");
  cursor.integer({"the format version"});
  MixedMesh mesh;
  while (!cursor.at_end() && !cursor.accept("End")) read_section(cursor, mesh);
  return solid_or_surface(std::move(mesh), name);
}

}  // namespace matstruct
