// Which simplices of the dual complex lie in one sheet.
#pragma once

#include <cstdint>
#include <vector>

#include <matstruct/context.h>

#include "extract/dual.h"
#include "spheres/sheets.h"

namespace matstruct {

struct SimplexClasses {
  /// #edges: contacts that the middle of the edge has with both ends: 0 invalid, 1 on a medial curve, 2 within a sheet
  /// (or on a sharp line), 3 or more on a seam.
  std::vector<std::uint8_t> edge_contacts;
  std::vector<std::uint8_t> face_valid;  ///< #triangles: within one sheet, and so are its edges
};

/// `spheres` by id, with their contacts; `feature_edges` (sorted) are valid whatever their contacts. In parallel; cost
/// of a handful of walks over the surface per simplex.
SimplexClasses classify(FinderPool& finders, const std::vector<TangentSphere>& spheres, const DualComplex& dual,
                        const std::vector<Edge>& feature_edges, const Context& context);

/// For smooth shapes, whose noise would make seams of every bump: an edge or face is valid if the ball in its middle
/// sticks out of the solid by no more than `overshoot` (internal units) and it is no face between three spheres on a
/// medial curve. No edge counts as inside a sheet.
SimplexClasses classify_smooth(FinderPool& finders, const std::vector<TangentSphere>& spheres, const DualComplex& dual,
                               double overshoot, const Context& context);

}  // namespace matstruct
