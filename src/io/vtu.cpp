// VTK XML unstructured grids ("VTK XML formats", Kitware): arrays as text, in base64 or appended, deflated by zlib or
// not; the pieces of a file become one mesh. Attributes of points and cells are passed over, undecoded.
#include <algorithm>
#include <charconv>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "io/cursor.h"
#include "io/mixed_mesh.h"
#include "io/parsers.h"
#include "io/vtk_arrays.h"
#include "io/vtk_cells.h"

namespace matstruct {

namespace {

constexpr const char* kExportAgain = "export the file again";

std::size_t offset_of(const pugi::xml_node& node) {
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));  // -1 if there is none
}

struct Reader {
  std::string_view bytes;
  const std::string& name;
  Cursor cursor;  ///< over the whole file; what it says of a place is where mark() was last
  VtkStorage storage;
  std::string_view appended;
  bool appended_base64 = false;
  std::int64_t points = 0, cells = 0, corners = 0;  ///< announced by the pieces so far
  std::size_t counted = 0;                          ///< bytes of which `line` counts the lines
  std::int64_t line = 1;
  MixedMesh mesh;

  /// Errors from now on point at this element.
  void mark(const pugi::xml_node& node) { cursor.mark_at(offset_of(node)); }

  /// The line of this element, counted from that of the last one asked for: a file may have very many arrays.
  std::int64_t line_of(const pugi::xml_node& node) {
    const std::size_t offset = offset_of(node), from = std::min(offset, counted), to = std::max(offset, counted);
    const std::int64_t between = std::ranges::count(bytes.substr(from, to - from), '\n');
    line += offset < counted ? -between : between;
    counted = offset;
    return line;
  }
};

std::string_view attribute(const pugi::xml_node& node, const char* name) {
  return node.attribute(name).value();
}

/// Where '<AppendedData' begins, outside of comments.
std::size_t find_appended(std::string_view bytes) {
  std::size_t from = 0;
  while (true) {
    const std::size_t found = bytes.find("<AppendedData", from);
    const std::size_t comment = bytes.find("<!--", from);
    if (found == std::string_view::npos || found < comment) return found;
    from = bytes.find("-->", comment);
    if (from == std::string_view::npos) return from;
  }
}

/// The file as XML: appended data may have any bytes, so they are cut off and go to `in`.
std::string cut_appended(Reader& in) {
  const std::size_t begin = find_appended(in.bytes);
  const std::size_t end = begin == std::string_view::npos ? begin : in.bytes.find('>', begin);
  if (end == std::string_view::npos || in.bytes[end - 1] == '/') return std::string(in.bytes);
  in.cursor.mark_at(begin);
  std::string_view data = in.bytes.substr(end + 1);
  const std::size_t close = data.rfind("</AppendedData>");
  for (const char* tag : {"</AppendedData>", "</VTKFile>"})
    if (data.find(tag, std::min(close, data.size())) == std::string_view::npos)
      in.cursor.fail(fmt::format("the file ends without '{}': it is truncated", tag), "copy or export it again");
  data = data.substr(0, close);
  const std::size_t start = data.find_first_not_of(" \t\r\n");
  if (start == std::string_view::npos || data[start] != '_')
    in.cursor.fail("the appended data do not begin with '_'", kExportAgain);
  in.appended = data.substr(start + 1);
  return std::string(in.bytes.substr(0, end)) + "/></VTKFile>";
}

void parse_xml(Reader& in, std::string& xml, pugi::xml_document& document) {
  if (in.bytes.find("<VTKFile") == std::string_view::npos)
    in.cursor.fail("the file has no element VTKFile, so it is no VTK XML file",
                   "save it as .vtu, as legacy .vtk or as Gmsh .msh");
  // Without any conversion, so that places in the document are places in the file.
  const auto result = document.load_buffer_inplace(xml.data(), xml.size(), pugi::parse_minimal, pugi::encoding_utf8);
  if (result) return;
  in.cursor.mark_at(std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)), in.bytes.size()));
  in.cursor.fail(fmt::format("this is not well-formed XML ({})", result.description()), kDamaged);
}

