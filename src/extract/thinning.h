// Thinning of the dual complex to a medial mesh by elementary collapses, which keep its homotopy type.
//
// A simplex is free if exactly one simplex of the next dimension contains it; removing both is an elementary collapse.
// Since the dual complex is embedded in space, every set of tetrahedra has a free face: no tetrahedron remains.
#pragma once

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "extract/classify.h"
#include "extract/dual.h"
#include "model/spheres.h"
#include "prepare/domain.h"

namespace matstruct {

struct ThinningOptions {
  /// Free faces of less importance are removed. The importance of a face is the length of its restricted power edge
  /// over twice the mean radius of its corners, feature spheres not counted (MATTopo 2024); in [0, 1].
  double importance = 0.3;
  /// An invalid edge that ends freely goes if the ball at its end sticks out of the other one by no more than this;
  /// internal units.
  double cover = 0;
};

struct ThinMesh {
  MedialMesh mesh;                          ///< internal units
  std::vector<Index> spheres;               ///< #V: the sphere behind each vertex, ascending
  std::vector<std::uint8_t> edge_contacts;  ///< #E: as in SimplexClasses; 0: invalid, but could not be collapsed
  std::vector<std::uint8_t> face_invalid;   ///< #F: 1 if it is invalid but could not be collapsed
};

/// The invalid edges of no face (as `loose`) or of faces, as pairs of spheres, sorted.
struct InvalidEdges {
  std::vector<Edge> loose, shortcuts;
};
InvalidEdges invalid_edges(const ThinMesh& thin);

/// `feature_edges`: ascending pairs of spheres along feature lines, sorted; they and their ends are never removed.
/// `medial`: by sphere, where its vertex shall be. Tetrahedra go first, through a free face that is invalid or, if all
/// are valid, lies farthest from the medial axis (interpolated radius against distance to the surface); then invalid
/// faces through their free edges, invalid edges first; then invalid edges that end freely, with their ends; then free
/// faces of little importance.
ThinMesh thin(const Domain& domain, const Spheres& spheres, const std::vector<TangentSphere>& medial,
              const DualComplex& dual, const SimplexClasses& classes, const std::vector<Edge>& feature_edges,
              const ThinningOptions& options, const Context& context);

}  // namespace matstruct
