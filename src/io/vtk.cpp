// Legacy VTK ("VTK file formats", Kitware), text and binary: unstructured grids and polygonal data, with cells written
// either as "n i j k ..." (up to version 5.0) or as offsets and connectivity (from 5.1). Attributes are passed over.
#include <bit>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/cursor.h"
#include "io/mixed_mesh.h"
#include "io/parsers.h"
#include "io/scalar.h"
#include "io/vtk_cells.h"

namespace matstruct {

namespace {

constexpr const char* kExportAgain = "export the file again";

struct Reader {
  Cursor cursor;
  MixedMesh mesh;
  VtkCells cells;
  bool binary = false;
  bool has_points = false;

  /// The words of a section's header end with their line; values follow.
  void begin_values() {
    cursor.line();
    if (binary) cursor.set_binary(std::endian::big);
  }
  void end_values() { cursor.set_text(); }
};

Scalar read_type(Cursor& cursor) {
  const std::string_view name = cursor.word({"a data type"});
  const auto type = vtk_scalar(name);
  if (!type) cursor.fail(fmt::format("the data type {} is not handled", shown(name)), kExportAgain);
  return *type;
}

void read_points(Reader& in) {
  if (in.has_points) in.cursor.fail("there is a second section of points", kExportAgain);
  in.has_points = true;
  const std::int64_t announced = in.cursor.integer({"the number of points"});
  const Scalar type = read_type(in.cursor);
  in.begin_values();
  const std::size_t n = in.cursor.check_count(announced, 3 * least_bytes(in.cursor, type), "points");
  in.mesh.vertices.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Item item{"point", static_cast<std::int64_t>(i)};
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = read_real(in.cursor, type, item);
    in.cursor.check_finite(p, item);
    in.mesh.vertices.push_back(p);
  }
  in.end_values();
}

/// "n i j k ..." per cell; the total counts all these numbers.
VtkCells read_counted_cells(Reader& in, std::int64_t announced, std::int64_t announced_total) {
  if (in.binary) in.cursor.set_binary(std::endian::big);
  const std::size_t n = in.cursor.check_count(announced, in.binary ? 4 : 2, "cells");
  const std::size_t total = in.cursor.check_count(announced_total, in.binary ? 4 : 2, "numbers of cells");
  VtkCells cells;
  cells.offsets.reserve(n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const Item item{"cell", static_cast<std::int64_t>(i)};
    const std::size_t corners = in.cursor.check_count(in.cursor.integer(item), in.binary ? 4 : 2, "corners of a cell");
    for (std::size_t k = 0; k < corners; ++k)
      cells.corners.push_back(in.cursor.check_index(in.cursor.integer(item), in.mesh.vertices.size(), 0, item));
    cells.offsets.push_back(cells.corners.size());
  }
  if (cells.corners.size() + n != total)
    in.cursor.fail(fmt::format("the cells take {} numbers, but {} are announced", cells.corners.size() + n, total),
                   kExportAgain);
  in.end_values();
  return cells;
}

/// The arrays OFFSETS, one more than there are cells, and CONNECTIVITY.
VtkCells read_offset_cells(Reader& in, std::int64_t announced, std::int64_t announced_total) {
  VtkCells cells;
  in.cursor.expect("OFFSETS");
  const Scalar offset_type = read_type(in.cursor);
  in.begin_values();
  const std::size_t n = in.cursor.check_count(announced, least_bytes(in.cursor, offset_type), "offsets");
  std::vector<std::int64_t> offsets;
  for (std::size_t i = 0; i < n; ++i) offsets.push_back(read_integer(in.cursor, offset_type, {"an offset"}));
  in.end_values();

  in.cursor.expect("CONNECTIVITY");
  const Scalar type = read_type(in.cursor);
  in.begin_values();
  const std::size_t total = in.cursor.check_count(announced_total, least_bytes(in.cursor, type), "corners");
  const Item corner{"the connectivity"};
  for (std::size_t k = 0; k < total; ++k)
    cells.corners.push_back(
        in.cursor.check_index(read_integer(in.cursor, type, corner), in.mesh.vertices.size(), 0, corner));
  for (std::size_t i = 0; i < n; ++i) {
    check_vtk_offset(i, offsets[i], i == 0 ? 0 : offsets[i - 1], i == 0 ? 0 : announced_total, in.cursor);
    if (i > 0) cells.offsets.push_back(static_cast<std::size_t>(offsets[i]));
  }
  in.end_values();
  return cells;
}

VtkCells read_cells(Reader& in) {
  if (!in.has_points) in.cursor.fail("the cells come before the points", kExportAgain);
  const std::int64_t n = in.cursor.integer({"the number of cells"});
  const std::int64_t total = in.cursor.integer({"the size of the cells"});
  in.cursor.line();
  const bool offsets = in.cursor.rest().substr(0, 7) == "OFFSETS";
  return offsets ? read_offset_cells(in, n, total) : read_counted_cells(in, n, total);
}

void read_cell_types(Reader& in) {
  const std::int64_t announced = in.cursor.integer({"the number of cell types"});
  in.begin_values();
  const std::size_t n = in.cursor.check_count(announced, in.binary ? 4 : 2, "cell types");
  if (n != in.cells.size())
    in.cursor.fail(fmt::format("there are {} cell types for {} cells", n, in.cells.size()), kExportAgain);
  for (std::size_t i = 0; i < n; ++i) {
    const Item item{"cell", static_cast<std::int64_t>(i)};
    add_vtk_cell(in.cursor.integer(item), item, in.cells[i], in.cursor, in.mesh);
  }
  in.end_values();
}

void read_polygons(Reader& in) {
  const VtkCells polygons = read_cells(in);
  for (std::size_t i = 0; i < polygons.size(); ++i)
    add_polygon(polygons[i], {"polygon", static_cast<std::int64_t>(i)}, in.cursor, in.mesh.triangles);
}

/// Arrays of a dataset as a whole, such as the time of a simulation.
void skip_field(Reader& in) {
  in.cursor.word({"the name of a field"});
  const std::int64_t announced = in.cursor.integer({"the number of arrays of a field"});
  const std::size_t arrays = in.cursor.check_count(announced, 2, "arrays");
  for (std::size_t a = 0; a < arrays; ++a) {
    const Item item{"an array of a field"};
    in.cursor.word(item);
    const std::size_t components = in.cursor.check_count(in.cursor.integer(item), 1, "components");
    const std::size_t tuples = in.cursor.check_count(in.cursor.integer(item), 1, "tuples");
    const Scalar type = read_type(in.cursor);
    in.begin_values();
    const auto announced_values = static_cast<std::int64_t>(components * tuples);  // both are below 2^31
    const std::size_t values = in.cursor.check_count(announced_values, least_bytes(in.cursor, type), "values");
    if (in.binary)
      in.cursor.skip(values * size_of(type), item);
    else
      for (std::size_t k = 0; k < values; ++k) in.cursor.word(item);
    in.end_values();
  }
}

/// Ends with an empty line.
void skip_metadata(Cursor& cursor) {
  cursor.line();
  while (cursor.remaining() > 0 && !cursor.line().at_end()) continue;
}

/// Returns false when what follows is not needed.
bool read_section(Reader& in) {
  const std::string_view section = in.cursor.word({"a section"});
  if (section == "POINTS")
    read_points(in);
  else if (section == "CELLS")
    in.cells = read_cells(in);
  else if (section == "CELL_TYPES")
    read_cell_types(in);
  else if (section == "POLYGONS")
    read_polygons(in);
  else if (section == "VERTICES" || section == "LINES")
    read_cells(in);
  else if (section == "FIELD")
    skip_field(in);
  else if (section == "METADATA")
    skip_metadata(in.cursor);
  else if (section == "CELL_DATA" || section == "POINT_DATA")
    return false;
  else
    in.cursor.fail(fmt::format("the section {} is not handled", shown(section)), kExportAgain);
  return true;
}

void read_header(Reader& in) {
  if (in.cursor.rest().substr(0, 22) != "# vtk DataFile Version")
    in.cursor.fail("the file does not begin with '# vtk DataFile Version', so it is no legacy VTK file",
                   "save it as legacy .vtk, Gmsh .msh or STL");
  in.cursor.line();
  in.cursor.line();  // the title
  in.binary = in.cursor.accept("BINARY");
  if (!in.binary) in.cursor.expect("ASCII");
  in.cursor.expect("DATASET");
  if (!in.cursor.accept("UNSTRUCTURED_GRID") && !in.cursor.accept("POLYDATA"))
    in.cursor.fail(fmt::format("the dataset {} is not handled", shown(in.cursor.peek())),
                   "save an unstructured grid of tetrahedra or the polygons of a surface");
}

}  // namespace

Model parse_vtk(std::string_view bytes, const std::string& name) {
  Reader in{.cursor = Cursor(bytes, name), .mesh = {}, .cells = {}};
  read_header(in);
  while (!in.cursor.at_end() && read_section(in)) continue;
  return solid_or_surface(std::move(in.mesh), name);
}

}  // namespace matstruct