void read_storage(Reader& in, const pugi::xml_node& root) {
  in.mark(root);
  const std::string_view order = attribute(root, "byte_order"), sizes = attribute(root, "header_type"),
                         compressor = attribute(root, "compressor");
  if (!order.empty() && order != "LittleEndian" && order != "BigEndian")
    in.cursor.fail(fmt::format("the byte order {} is unknown", shown(order)), kExportAgain);
  if (!sizes.empty() && sizes != "UInt32" && sizes != "UInt64")
    in.cursor.fail(fmt::format("the header type {} is unknown", shown(sizes)), kExportAgain);
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
    in.cursor.fail(fmt::format("the compressor {} is not handled", shown(compressor)),
                   "save it without compression or with zlib");
  in.storage = {order == "BigEndian" ? std::endian::big : std::endian::little, sizes == "UInt64", !compressor.empty()};

  const pugi::xml_node appended = root.child("AppendedData");
  if (!appended) return;
  in.mark(appended);
  const std::string_view encoding = attribute(appended, "encoding");
  if (encoding != "raw" && encoding != "base64")
    in.cursor.fail(fmt::format("the encoding {} of the appended data is unknown", shown(encoding)), kExportAgain);
  in.appended_base64 = encoding == "base64";
}

std::int64_t whole_number(Reader& in, const pugi::xml_node& node, const char* name) {
  in.mark(node);
  const std::string_view text = attribute(node, name);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    in.cursor.fail(fmt::format("{} is {}, not a whole number", name, shown(text)), kExportAgain);
  return value;
}

/// Adds what a piece announces to the sum over all pieces. The sum is bounded as well as each array, since pieces may
/// share arrays: no file needs more elements than zlib can make of its bytes.
void add_count(Reader& in, std::int64_t n, std::int64_t& sum, const char* plural) {
  if (n < 0) in.cursor.fail(fmt::format("the number of {} is {}", plural, n), "the file is damaged, export it again");
  constexpr std::int64_t kMost = std::numeric_limits<Index>::max();
  if (n > kMost - sum)
    in.cursor.fail(fmt::format("{} {} are more than the {} that can be handled", n, plural, kMost - sum),
                   "simplify the model");
  sum += n;
  if (static_cast<std::size_t>(sum) > kMostInflation * in.bytes.size())
    in.cursor.fail(fmt::format("{} {} are announced, but the file has only {} bytes", sum, plural, in.bytes.size()),
                   kDamaged);
}

/// The values of an array that stand within its element. Other elements may stand beside them.
Cursor inline_text(Reader& in, const pugi::xml_node& array) {
  in.mark(array);
  pugi::xml_node text;
  for (const pugi::xml_node& child : array.children()) {
    if (child.type() != pugi::node_pcdata) continue;
    if (text) in.cursor.fail("the values of an array are interrupted", kExportAgain);
    text = child;
  }
  if (!text) in.cursor.fail("the array has no values", kDamaged);
  const std::size_t begin = offset_of(text);
  return in.cursor.within(begin, begin + std::strlen(text.value()), "array");
}

VtkStored appended_at(Reader& in, const pugi::xml_node& array) {
  const std::int64_t offset = whole_number(in, array, "offset");
  if (offset < 0 || static_cast<std::size_t>(offset) > in.appended.size())
    in.cursor.fail(fmt::format("the array is said to begin at byte {} of the appended data, which have {}", offset,
                               in.appended.size()),
                   kDamaged);
  return {in.appended.substr(static_cast<std::size_t>(offset)), in.appended_base64, false};
}

struct Array {
  pugi::xml_node node;
  const char* plural;  ///< what it holds
  std::size_t n;       ///< of these
  std::size_t each;    ///< values of each
};

using Use = std::function<void(Cursor& values, Scalar type)>;

/// Lets `use` read all the values.
void read_text_array(Reader& in, const Array& array, Scalar type, const Use& use) {
  Cursor values = inline_text(in, array.node);
  values.check_count(static_cast<std::int64_t>(array.n), 2 * array.each, array.plural);
  use(values, type);
  if (values.at_end()) return;
  const std::string_view extra = values.word({"a value"});
  values.fail(fmt::format("the array goes on with {} behind its last value", shown(extra)), kExportAgain);
}

void read_binary_array(Reader& in, const Array& array, VtkStored stored, Scalar type, const Use& use) {
  const std::string_view name = attribute(array.node, "Name");
  in.mark(array.node);
  const std::string bytes = decode_vtk_array(stored, in.storage, array.n * array.each * size_of(type), name, in.cursor);
  const std::string where = fmt::format("{}, line {}, array {}", in.name, in.line_of(array.node), shown(name));
  Cursor values(bytes, where);
  values.set_binary(in.storage.order);
  use(values, type);
}

