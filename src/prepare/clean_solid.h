// First step of preparation: from any tetrahedral mesh to clean tets in the internal frame.
#pragma once

#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "prepare/domain.h"

namespace matstruct {

/// Tets in the internal frame: no equal vertices, no unused vertices, every tet of strictly positive volume.
struct CleanSolid {
  Frame frame;
  TetMesh mesh;  ///< tets in the order of the input
  std::vector<Index>
      input_vertex;  ///< of each vertex its id in the input (the least one if several were welded), kInvalid if new
};

/// The frames among which clean_solid() chooses, to the last bit: that of exact coordinates, and the one that it tries
/// first if they shall be rounded. The elements must be right. Throws as fit_frame().
std::vector<Frame> frames_of(const TetMesh& solid);

/// Checks the elements of a solid one by one; see prepare_domain() for what is repaired and what is refused. Where
/// rounding would turn a tet over or make two vertices one, coordinates are exact though kRounded was asked for.
CleanSolid clean_solid(const TetMesh& solid, Coordinates coordinates, Context& context);

}  // namespace matstruct
