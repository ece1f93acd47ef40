// Which simplices of the dual complex lie in one sheet.
#pragma once

#include <cstdint>
#include <vector>

#include <matstruct/context.h>

#include "extract/dual.h"
#include "model/spheres.h"
#include "spheres/sheets.h"
#include "spheres/volume_samples.h"

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

/// For comparison, the way of programs before volume samples (MATFP 2022): a cell's contacts are the connected parts of
/// what it holds of the surface, told from the feet of the samples. An edge is valid if all contacts of one end go on
/// into the cell of the other, and has as many; a face is if its edges are and none is on a medial curve. What has no
/// part in the surface is invalid; so is an edge whose cells meet in the depth alone.
SimplexClasses classify_by_surface(const VolumeSamples& samples, const Spheres& spheres, const DualComplex& dual,
                                   const std::vector<Edge>& feature_edges, const Context& context);

}  // namespace matstruct