void read_array(Reader& in, const Array& array, const Use& use) {
  in.mark(array.node);
  const auto type = vtk_scalar(attribute(array.node, "type"));
  if (!type)
    in.cursor.fail(fmt::format("the data type {} is not handled", shown(attribute(array.node, "type"))), kExportAgain);
  const std::string_view format = attribute(array.node, "format");
  if (format.empty() || format == "ascii") {
    read_text_array(in, array, *type, use);
  } else if (format == "binary") {
    Cursor text = inline_text(in, array.node);
    read_binary_array(in, array, {text.rest(), true, true}, *type, use);
  } else if (format == "appended") {
    read_binary_array(in, array, appended_at(in, array.node), *type, use);
  } else {
    in.cursor.fail(fmt::format("the format {} of an array is unknown", shown(format)), kExportAgain);
  }
}

void read_points(Reader& in, const pugi::xml_node& piece, std::size_t n) {
  const pugi::xml_node array = piece.child("Points").child("DataArray");
  if (!array) in.cursor.fail("the piece has no array of points", kExportAgain);
  const std::string_view components = attribute(array, "NumberOfComponents");
  in.mark(array);
  if (components != "3")
    in.cursor.fail(fmt::format("the points have {} components, not 3", shown(components)), kExportAgain);
  read_array(in, {array, "points", n, 3}, [&](Cursor& values, Scalar type) {
    for (std::size_t i = 0; i < n; ++i) {
      const Item item{"point", static_cast<std::int64_t>(i)};
      Vec3 p;
      for (int k = 0; k < 3; ++k) p[k] = read_real(values, type, item);
      values.check_finite(p, item);
      in.mesh.vertices.push_back(p);
    }
  });
}

/// `first` is the id that the piece's first point has in the mesh.
void read_cells(Reader& in, const pugi::xml_node& piece, std::size_t n, std::size_t first) {
  const auto array = [&](const char* name, const char* plural, std::size_t values) {
    const auto node = piece.child("Cells").find_child_by_attribute("DataArray", "Name", name);
    in.mark(piece);
    if (!node) in.cursor.fail(fmt::format("the cells have no array {}", shown(name)), kExportAgain);
    return Array{node, plural, values, 1};
  };
  VtkCells cells;
  std::int64_t total = 0;
  read_array(in, array("offsets", "offsets", n), [&](Cursor& values, Scalar type) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t offset = read_integer(values, type, {"an offset"});
      check_vtk_offset(i, offset, total, std::numeric_limits<Index>::max(), values);
      cells.offsets.push_back(static_cast<std::size_t>(offset));
      total = offset;
    }
  });
  const Array connectivity = array("connectivity", "corners", static_cast<std::size_t>(total));
  add_count(in, total, in.corners, "corners");
  const std::size_t points = in.mesh.vertices.size() - first;
  if (total > 0)
    read_array(in, connectivity, [&](Cursor& values, Scalar type) {
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = cells.offsets[i]; k < cells.offsets[i + 1]; ++k) {
          const Item item{"cell", static_cast<std::int64_t>(i)};
          const Index corner = values.check_index(read_integer(values, type, item), points, 0, item, "piece");
          cells.corners.push_back(static_cast<Index>(first) + corner);
        }
    });
  read_array(in, array("types", "cell types", n), [&](Cursor& values, Scalar type) {
    for (std::size_t i = 0; i < n; ++i) {
      const Item item{"cell", static_cast<std::int64_t>(i)};
      add_vtk_cell(read_integer(values, type, item), item, cells[i], values, in.mesh);
    }
  });
}

/// Empty pieces, as parallel programs write them, need no arrays.
void read_piece(Reader& in, const pugi::xml_node& piece) {
  const std::int64_t points = whole_number(in, piece, "NumberOfPoints");
  add_count(in, points, in.points, "points");
  const std::int64_t cells = whole_number(in, piece, "NumberOfCells");
  add_count(in, cells, in.cells, "cells");
  const std::size_t first = in.mesh.vertices.size();
  if (points > 0) read_points(in, piece, static_cast<std::size_t>(points));
  if (cells > 0) read_cells(in, piece, static_cast<std::size_t>(cells), first);
}

}  // namespace

Model parse_vtu(std::string_view bytes, const std::string& name) {
  Reader in{.bytes = bytes, .name = name, .cursor = Cursor(bytes, name), .storage = {}, .appended = {}, .mesh = {}};
  std::string xml = cut_appended(in);
  pugi::xml_document document;
  parse_xml(in, xml, document);
  const pugi::xml_node root = document.child("VTKFile");
  in.mark(root);
  if (attribute(root, "type") != "UnstructuredGrid")
    in.cursor.fail(fmt::format("the dataset {} is not handled", shown(attribute(root, "type"))),
                   "save an unstructured grid of tetrahedra");
  read_storage(in, root);
  for (const pugi::xml_node& piece : root.child("UnstructuredGrid").children("Piece")) read_piece(in, piece);
  return solid_or_surface(std::move(in.mesh), name);
}

}  // namespace matstruct
