// Small solids with known volume, topology and features, made by simple code that shares nothing with the library.
// Grid-like ones are cubes cut into 6 tets each (Kuhn), the others sweeps of a triangulated section, or a fan of tets
// from an inner point to the faces of a convex polyhedron. All tets are positive.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <matstruct/types.h>

namespace matstruct::shapes {

inline double signed_volume(const TetMesh& mesh, const Tetrahedron& t) {
  const auto p = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  return dot(cross(p(1) - p(0), p(2) - p(0)), p(3) - p(0)) / 6;
}

inline double volume(const TetMesh& mesh) {
  double sum = 0;
  for (const Tetrahedron& t : mesh.tets) sum += signed_volume(mesh, t);
  return sum;
}

inline TetMesh positive(TetMesh mesh) {
  for (Tetrahedron& t : mesh.tets)
    if (signed_volume(mesh, t) < 0) std::swap(t[2], t[3]);
  return mesh;
}

inline TetMesh transformed(TetMesh mesh, const std::function<Vec3(Vec3)>& map) {
  for (Vec3& p : mesh.vertices) p = map(p);
  return positive(std::move(mesh));
}

/// Both meshes, nothing merged.
inline TetMesh together(TetMesh a, const TetMesh& b) {
  const Index shift = static_cast<Index>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (Tetrahedron t : b.tets) {
    for (Index& v : t) v += shift;
    a.tets.push_back(t);
  }
  return a;
}

/// Facets that belong to one tet only, outward; all vertices are kept, used or not.
inline TriSurface boundary(const TetMesh& mesh) {
  constexpr std::array<std::array<std::size_t, 3>, 4> kFacets = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  std::map<Triangle, std::vector<Triangle>> facets;
  for (const Tetrahedron& t : mesh.tets)
    for (const auto& f : kFacets) {
      const Triangle facet = {t[f[0]], t[f[1]], t[f[2]]};
      Triangle key = facet;
      std::sort(key.begin(), key.end());
      facets[key].push_back(facet);
    }
  TriSurface surface{.vertices = mesh.vertices, .triangles = {}};
  for (const auto& [key, users] : facets)
    if (users.size() == 1) surface.triangles.push_back(users.front());
  return surface;
}

/// The cells (i, j, k) of a grid for which `solid(i, j, k)`; x, y, z are the ascending coordinates of the grid planes.
inline TetMesh grid(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
                    const std::function<bool(int, int, int)>& solid) {
  TetMesh mesh;
  std::map<std::array<int, 3>, Index> ids;
  const auto vertex = [&](const std::array<int, 3>& c) {
    const auto [it, added] = ids.try_emplace(c, static_cast<Index>(mesh.vertices.size()));
    const auto at = [](const std::vector<double>& planes, int i) { return planes[static_cast<std::size_t>(i)]; };
    if (added) mesh.vertices.push_back({at(x, c[0]), at(y, c[1]), at(z, c[2])});
    return it->second;
  };
  const auto cells = [](const std::vector<double>& planes) { return static_cast<int>(planes.size()) - 1; };
  for (int i = 0; i < cells(x); ++i)
    for (int j = 0; j < cells(y); ++j)
      for (int k = 0; k < cells(z); ++k) {
        if (!solid(i, j, k)) continue;
        std::array<std::size_t, 3> axes = {0, 1, 2};
        do {  // one tet per monotone path from the cell's low corner to its high one
          std::array<int, 3> c = {i, j, k};
          Tetrahedron tet{vertex(c)};
          for (std::size_t step = 0; step < 3; ++step) {
            ++c[axes[step]];
            tet[step + 1] = vertex(c);
          }
          mesh.tets.push_back(tet);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  return positive(std::move(mesh));
}

inline std::vector<double> planes(double length, int cells) {
  std::vector<double> result;
  for (int i = 0; i <= cells; ++i) result.push_back(length * i / cells);
  return result;
}

/// Box [0, size], cut into n x m x k cells.
inline TetMesh box(const Vec3& size, int n = 1, int m = 1, int k = 1) {
  return grid(planes(size.x, n), planes(size.y, m), planes(size.z, k), [](int, int, int) { return true; });
}

/// A 2 x 2 square without its quarter [1, 2] x [1, 2], extruded along z by `length`.
inline TetMesh l_profile(double length = 3) {
  return grid({0, 1, 2}, {0, 1, 2}, planes(length, 2), [](int i, int j, int) { return i == 0 || j == 0; });
}

/// Plate 3 x 3 x thickness with the hole [1, 2] x [1, 2].
inline TetMesh plate_with_hole(double thickness = 1) {
  return grid({0, 1, 2, 3}, {0, 1, 2, 3}, {0, thickness}, [](int i, int j, int) { return i != 1 || j != 1; });
}

/// Box without a cuboid at one of its corners: three concave lines of different lengths meet there.
inline TetMesh notched_box() {
  return grid({0, 1, 1.37}, {0, 1, 1.11}, {0, 1, 1.73}, [](int i, int j, int k) { return i == 0 || j == 0 || k == 0; });
}

/// Cube of side 3 with the cavity [1, 2]^3.
inline TetMesh hollow_box() {
  const std::vector<double> p = {0, 1, 2, 3};
  return grid(p, p, p, [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; });
}

/// Cube of side 5 with the cavity [1, 4]^3, in which floats the cube [2, 3]^3.
inline TetMesh box_in_box() {
  const std::vector<double> p = {0, 1, 2, 3, 4, 5};
  return grid(p, p, p, [](int i, int j, int k) {
    const auto inner = [](int a) { return a >= 1 && a <= 3; };
    return !(inner(i) && inner(j) && inner(k)) || (i == 2 && j == 2 && k == 2);
  });
}

inline TetMesh two_plates_with_holes() {
  return together(plate_with_hole(), transformed(plate_with_hole(), [](Vec3 p) { return p + Vec3{4, 1, 0.5}; }));
}

/// Convex polyhedron: tets from the vertices' mean to the faces (polygons in any orientation, cut into fans).
inline TetMesh convex(std::vector<Vec3> vertices, const std::vector<std::vector<Index>>& faces) {
  TetMesh mesh{.vertices = std::move(vertices), .tets = {}};
  Vec3 mean;
  for (const Vec3& p : mesh.vertices) mean += p / static_cast<double>(mesh.vertices.size());
  const Index apex = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.push_back(mean);
  for (const auto& face : faces)
    for (std::size_t k = 1; k + 1 < face.size(); ++k) mesh.tets.push_back({apex, face[0], face[k], face[k + 1]});
  return positive(std::move(mesh));
}

inline TetMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
}

/// Pyramid over the square [0, 2]^2, of height 2.
inline TetMesh pyramid() {
  return convex({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 2}},
                {{0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
}

/// Right triangle with legs 2 and 1, extruded by 3.
inline TetMesh wedge() {
  return convex({{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 3}, {2, 0, 3}, {0, 1, 3}},
                {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}});
}

/// Moves the points of a plane figure to the place of layer 0, 1, ...
using Layer = std::function<Vec3(double u, double v, int layer)>;

/// Sweeps the regular n-gon of circumradius r, a fan of triangles around its centre, through layers 0..layers; if
/// `closed`, the last layer is the first one.
inline TetMesh sweep(double r, int n, int layers, bool closed, const Layer& place) {
  TetMesh mesh;
  const int stored = closed ? layers : layers + 1;
  for (int s = 0; s < stored; ++s) {
    mesh.vertices.push_back(place(0, 0, s));
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * std::numbers::pi * k / n;
      mesh.vertices.push_back(place(r * std::cos(angle), r * std::sin(angle), s));
    }
  }
  for (int s = 0; s < layers; ++s)
    for (int k = 0; k < n; ++k) {
      // Within a section a < b < c, so prisms that share a side cut it along the same diagonal.
      const Index a = 0, b = 1 + std::min(k, (k + 1) % n), c = 1 + std::max(k, (k + 1) % n);
      const Index low = s * (n + 1), high = (s + 1) % stored * (n + 1);
      mesh.tets.push_back({low + a, low + b, low + c, high + c});
      mesh.tets.push_back({low + a, low + b, high + b, high + c});
      mesh.tets.push_back({low + a, high + a, high + b, high + c});
    }
  return positive(std::move(mesh));
}

/// Right prism over a regular n-gon, axis z.
inline TetMesh prism(double r, double height, int n, int layers = 1) {
  return sweep(r, n, layers, false, [=](double u, double v, int s) { return Vec3{u, v, height * s / layers}; });
}

/// Torus around z: an n-gon of circumradius r, its centre at distance big from the axis, in m steps.
inline TetMesh torus(double big, double r, int m, int n) {
  return sweep(r, n, m, true, [=](double u, double v, int s) {
    const double angle = 2 * std::numbers::pi * s / m;
    return Vec3{(big + u) * std::cos(angle), (big + u) * std::sin(angle), v};
  });
}

inline double polygon_area(double r, int n) {
  return n * r * r * std::sin(2 * std::numbers::pi / n) / 2;
}

/// What is known of a solid; lines and corners with the default angles.
struct Shape {
  std::string name;
  TetMesh mesh;
  Betti topology;
  double volume = 0;
  Index convex_lines = 0;
  Index concave_lines = 0;
  Index corners = 0;
};

inline std::vector<Shape> all() {
  const double torus_volume = 24 * std::sin(2 * std::numbers::pi / 24) * 3 * polygon_area(1, 16);
  const TetMesh round = torus(3, 1, 24, 16);
  return {
      {"tetrahedron", tetrahedron(), {1, 0, 0}, 1.0 / 6, 6, 0, 4},
      {"cube", box({1, 1, 1}), {1, 0, 0}, 1, 12, 0, 8},
      {"box", box({1, 2, 3}, 2, 3, 4), {1, 0, 0}, 6, 12, 0, 8},
      {"pyramid", pyramid(), {1, 0, 0}, 8.0 / 3, 8, 0, 5},
      {"wedge", wedge(), {1, 0, 0}, 3, 9, 0, 6},
      {"hexagonal prism", prism(1, 2, 6, 2), {1, 0, 0}, 2 * polygon_area(1, 6), 18, 0, 12},
      {"L profile", l_profile(), {1, 0, 0}, 9, 17, 1, 12},
      {"plate with hole", plate_with_hole(), {1, 1, 0}, 8, 20, 4, 16},
      {"hollow box", hollow_box(), {1, 0, 1}, 26, 12, 12, 16},
      {"box in box", box_in_box(), {2, 0, 1}, 99, 24, 12, 24},
      {"two plates with holes", two_plates_with_holes(), {2, 2, 0}, 16, 40, 8, 32},
      {"cylinder", prism(1, 3, 24, 4), {1, 0, 0}, 3 * polygon_area(1, 24), 2, 0, 0},
      {"torus", round, {1, 1, 0}, torus_volume, 0, 0, 0},
      {"two tori",
       together(round, transformed(round,
                                   [](Vec3 p) {
                                     return Vec3{p.z, p.x + 3, p.y};
                                   })),
       {2, 2, 0},
       2 * torus_volume,
       0,
       0,
       0},
  };
}

}  // namespace matstruct::shapes
