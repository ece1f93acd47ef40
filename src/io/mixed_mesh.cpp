#include "io/mixed_mesh.h"

#include <utility>

#include <fmt/format.h>

#include <matstruct/error.h>

namespace matstruct {

void add_polygon(std::span<const Index> corners, Item item, const Cursor& cursor, std::vector<Triangle>& triangles) {
  if (corners.size() < 3)
    cursor.fail(fmt::format("{} has {} corners, fewer than three", item.text(), corners.size()),
                "remove it or export the file again");
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const Triangle t{corners[0], corners[k], corners[k + 1]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
}

void add_tetrahedron(const Tetrahedron& tet, Item item, const Cursor& cursor, std::vector<Tetrahedron>& tets) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (tet[i] == tet[j])
        cursor.fail(fmt::format("{} is degenerate: it has the same vertex twice", item.text()),
                    "remove it or mesh the model again");
  tets.push_back(tet);
}

Model solid_or_surface(MixedMesh&& mesh, const std::string& name) {
  if (!mesh.tets.empty()) return TetMesh{std::move(mesh.vertices), std::move(mesh.tets)};
  if (!mesh.triangles.empty()) return TriSurface{std::move(mesh.vertices), std::move(mesh.triangles)};
  throw Error(
      fmt::format("{}: the mesh has no tetrahedra and no triangles, only nodes ({} of them); export the "
                  "elements of the volume or of its closed surface, too.",
                  name, mesh.vertices.size()));
}

TriSurface surface_of(MixedMesh&& mesh, const std::string& name) {
  if (!mesh.triangles.empty()) return TriSurface{std::move(mesh.vertices), std::move(mesh.triangles)};
  if (mesh.vertices.empty())
    throw Error(fmt::format("{}: the file holds no vertices and no faces; export a closed triangle surface.", name));
  throw Error(
      fmt::format("{}: the file holds no faces, only points ({} of them), so it is a point cloud; reconstruct "
                  "a closed surface from it first.",
                  name, mesh.vertices.size()));
}

}  // namespace matstruct
