// CAD files as lists of named solids.
#pragma once

#include <string>
#include <vector>

#include <TopoDS_Shape.hxx>

namespace matstruct::mesher {

struct CadSolid {
  std::string name;  ///< of the part in the file, may be empty
  TopoDS_Shape shape;
};

struct CadFile {
  std::vector<CadSolid> solids;  ///< in the file's units, each in its place in the assembly
  std::string note;              ///< what had to be done to find them; empty if nothing
};

/// Reads .brep, .brp, .step or .stp, told by the extension. If a file has no solids, faces are sewn and closed shells
/// taken for solids; if there are none of these either, all faces together are the one entry. Throws std::runtime_error
/// with a phrase, or what OpenCASCADE throws.
CadFile read_cad_file(const std::string& file);

}  // namespace matstruct::mesher
