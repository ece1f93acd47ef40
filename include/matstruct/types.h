// The plain data that goes in and comes out: surfaces, solids, medial meshes. Indices are 0-based.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <matstruct/vec3.h>

namespace matstruct {

using Index = std::int32_t;
inline constexpr Index kInvalid = -1;

using Edge = std::array<Index, 2>;
using Triangle = std::array<Index, 3>;
using Tetrahedron = std::array<Index, 4>;

/// Triangle mesh. A closed surface has outward normals (counter-clockwise triangles seen from outside).
struct TriSurface {
  std::vector<Vec3> vertices;       ///< #V, input units
  std::vector<Triangle> triangles;  ///< #T, indices into vertices
};

/// Solid as a tetrahedral mesh. Positive orientation: dot(cross(b - a, c - a), d - a) > 0 for a tet (a, b, c, d).
struct TetMesh {
  std::vector<Vec3> vertices;     ///< #V, input units
  std::vector<Tetrahedron> tets;  ///< #T, indices into vertices
};

/// What a medial sphere is. Values are written to .ma and .ply and do not change.
enum class SphereType : std::uint8_t {
  kSheet = 0,      ///< on a sheet, or not classified further
  kSeam = 1,       ///< on a seam (T3)
  kJunction = 2,   ///< at a junction (T4)
  kSharpEdge = 3,  ///< radius 0, on a convex sharp line
  kCorner = 4,     ///< radius 0, at a convex corner
};

/// Medial mesh: vertices are medial spheres, edges medial cones, faces medial slabs.
struct MedialMesh {
  std::vector<Vec3> centers;      ///< #V
  std::vector<double> radii;      ///< #V, >= 0, same units as centers
  std::vector<SphereType> types;  ///< #V
  std::vector<Edge> edges;        ///< #E, i < j, sorted, every edge of every face is present
  std::vector<Triangle> faces;    ///< #F, i < j < k, sorted
};

/// Betti numbers over GF(2): components, tunnels, cavities.
struct Betti {
  Index b0 = 0, b1 = 0, b2 = 0;
  friend constexpr bool operator==(const Betti&, const Betti&) = default;
};

}  // namespace matstruct
