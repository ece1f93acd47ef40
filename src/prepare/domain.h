// The solid as every later stage sees it: normalised, validated, with adjacency, sharp features and queries. Immutable.
#pragma once

#include <array>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/options.h>
#include <matstruct/solid.h>
#include <matstruct/types.h>

#include "prepare/frame.h"
#include "query/surface_query.h"

namespace matstruct {

enum class EdgeKind : std::uint8_t { kSmooth, kConvex, kConcave };

/// A sharp edge of the boundary surface.
struct SharpEdge {
  Edge vertices;                      ///< surface vertices, lower id first
  EdgeKind kind = EdgeKind::kSmooth;  ///< kConvex or kConcave
  double dihedral = 0;                ///< interior dihedral angle, radians in (0, 2 pi)
  std::array<Index, 2> triangles{};   ///< the two surface triangles that meet at it
  Index line = kInvalid;              ///< the feature line it belongs to
};

/// A chain of sharp edges of one kind between corners, or a closed one without corners.
struct FeatureLine {
  EdgeKind kind = EdgeKind::kConvex;
  bool closed = false;
  std::vector<Index> vertices;  ///< surface vertices in order; of a closed line the first is not repeated
  std::vector<Index> edges;     ///< sharp edges in order: edge k joins vertex k and vertex k + 1 (cyclic if closed)
};

/// Sharp features of the boundary surface.
struct Features {
  std::vector<SharpEdge> edges;
  std::vector<FeatureLine> lines;
  std::vector<Index> corners;  ///< surface vertices where lines end, meet or turn sharply, ascending
  std::vector<std::array<Index, 3>>
      triangle_edges;         ///< #triangles x 3: sharp edge opposite local vertex k, or kInvalid
  Index noise_edges = 0;      ///< edges sharp by their angle that are left out as noise, so count as smooth
  bool mostly_noise = false;  ///< much of what is sharp by its angle is noise: a scan
  double noise_height = 0;    ///< of a scan: bumps up to it are noise; internal units
  Index given_lost = 0;       ///< given sharp edges that are no edges of the surface or lie flat in it
};

struct Domain {
  Frame frame;
  double diagonal = 0;  ///< of the bounding box, internal units
  double volume = 0;    ///< internal units
  Betti topology;       ///< of the solid, where it touches itself cut apart: components, tunnels, cavities
  Index euler = 0;      ///< Euler characteristic of the solid as it is, touching itself or not

  /// Internal units. The vertices on the boundary come first, so that surface and solid share vertex ids.
  TetMesh solid;
  /// Per solid vertex the least vertex with the same coordinates: itself, except where the solid touches itself and was
  /// cut apart. Copies are one point of the solid, but several of its manifold boundary.
  std::vector<Index> points;
  std::vector<std::array<Index, 4>> tet_neighbors;  ///< tet across the facet opposite local vertex k, kInvalid outside
  std::vector<std::array<Index, 4>> tet_triangles;  ///< surface triangle on that facet, kInvalid inside

  TriSurface surface;                                    ///< boundary, outward normals, internal units
  std::vector<Index> triangle_tets;                      ///< the tet behind each surface triangle
  std::vector<std::array<Index, 3>> triangle_neighbors;  ///< triangle across the edge opposite local vertex k
  std::vector<Vec3> triangle_normals;                    ///< unit, outward
  std::vector<Vec3> unrounded;  ///< the surface's vertices as the frame maps them without rounding, internal units
  Features features;
  SurfaceQuery query;  ///< on `surface`
};

/// Volume of all tets, whichever way round they are.
double volume_of(const TetMesh& mesh);

/// Checks and prepares a solid. Every sign is decided exactly. Throws Error, naming elements and coordinates, for: no
/// tets, indices out of range, NaN or infinite coordinates, tets of zero volume, an inverted mix of orientations that
/// cannot be repaired by flipping single tets, a facet shared by more than two tets, two voids that touch in a vertex
/// inside the solid. Unused vertices are dropped; negative tets are flipped and a warning says so. Duplicated vertices
/// (equal coordinates) are welded. After that, a solid that touches itself in vertices or edges is cut apart there, and
/// a warning says so: the domain then has vertices of equal coordinates, and its boundary is a 2-manifold (each edge
/// has two triangles, the triangles at each vertex form one fan). Several components and inner cavities are accepted.
/// Lines that are noise are no features; if much is noise, a warning says so. With `given` sharp lines (input units) no
/// others are looked for, see given_features(). Coordinates are rounded if that is asked for and turns no tet over.
Domain prepare_domain(const TetMesh& solid, const Options& options, Context& context,
                      const std::vector<SharpSegment>* given = nullptr, Coordinates coordinates = Coordinates::kExact);

}  // namespace matstruct
