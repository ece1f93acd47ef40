#include "io/vtk_cells.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace matstruct {

namespace {

constexpr const char* kExportAgain = "export the file again";

}  // namespace

std::optional<Scalar> vtk_scalar(std::string_view name) {
  std::string lower(name);
  std::ranges::transform(lower, lower.begin(), lower_case);
  return scalar_of(lower);
}

void check_vtk_offset(std::size_t i, std::int64_t offset, std::int64_t before, std::int64_t most,
                      const Cursor& cursor) {
  if (offset < before || offset > most)
    cursor.fail(fmt::format("offset {} of the cells is {}, which is out of order", i, offset), kExportAgain);
}

void add_vtk_cell(std::int64_t type, Item item, std::span<const Index> corners, const Cursor& cursor, MixedMesh& mesh) {
  enum : std::int64_t { kVertex = 1, kPolyVertex, kLine, kPolyLine, kTriangle, kPolygon = 7, kQuad = 9, kTet = 10 };
  const auto require = [&](std::size_t n) {
    if (corners.size() != n)
      cursor.fail(fmt::format("{} of type {} has {} corners, not {}", item.text(), type, corners.size(), n),
                  kExportAgain);
  };
  switch (type) {
    case kVertex:
    case kPolyVertex:
    case kLine:
    case kPolyLine:
      return;
    case kTriangle:
      require(3);
      break;
    case kPolygon:
      break;
    case kQuad:
      require(4);
      break;
    case kTet:
      require(4);
      return add_tetrahedron({corners[0], corners[1], corners[2], corners[3]}, item, cursor, mesh.tets);
    default:
      cursor.fail(fmt::format("{} has type {}, which is not handled", item.text(), type),
                  "export first-order tetrahedra (type 10) or triangles (type 5)");
  }
  add_polygon(corners, item, cursor, mesh.triangles);
}

}  // namespace matstruct
