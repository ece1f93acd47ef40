// The restricted power diagram of medial spheres in a solid: how their power cells cut it up.
//
// A cell of the complex is named by a set S of 1 to 4 spheres and a simplex of the tetrahedral mesh: the part of the
// simplex's interior where the power distances to S are least and equal. It is convex, of dimension dim(simplex) + 1 -
// |S|. Names are decided by exact predicates with one global perturbation, so that the complex is consistent between
// neighbouring tetrahedra whatever ties the input has.
#pragma once

#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "prepare/domain.h"
#include "rpd/clipper.h"
#include "rpd/power_triangulation.h"

namespace matstruct {

/// The part of a restricted power cell (RPC) in one tet. `facets`: bit k is set if it reaches the tet's facet k.
/// `euler`: its share of the cell's Euler characteristic; shares of all tets add up to that of the closed cell.
struct RpdCell {
  Index tet = kInvalid;
  Index sphere = kInvalid;
  double volume = 0;
  std::int32_t euler = 0;
  std::uint8_t facets = 0;
};

/// The part of a restricted power facet (RPF, between two cells) in one tet; fields as in RpdCell.
struct RpdFacet {
  Index tet = kInvalid;
  Edge spheres{};  ///< ascending
  double area = 0;
  std::int32_t euler = 0;
  std::uint8_t facets = 0;
};

/// The part of a restricted power edge (RPE, between three cells) in one tet: a segment.
struct RpdEdge {
  Index tet = kInvalid;
  Triangle spheres{};  ///< ascending
  double length = 0;
  std::uint8_t facets = 0;
};

/// A point where four cells meet (RPV), inside one tet.
struct RpdVertex {
  Index tet = kInvalid;
  Tetrahedron spheres{};  ///< ascending
};

/// The stretch of a sharp edge that lies in one cell, from `begin` to `end` (parameters in [0, 1] from the edge's first
/// vertex to its second).
struct RpdStretch {
  Index sharp_edge = kInvalid;
  Index sphere = kInvalid;
  double begin = 0, end = 1;
};

/// Two cells that meet at a point of a sharp edge.
struct RpdCrossing {
  Index sharp_edge = kInvalid;
  Edge spheres{};  ///< ascending
};

/// Records sorted by tet, then by spheres. Those of tet t are start[t] .. start[t + 1] of each array.
struct Rpd {
  std::vector<RpdCell> cells;
  std::vector<RpdFacet> facets;
  std::vector<RpdEdge> edges;
  std::vector<RpdVertex> vertices;
  std::vector<RpdStretch> stretches;
  std::vector<RpdCrossing> crossings;
  /// Start of each tet's records in the six arrays above, in their order; #tets + 1 entries.
  std::vector<std::array<Index, 6>> start;
  /// Share of the whole complex's Euler characteristic, per tet.
  std::vector<std::int32_t> euler;
  /// Number of tets in which clipping closed inconsistently; 0 with exact arithmetic.
  Index broken = 0;
};

/// Sum of the cells' volumes.
double total_volume(const Rpd& rpd);
/// Euler characteristic of the whole complex; equals the solid's.
Index total_euler(const Rpd& rpd);

/// Computes the diagram and keeps it up to date. Cost of compute(): the regular triangulation plus a few microseconds
/// per pair of a tet and a cell that meet; of update(): the same for the tets that the change reaches.
class RpdEngine {
 public:
  /// Keeps a reference to `domain`.
  explicit RpdEngine(const Domain& domain, Arithmetic arithmetic = Arithmetic::kExact);

  /// Diagram of `spheres` (weights r^2), those with ids `absent` left out. Results do not depend on the number of
  /// threads.
  void compute(const std::vector<WeightedPoint>& spheres, const std::vector<Index>& absent, const Context& context);
  void compute(const std::vector<WeightedPoint>& spheres, const Context& context) { compute(spheres, {}, context); }
  /// Removes ids, then inserts new ones; `spheres` holds all ids ever given, old ones unchanged. The diagram is then
  /// the same as that of compute() on the remaining spheres.
  void update(const std::vector<WeightedPoint>& spheres, const std::vector<Index>& inserted,
              const std::vector<Index>& removed, const Context& context);

  const Rpd& diagram() const { return rpd_; }
  const std::vector<WeightedPoint>& spheres() const { return spheres_; }
  /// Of each sphere, whether it has a power cell in space. One without is no vertex of the dual; one with a cell may
  /// still miss the solid.
  const std::vector<bool>& visible() const { return triangulation_.visible(); }
  /// Neighbours in the regular triangulation, as CSR; in space, hence also across voids of the solid.
  const PowerTriangulation::Neighbors& neighbors() const { return triangulation_.neighbors(); }
  /// Clips again the piece of `sphere` in `tet`, for its geometry; the record exists in diagram().cells.
  void piece(Index tet, Index sphere, Clipper& clipper) const;

 private:
  struct TetTables;
  struct Worker;
  void clip_tets(const std::vector<Index>& tets, const Context& context);
  std::vector<Index> reached_tets(const std::vector<Index>& removed, const std::vector<bool>& visible_before,
                                  const Context& context) const;
  void locate_seeds(const std::vector<Index>& tets, const Context& context);
  void find_bisectors(const Context& context);
  std::span<const Index> neighbors_of(Index sphere) const;
  std::span<const Bisector> bisectors_of(Index sphere) const;
  std::array<Vec3, 4> corners_of(Index tet) const;

  const Domain& domain_;
  Arithmetic arithmetic_;
  std::shared_ptr<const TetTables> tables_;
  PowerTriangulation triangulation_;
  std::vector<WeightedPoint> spheres_;
  std::vector<Bisector> bisectors_;  // with each sphere's neighbours in the triangulation, in their order
  std::vector<Index> seeds_;         // per solid vertex: the sphere nearest in power distance
  Rpd rpd_;
};

}  // namespace matstruct
