// Strata of a thin mesh that are there or not by chance: whether a few spheres of a sheet's end meet another sheet.
#pragma once

#include <vector>

#include <matstruct/types.h>

namespace matstruct {

struct SmallStrataOptions {
  double spacing = 0;                ///< of the spheres, internal units
  double cover = 0;                  ///< how far what is removed may stick out of the rest, internal units
  double resolution = 0;             ///< smaller structure is not the solid's but its facets', internal units
  std::vector<Index> contacts = {};  ///< #V: contacts in clearly different directions; empty: not known
  /// #V: between facets that turn by less than a strong sharp edge, and on no medial curve; empty: not known
  std::vector<std::uint8_t> faint = {};
};

/// Removes sheets with a free border that are no larger than a few triangles, slivers between seams that run side by
/// side, seams with a free end that are no longer than about an edge, seams between junctions that are shorter than the
/// resolution, seams and junctions of spheres with too few contacts, and curves of a few edges with a free end, if the
/// rest of the mesh covers them; and all curves of faint spheres that have one free end: by elementary collapses, or by
/// contracting edges under the link condition. Both keep the homotopy type. `fixed_edges`: ascending pairs of vertices,
/// sorted; they and their ends stay, and so do spheres on sharp lines. Returns the vertices of the input that are left,
/// ascending; those are numbered anew.
std::vector<Index> drop_small_strata(MedialMesh& mesh, const std::vector<Edge>& fixed_edges,
                                     const SmallStrataOptions& options);

}  // namespace matstruct
