// What the legacy and the XML files of VTK have in common: cells, their types, and the names of types of numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "io/cursor.h"
#include "io/mixed_mesh.h"
#include "io/scalar.h"

namespace matstruct {

/// Cell i has the corners [offsets[i], offsets[i + 1]).
struct VtkCells {
  std::vector<std::size_t> offsets{0};
  std::vector<Index> corners;

  std::size_t size() const { return offsets.size() - 1; }
  std::span<const Index> operator[](std::size_t i) const {
    return std::span(corners).subspan(offsets[i], offsets[i + 1] - offsets[i]);
  }
};

/// The type of a name in letters of either case.
std::optional<Scalar> vtk_scalar(std::string_view name);

/// Fails unless offset `i` of the cells lies in [before, most].
void check_vtk_offset(std::size_t i, std::int64_t offset, std::int64_t before, std::int64_t most, const Cursor& cursor);

/// Adds a tetrahedron or the triangles of a polygon, and passes over points and lines; fails for other types, wrong
/// numbers of corners and tetrahedra that name a vertex twice.
void add_vtk_cell(std::int64_t type, Item item, std::span<const Index> corners, const Cursor& cursor, MixedMesh& mesh);

}  // namespace matstruct
