// From a file of any kind to solids: tetrahedra, what is known about their sharp lines, and what had to be repaired.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

namespace matstruct {

/// A straight piece of a sharp line that is known beforehand, from a CAD model or a file. By coordinates, so that it
/// survives welding and renumbering.
struct SharpSegment {
  Vec3 a, b;  ///< vertices of the solid's boundary, input units
  /// The true interior dihedral angle in radians, which the options' limits judge; none: sharp whatever the angle.
  std::optional<double> dihedral{};
};

/// How files are turned into solids. Ranges are what validate() accepts.
struct ReadOptions {
  double deflection = 5e-4;  ///< CAD: triangles are nowhere farther from the surface, in diagonals; in [1e-6, 0.1]
  double tet_size = 0;       ///< greatest length of edges inside, in diagonals; 0 = as coarse as the surface allows
  double hole_size = 0.05;   ///< holes of surfaces up to this diameter, in diagonals, may be filled; in [0, 1]
  bool allow_wrap = false;   ///< a surface that nothing else can close may be wrapped, which rounds its edges
  double wrap_size = 0.01;   ///< openings narrower than this, in diagonals, are wrapped over; in [1e-3, 0.5]
  /// The triangles and tets of a mesh file stay. Else flat faces are triangulated anew, so that the result does not
  /// depend on how the file has them, and solids of tets are filled anew over their boundary.
  bool keep_triangles = false;
  /// Text file of sharp lines, see read_sharp_lines(); empty: from the CAD model, else by angle.
  std::filesystem::path features{};

  /// Throws Error naming the first field that is out of its range.
  void validate() const;
};

/// What was done to a surface to get a solid, and its effect.
struct Repair {
  std::vector<std::string> steps;         ///< in their order; empty if the surface was taken as it is
  double volume_change_percent = 0;       ///< signed, of the enclosed volume before; NaN if nothing was enclosed
  double distance_percent = 0;            ///< greatest distance of the result to the input, % of the diagonal
  double sharp_edges_kept_percent = 100;  ///< of the length of the input's sharp edges; NaN if it had none
};

struct Solid {
  std::string name;  ///< of the part in an assembly; empty if it has none or is alone in its file
  TetMesh mesh;
  /// The sharp lines, if known: then no other edge is sharp. Else they are found by angle.
  std::optional<std::vector<SharpSegment>> sharp;
  Repair repair;
  double deviation_percent = 0;  ///< of CAD: measured distance of triangles and surface, % of the diagonal
  double seconds = 0;            ///< reading and tetrahedralising, wall clock
  std::vector<std::string> warnings;

  const std::vector<SharpSegment>* known_sharp() const { return sharp ? &*sharp : nullptr; }
};

/// True for .step, .stp, .brep and .brp, of either case.
bool is_cad_file(const std::filesystem::path& file);

/// All solids of a file, at least one. Tetrahedral meshes are filled anew over their boundary (unless
/// ReadOptions::keep_triangles, or if that fails); closed surfaces are tetrahedralised. Each is one solid,
/// whatever number of components it has; the solids of a STEP or BREP file are tessellated and tetrahedralised one by
/// one. Surfaces that bound no solid are repaired, see docs/design/prepare.md. Throws Error if the file is refused,
/// nothing makes a solid of it, or the mesher is missing; Cancelled if the context says so.
std::vector<Solid> read_solids(const std::filesystem::path& file, const ReadOptions& options, Context& context);

/// Sharp lines from a text file: each line is a polyline of two or more vertex ids, counted from 0 in the order of the
/// model's file (in STL equal vertices are one, in order of their first appearance); `#` begins a comment. Throws Error
/// naming the line of text for words that are no ids and ids out of range.
std::vector<Edge> read_sharp_lines(const std::filesystem::path& file, Index vertices);

}  // namespace matstruct
