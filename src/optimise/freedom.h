// In which directions a medial sphere may move and stay medial, and the spherical quadric of its cell.
//
// The SQEM (spherical quadric error metric; Thiery et al. 2013) of a sphere (theta, r) sums ((p_k - theta).n_k - r)^2
// over the samples of its cell, feet p_k with normals n_k: how far the sphere is from touching all their planes. What
// it leaves free is how the sphere can slide: on a sheet in a plane, on a seam along a line.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <matstruct/context.h>

#include "geometry/primitives.h"
#include "optimise/projector.h"
#include "spheres/cell_contacts.h"
#include "spheres/volume_samples.h"

namespace matstruct {

enum class Freedom : std::uint8_t {
  kFixed,  ///< rank 4: touches four ways, a junction
  kLine,   ///< rank 3: a seam or a medial curve
  kPlane,  ///< rank 2: a sheet
  kLost,   ///< rank 1 or no sample: the cell sees one side only; to be shrunk anew, not to be moved
};

struct SphereFreedom {
  Freedom kind = Freedom::kLost;
  Projector free = kNoDirection;  ///< on the directions in which the centre may move
  Ball solution;                  ///< least SQEM, by the least move of (centre, radius); the old sphere if lost
  double error = 0;               ///< root mean square of the SQEM's terms at the solution
};

struct FreedomOptions {
  /// An eigenvalue counts if it is at least this times the greatest. Two planes at the angle a have (1 - cos a) / (3 +
  /// cos a): the default tells planes at 12 degrees.
  double rank = 0.005;
  /// A cluster whose mean normal is shorter than this is bent so much that its samples give rank of their own, like the
  /// ring around the axis of a cylinder; others are one plane each. An arc of 130 degrees has 0.8. The only cluster of
  /// a cell, as near the rounded end of a plate, always counts as bent.
  double bent = 0.8;
};

/// Freedom of each sphere. The rank is that of one mean plane per cluster of the sphere's cell, never more than the
/// number of clusters unless one is bent, nor than `most_rank` where that is not empty (an entry per sphere, 1 to 4:
/// 2 for a sheet sphere, 3 for a seam sphere); the samples decide the place. A cell with one
/// contact is where a sheet ends freely: its sphere slides along that end only, kLine, or stays. In coordinates centred
/// at each sphere, and normalised by the number of samples, so that rank does not depend on place, scale or density.
/// `spheres`: one per cell of `contacts`.
std::vector<SphereFreedom> sphere_freedoms(const VolumeSamples& samples, const CellContacts& contacts,
                                           std::span<const Ball> spheres, std::span<const std::int8_t> most_rank,
                                           const FreedomOptions& options, const Context& context);

}  // namespace matstruct
