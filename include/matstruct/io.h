// Readers and writers. Readers validate: whatever they return has in-range indices and finite coordinates. They hold
// the whole file in memory and refuse more than 4 GiB. All functions throw Error with a sentence that begins with the
// file.
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include <matstruct/context.h>
#include <matstruct/types.h>

namespace matstruct {

/// Throws Error if the file does not exist, is empty, too large, a folder or not to be opened.
void check_readable(const std::filesystem::path& file);

/// A tetrahedral mesh: Gmsh .msh (2.2 and 4.1, text and binary), Medit .mesh, legacy .vtk (text and binary). Points,
/// lines and polygons are ignored, other elements than first-order tetrahedra refused. Vertices that no element uses
/// are kept, so that ids are those of the file. Throws Error if the file is missing, empty, truncated, malformed, has
/// NaN or infinite coordinates, indices out of range, or no tetrahedra; the sentence says where in the file.
TetMesh read_tet_mesh(const std::filesystem::path& file);

/// A triangle surface: .stl (text and binary; equal vertices are welded), .obj, .off, .ply (text and binary), and .msh,
/// .mesh, .vtk without tetrahedra. Polygons are cut into the fan of triangles around their first corner; triangles that
/// name a vertex twice are left out. Throws Error like read_tet_mesh(), also for point clouds.
TriSurface read_surface(const std::filesystem::path& file);

/// Either kind, told by the extension (of either case) and, for .msh, .mesh and .vtk, by the contents (tetrahedra, else
/// triangles). Throws Error like read_tet_mesh(), also for unknown extensions.
std::variant<TetMesh, TriSurface> read_model(const std::filesystem::path& file);

/// The .ma text format: `nv ne nf`, then `v x y z r type`, `e i j`, `f i j k`. Coordinates are written so that they
/// read back to the same bits. The file appears whole or not at all.
void write_ma(const MedialMesh& mesh, const std::filesystem::path& file);
/// Reads .ma, with or without the type column, also the files of earlier programs: unknown types become kSheet, missing
/// edges of faces are added, simplices sorted. Throws Error when malformed.
MedialMesh read_ma(const std::filesystem::path& file);
/// Binary PLY: vertex x y z radius (double) type (uchar), face vertex_indices, edge vertex1 vertex2.
void write_ply(const MedialMesh& mesh, const std::filesystem::path& file);
/// Binary PLY of a triangle surface.
void write_ply(const TriSurface& surface, const std::filesystem::path& file);
/// Gmsh .msh 2.2, binary; nodes and elements numbered from 1 in the order of the mesh.
void write_msh(const TetMesh& mesh, const std::filesystem::path& file);

/// Writes `bytes` to `file` through a temporary file beside it (`file`.part0, or the first number that is free),
/// renamed when complete. Throws Error if that fails, with the reason; then an older `file` is unchanged and the
/// temporary one removed. All writers end here.
void write_whole(const std::filesystem::path& file, const std::string& bytes);

}  // namespace matstruct
