// Remeshing of a medial mesh that keeps its strata: near-equilateral triangles of one size, spheres on the axis.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "extract/stratified_mesh.h"
#include "geometry/primitives.h"

namespace matstruct {

/// What a remeshing asks about the axis. Called from several threads at once; must depend on the arguments alone.
struct AxisOracle {
  /// Distance from a point to the surface of the solid.
  std::function<double(const Vec3& point)> distance;
  /// The medial sphere next to `guess` on the sheet `sheet` (StratifiedMesh::sheet_of_face); `near_vertex`: a vertex of
  /// the input mesh nearby, of that sheet or its border. Nothing if there is none.
  std::function<std::optional<Ball>(const Vec3& guess, Index near_vertex, Index sheet)> on_sheet;
  /// The sphere next to `guess` on the seam, boundary or medial curve that joins two vertices of the input mesh, which
  /// may be equal. May be empty: then curves are not split, and vertices on seams and medial curves do not slide. On
  /// boundaries without an answer they slide with that of on_sheet.
  std::function<std::optional<Ball>(const Vec3& guess, const Edge& near_vertices)> on_curve;
};

struct RemeshOptions {
  double target = 0;  ///< edge length > 0, internal units; shorter near curves whose edges are shorter
  int rounds = 5;     ///< of splits, collapses, flips and smoothing
};

struct RemeshResult {
  MedialMesh mesh;  ///< internal units; first the vertices of the input that are left, in their order, then new ones
  std::vector<Index> vertex_of_input;  ///< #V of the input: vertex of `mesh`, or kInvalid
  std::vector<Index> origin;           ///< #V of `mesh`: vertex of the input, itself or nearby on its sheet or curve
  std::vector<Index> sheet_of_face;    ///< #F of `mesh`: as in the input
  Index splits = 0, collapses = 0, flips = 0, moves = 0;
};

/// The result is homeomorphic to the input, stratum by stratum: Betti numbers, sheets, seams, boundaries, medial curves
/// and junctions (trace_strata()) are the same. Fixed vertices and curve edges between fixed vertices stay. No edit
/// turns a triangle over, leaves a triangle worse than a bound or what was there, or takes faces farther off the axis
/// (interpolated radius against distance, at centroids and middles of edges) than the input was there or a small part
/// of the target. New and moved spheres are what the oracle returns. Linear in the number of faces; the same for any
/// number of threads.
RemeshResult remesh(const StratifiedMesh& input, const AxisOracle& axis, const RemeshOptions& options,
                    const Context& context);

}  // namespace matstruct
