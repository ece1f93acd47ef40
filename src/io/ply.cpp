// PLY (Turk, "The PLY polygon file format", 1994), text and binary of either byte order. Any elements with any
// properties are read; of the element "vertex" x, y, z are used, of "face" the list vertex_indices or vertex_index.
#include <bit>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/cursor.h"
#include "io/mixed_mesh.h"
#include "io/parsers.h"
#include "io/scalar.h"

namespace matstruct {

namespace {

struct Property {
  std::string_view name;
  Scalar type;
  bool is_list = false;
  Scalar count_type = Scalar::kUint8;  ///< of lists
};

struct Element {
  std::string_view name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  bool binary = false;
  std::endian order = std::endian::little;
  std::vector<Element> elements;
};

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// The place of a property in an element, or kNone.
std::size_t find(const Element& element, std::string_view name, bool is_list) {
  for (std::size_t k = 0; k < element.properties.size(); ++k)
    if (element.properties[k].name == name && element.properties[k].is_list == is_list) return k;
  return kNone;
}

void read_format(Cursor& line, Header& header) {
  const std::string_view format = line.word({"the format"});
  header.binary = format != "ascii";
  if (format == "binary_big_endian")
    header.order = std::endian::big;
  else if (header.binary && format != "binary_little_endian")
    line.fail(fmt::format("the format {} is not known", shown(format)), "export the file again");
}

Scalar read_type(Cursor& line) {
  const std::string_view name = line.word({"the type of a property"});
  const auto type = scalar_of(name);
  if (!type) line.fail(fmt::format("the type {} of a property is not known", shown(name)), "export the file again");
  return *type;
}

void read_property(Cursor& line, Header& header) {
  if (header.elements.empty()) line.fail("a property comes before the first element", "export the file again");
  Property property{};
  property.is_list = line.accept("list");
  if (property.is_list) property.count_type = read_type(line);
  property.type = read_type(line);
  property.name = line.word({"the name of a property"});
  header.elements.back().properties.push_back(property);
}

Header read_header(Cursor& cursor) {
  if (!cursor.accept("ply"))
    cursor.fail("the file does not begin with 'ply'", "correct its extension or export it as PLY");
  cursor.line();
  Header header;
  bool has_format = false;
  while (!cursor.accept("end_header")) {
    if (cursor.at_end()) cursor.fail_truncated({"the header"});
    Cursor line = cursor.line();
    const std::string_view keyword = line.word({"the header"});
    if (keyword == "format") {
      read_format(line, header);
      has_format = true;
    } else if (keyword == "element") {
      const std::string_view name = line.word({"the name of an element"});
      header.elements.push_back({name, line.integer({"the number of elements"}), {}});
    } else if (keyword == "property") {
      read_property(line, header);
    } else if (keyword != "comment" && keyword != "obj_info") {
      line.fail(fmt::format("{} is no statement of a PLY header", shown(keyword)), "export the file again");
    }
  }
  if (!has_format) cursor.fail("the header does not tell the format", "export the file again");
  cursor.line();
  return header;
}

/// Reads the values of a list property into `list`.
void read_list(Cursor& cursor, const Property& property, Item item, std::vector<std::int64_t>& list) {
  const std::int64_t announced = read_integer(cursor, property.count_type, item);
  const std::size_t n = cursor.check_count(announced, least_bytes(cursor, property.type), "list entries");
  list.clear();
  for (std::size_t k = 0; k < n; ++k) list.push_back(read_integer(cursor, property.type, item));
}

/// Passes over a value that is not needed; in text it may be anything, also "nan".
void skip_property(Cursor& cursor, const Property& property, Item item) {
  std::size_t n = 1;
  if (property.is_list)
    n = cursor.check_count(read_integer(cursor, property.count_type, item), least_bytes(cursor, property.type),
                           "list entries");
  if (cursor.binary()) return cursor.skip(n * size_of(property.type), item);
  for (std::size_t k = 0; k < n; ++k) cursor.word(item);
}

void read_vertices(Cursor& cursor, const Element& element, std::size_t n, std::vector<Vec3>& vertices) {
  const std::size_t x = find(element, "x", false), y = find(element, "y", false), z = find(element, "z", false);
  if (x == kNone || y == kNone || z == kNone)
    cursor.fail("the vertices lack a property x, y or z", "export the file again");
  vertices.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Item item{"vertex", static_cast<std::int64_t>(i)};
    Vec3 p;
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      if (k == x || k == y || k == z)
        p[k == x ? 0 : k == y ? 1 : 2] = read_real(cursor, element.properties[k].type, item);
      else
        skip_property(cursor, element.properties[k], item);
    }
    cursor.check_finite(p, item);
    vertices.push_back(p);
  }
}

void read_faces(Cursor& cursor, const Element& element, std::size_t n, std::size_t vertices,
                std::vector<Triangle>& triangles) {
  const std::size_t plural = find(element, "vertex_indices", true), singular = find(element, "vertex_index", true);
  const std::size_t used = plural != kNone ? plural : singular;
  if (used == kNone && n > 0) cursor.fail("the faces have no list vertex_indices", "export the file again");
  std::vector<std::int64_t> list;
  std::vector<Index> corners;
  for (std::size_t i = 0; i < n; ++i) {
    const Item item{"face", static_cast<std::int64_t>(i)};
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      if (k != used) {
        skip_property(cursor, element.properties[k], item);
        continue;
      }
      read_list(cursor, element.properties[k], item, list);
      corners.clear();
      for (const std::int64_t c : list) corners.push_back(cursor.check_index(c, vertices, 0, item));
      add_polygon(corners, item, cursor, triangles);
    }
  }
}

std::size_t checked_count(const Cursor& cursor, const Element& element) {
  std::size_t bytes_each = 0;
  for (const Property& p : element.properties) bytes_each += least_bytes(cursor, p.is_list ? p.count_type : p.type);
  if (bytes_each == 0) {
    if (element.count > 0)
      cursor.fail(fmt::format("the element {} has no properties", shown(element.name)), "export the file again");
    return 0;
  }
  const bool vertex = element.name == "vertex", face = element.name == "face";
  return cursor.check_count(element.count, bytes_each, vertex ? "vertices" : face ? "faces" : "elements");
}

std::size_t vertices_announced(const Header& header, const Cursor& cursor) {
  for (const Element& element : header.elements)
    if (element.name == "vertex") return cursor.check_count(element.count, 1, "vertices");
  return 0;
}

}  // namespace

TriSurface parse_ply(std::string_view bytes, const std::string& name) {
  Cursor cursor(bytes, name);
  const Header header = read_header(cursor);
  if (header.binary) cursor.set_binary(header.order);
  const std::size_t vertices = vertices_announced(header, cursor);
  MixedMesh mesh;
  for (const Element& element : header.elements) {
    const std::size_t n = checked_count(cursor, element);
    if (element.name == "vertex" && mesh.vertices.empty()) {
      read_vertices(cursor, element, n, mesh.vertices);
    } else if (element.name == "face") {
      read_faces(cursor, element, n, vertices, mesh.triangles);
    } else {
      const Item item{"an element that is not needed"};
      for (std::size_t i = 0; i < n; ++i)
        for (const Property& property : element.properties) skip_property(cursor, property, item);
    }
  }
  return surface_of(std::move(mesh), name);
}

}  // namespace matstruct
