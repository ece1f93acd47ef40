// Sharp edges, feature lines and corners of a closed surface.
#pragma once

#include <array>
#include <vector>

#include <matstruct/options.h>
#include <matstruct/solid.h>
#include <matstruct/types.h>

#include "prepare/domain.h"

namespace matstruct {

/// Sharp edges by dihedral angle (options.convex_angle, options.concave_angle), sorted by vertices; lines traced from
/// corners in ascending order, then the closed ones by their least edge. A line that leaves a corner and returns to the
/// same one is not closed: its first and last vertex are equal. Noise is left out, see find_noise_lines(). `diagonal`
/// is that of the surface's bounding box.
/// `points` gives for each vertex the one that stands for its coordinates (Domain::points): features run over these, so
/// that an edge where the solid touches itself is one edge (convex if it is so on either side).
Features detect_features(const TriSurface& surface, const std::vector<Index>& points,
                         const std::vector<std::array<Index, 3>>& neighbors, const std::vector<Vec3>& normals,
                         double diagonal, const Options& options);

/// The same with the sharp lines given, in internal units: edges of `given` are sharp if their true angle is beyond the
/// options' limits or is not known; no other edge is sharp, and none is noise. Which side is the solid's is the mesh's
/// to say; a given edge along which the mesh is flat is no feature. Given edges that the mesh does not have are counted
/// in Features::given_lost, flat ones too.
Features given_features(const TriSurface& surface, const std::vector<Index>& points,
                        const std::vector<std::array<Index, 3>>& neighbors, const std::vector<Vec3>& normals,
                        double diagonal, const Options& options, const std::vector<SharpSegment>& given);

}  // namespace matstruct
