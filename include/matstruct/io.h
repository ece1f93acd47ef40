// Readers and writers. Readers validate: whatever they return has in-range indices and finite coordinates. They hold
// the whole file in memory and refuse more than 4 GiB. All functions throw Error with a sentence that begins with the
// file.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/strata.h>
#include <matstruct/types.h>

namespace matstruct {

/// Throws Error if the file does not exist, is empty, too large, a folder or not to be opened.
void check_readable(const std::filesystem::path& file);

/// A tetrahedral mesh: Gmsh .msh (2.2 and 4.1, text and binary), Medit .mesh, legacy .vtk (text and binary), VTK
/// XML .vtu (text, base64 and appended; zlib or no compression; pieces one behind the other). Points, lines and
/// polygons are ignored, other elements than first-order tetrahedra refused. Vertices that no element uses are kept, so
/// that ids are those of the file. Throws Error if the file is missing, empty, truncated, malformed, has NaN or
/// infinite coordinates, indices out of range, or no tetrahedra; the sentence says where in the file.
TetMesh read_tet_mesh(const std::filesystem::path& file);

/// A triangle surface: .stl (text and binary; equal vertices are welded), .obj, .off, .ply (text and binary), and .msh,
/// .mesh, .vtk, .vtu without tetrahedra. Polygons are cut into the fan of triangles around their first corner;
/// triangles that name a vertex twice are left out. Throws Error like read_tet_mesh(), also for point clouds.
TriSurface read_surface(const std::filesystem::path& file);

/// Either kind, told by the extension (of either case) and, for .msh, .mesh, .vtk and .vtu, by the contents
/// (tetrahedra, else triangles). Throws Error like read_tet_mesh(), also for unknown extensions.
std::variant<TetMesh, TriSurface> read_model(const std::filesystem::path& file);

/// The .ma text format: `nv ne nf`, then `v x y z r type`, `e i j`, `f i j k`. Coordinates are written so that they
/// read back to the same bits. The file appears whole or not at all.
void write_ma(const MedialMesh& mesh, const std::filesystem::path& file);
/// Reads .ma, with or without the type column, also the files of earlier programs: unknown types become kSheet, missing
/// edges of faces are added, simplices sorted. Throws Error when malformed.
MedialMesh read_ma(const std::filesystem::path& file);

// A medial mesh with its strata, for other programs. A stratum has one id in all of these: sheets come first, then
// seams, boundaries, medial curves and junctions, each in the order of `strata`. The stratum of a vertex is the least
// of those it lies on: a junction before a seam, a seam before a medial curve, that before a boundary, all before a
// sheet; -1 for a vertex without edges.

/// Binary PLY: vertex x y z radius (double) type (uchar) stratum (int), face vertex_indices sheet (int), edge vertex1
/// vertex2.
void write_ply(const MedialMesh& mesh, const Strata& strata, const std::filesystem::path& file);
/// VTK XML PolyData, binary. Cells: a line for each seam, boundary and medial curve, then a triangle for each face,
/// both in order. Point fields radius (double), type (uchar), stratum (int); cell fields stratum and sheet (int, -1 on
/// lines).
void write_vtp(const MedialMesh& mesh, const Strata& strata, const std::filesystem::path& file);
/// Wavefront OBJ: all vertices, then a group for each stratum: sheet_0 with faces, seam_0, boundary_0 and curve_0 with
/// a line, junction_0 with a point, and so on. Radii have no place in this format.
void write_obj(const MedialMesh& mesh, const Strata& strata, const std::filesystem::path& file);
/// Binary glTF 2.0: sheets in colours, seams, boundaries and medial curves as lines, junctions as points, each kind a
/// node with a primitive for each sheet, or one. Single precision, relative to the middle of the mesh; z is turned to
/// y, which is up in glTF. Vertices have the attribute _RADIUS.
void write_glb(const MedialMesh& mesh, const Strata& strata, const std::filesystem::path& file);
/// Binary PLY of a triangle surface.
void write_ply(const TriSurface& surface, const std::filesystem::path& file);
/// The same with the vertex property distance (double, #V, input units) and colours: blue at 0, yellow at the greatest.
void write_ply(const TriSurface& surface, const std::vector<double>& distances, const std::filesystem::path& file);
/// Gmsh .msh 2.2, binary; nodes and elements numbered from 1 in the order of the mesh.
void write_msh(const TetMesh& mesh, const std::filesystem::path& file);

/// Writes `bytes` to `file` through a temporary file beside it (`file`.part0, or the first number that is free),
/// renamed when complete. Throws Error if that fails, with the reason; then an older `file` is unchanged and the
/// temporary one removed. All writers end here.
void write_whole(const std::filesystem::path& file, const std::string& bytes);

}  // namespace matstruct
