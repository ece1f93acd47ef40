// CAD files as closed triangle surfaces, one per solid.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/solid.h>
#include <matstruct/types.h>

namespace matstruct {

struct CadSolid {
  std::string name;                 ///< of the part in the file, may be empty
  TriSurface surface;               ///< conforming, outward; open if the file's faces are
  std::vector<SharpSegment> edges;  ///< pieces of all CAD edges, smooth ones too, with their true dihedral angles
  double deviation_percent = 0;     ///< measured between triangles and CAD surface, % of the bounding box's diagonal
};

struct CadModel {
  std::vector<CadSolid> solids;  ///< at least one
  std::string note;              ///< a sentence for the report, may be empty
};

/// Tessellates the solids of a STEP or BREP file, in the file's units, by OpenCASCADE in a child process. `deflection`
/// as in ReadOptions. Throws Error if the file is damaged, has no faces, or OpenCASCADE fails.
CadModel read_cad_model(const std::filesystem::path& file, double deflection, Context& context);

}  // namespace matstruct
