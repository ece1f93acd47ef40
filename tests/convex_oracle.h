// Exact medial axis of a convex polyhedron, for tests.
//
// Inside the polyhedron { x : n_k . x <= d_k for all k }, n_k of unit length, the distance to face k is the affine
// function d_k - n_k . x. The medial axis is therefore the union over the pairs (k, l) of the convex polygons
//
//     { x : dist_k(x) = dist_l(x) <= dist_m(x) for all m, dist_k(x) >= 0 }
//
// of positive area: its sheets. They meet along seams (three or more sheets), which end at junctions (four or more
// faces at the same distance) and at the vertices of the polyhedron (corners); the other sides of sheets are the
// polyhedron's edges. On a sheet the radius is affine, so that the slabs of its triangles have the polyhedron's
// boundary as exact envelope.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <vector>

#include <matstruct/types.h>

#include "base/index.h"
#include "base/random.h"
#include "geometry/primitives.h"

namespace matstruct::oracle {

/// Points nearer than this are one vertex. The solids below have sizes around 1.
inline constexpr double kSamePoint = 1e-7;
/// A vertex nearer than this to a clipping plane is on it.
inline constexpr double kOnPlane = 1e-11;
/// Half the side of the squares from which polygons are cut: larger than any solid, but not so large as to cost digits.
inline constexpr double kSquare = 64;

using Polygon = std::vector<Vec3>;

/// { x : normal . x <= offset }
struct HalfSpace {
  Vec3 normal;  ///< unit
  double offset = 0;
  double distance(const Vec3& x) const { return offset - dot(normal, x); }
};

/// A large square of the plane { x : normal . x = offset }, counter-clockwise seen from the tip of the unit normal.
inline Polygon square_on_plane(const Vec3& normal, double offset) {
  const Vec3 other = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(other, normal)), v = cross(normal, u);
  const Vec3 center = normal * offset;
  return {center - (u + v) * kSquare, center + (u - v) * kSquare, center + (u + v) * kSquare,
          center + (v - u) * kSquare};
}

/// The part of a convex polygon where an affine function is not negative (Sutherland & Hodgman 1974).
inline Polygon clip(const Polygon& polygon, const std::function<double(const Vec3&)>& affine) {
  const auto value = [&](const Vec3& p) {
    const double v = affine(p);
    return std::abs(v) <= kOnPlane ? 0.0 : v;
  };
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& p = polygon[i];
    const Vec3& q = polygon[(i + 1) % polygon.size()];
    const double at_p = value(p), at_q = value(q);
    if (at_p >= 0) result.push_back(p);
    if (at_p * at_q < 0) result.push_back(lerp(p, q, at_p / (at_p - at_q)));
  }
  return result;
}

inline double area(const Polygon& polygon) {
  double sum = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) sum += triangle_area(polygon[0], polygon[i - 1], polygon[i]);
  return sum;
}

inline double perimeter(const Polygon& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) sum += distance(polygon[i], polygon[(i + 1) % polygon.size()]);
  return sum;
}

/// Points without repetition.
class PointSet {
 public:
  /// The id of the point that is the same as `p`, added if there is none.
  Index add(const Vec3& p) {
    for (Index i = 0; i < count(points_); ++i)
      if (distance(points_[uz(i)], p) < kSamePoint) return i;
    points_.push_back(p);
    return count(points_) - 1;
  }
  /// The polygon as ids, consecutive equal points once; empty if it is nowhere wider than a point.
  std::vector<Index> add_polygon(const Polygon& polygon) {
    if (area(polygon) <= kSamePoint * perimeter(polygon)) return {};
    std::vector<Index> ids;
    for (const Vec3& p : polygon) {
      const Index id = add(p);
      if (ids.empty() || (ids.back() != id && ids.front() != id)) ids.push_back(id);
    }
    return ids;
  }
  const std::vector<Vec3>& points() const { return points_; }

 private:
  std::vector<Vec3> points_;
};

/// Fan of a convex polygon.
inline std::vector<Triangle> fan(const std::vector<Index>& polygon) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 2; i < polygon.size(); ++i) triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
  return triangles;
}

/// Side of a polygon from its i-th vertex to the next, lower id first.
inline Edge side(const std::vector<Index>& polygon, std::size_t i) {
  return ordered_edge(polygon[i], polygon[(i + 1) % polygon.size()]);
}

struct ConvexPolyhedron {
  std::vector<HalfSpace> half_spaces;
  std::vector<Vec3> vertices;
  std::vector<std::vector<Index>>
      faces;  ///< of each half-space, counter-clockwise from outside; empty if it does not touch

  /// Distance from a point inside to the boundary; negative outside (then not the distance).
  double depth(const Vec3& x) const {
    double least = std::numeric_limits<double>::infinity();
    for (const HalfSpace& h : half_spaces) least = std::min(least, h.distance(x));
    return least;
  }
  bool bounded() const {
    return !vertices.empty() &&
           std::all_of(vertices.begin(), vertices.end(), [](const Vec3& v) { return norm(v) < kSquare / 2; });
  }
  bool every_face_present() const {
    return std::none_of(faces.begin(), faces.end(), [](const auto& f) { return f.empty(); });
  }
};

inline ConvexPolyhedron convex_polyhedron(const std::vector<HalfSpace>& half_spaces) {
  ConvexPolyhedron solid;
  solid.half_spaces = half_spaces;
  PointSet vertices;
  for (const HalfSpace& own : half_spaces) {
    Polygon face = square_on_plane(own.normal, own.offset);
    for (const HalfSpace& h : half_spaces)
      if (&h != &own) face = clip(face, [&](const Vec3& p) { return h.distance(p); });
    solid.faces.push_back(vertices.add_polygon(face));
  }
  solid.vertices = vertices.points();
  return solid;
}

/// Edges of the polyhedron with the two faces that meet there.
inline std::map<Edge, std::vector<Index>> edges_of(const ConvexPolyhedron& solid) {
  std::map<Edge, std::vector<Index>> edges;
  for (Index f = 0; f < count(solid.faces); ++f) {
    const auto& face = solid.faces[uz(f)];
    for (std::size_t i = 0; i < face.size(); ++i) edges[side(face, i)].push_back(f);
  }
  return edges;
}

inline double shortest_edge(const ConvexPolyhedron& solid) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& [edge, faces] : edges_of(solid))
    shortest = std::min(shortest, distance(solid.vertices[uz(edge[0])], solid.vertices[uz(edge[1])]));
  return shortest;
}

/// Least angle in degrees between the normals of two faces with a common edge: 180 minus the bluntest dihedral angle.
inline double least_turn(const ConvexPolyhedron& solid) {
  double least = 180;
  for (const auto& [edge, f] : edges_of(solid)) {
    const double turn = angle_between(solid.half_spaces[uz(f[0])].normal, solid.half_spaces[uz(f[1])].normal);
    least = std::min(least, turn * 180 / std::numbers::pi);
  }
  return least;
}

// ---- solids ---------------------------------------------------------------------------------------------------------

/// Edge lengths a, b, c; centred at the origin.
inline ConvexPolyhedron box(double a, double b, double c) {
  return convex_polyhedron({{{1, 0, 0}, a / 2},
                            {{-1, 0, 0}, a / 2},
                            {{0, 1, 0}, b / 2},
                            {{0, -1, 0}, b / 2},
                            {{0, 0, 1}, c / 2},
                            {{0, 0, -1}, c / 2}});
}

/// Regular tetrahedron around the unit sphere.
inline ConvexPolyhedron tetrahedron() {
  const double s = 1 / std::numbers::sqrt3;
  return convex_polyhedron({{{s, s, s}, 1}, {{s, -s, -s}, 1}, {{-s, s, -s}, 1}, {{-s, -s, s}, 1}});
}

inline Vec3 on_circle(int k, int n) {
  const double angle = 2 * std::numbers::pi * k / n;
  return {std::cos(angle), std::sin(angle), 0};
}

/// Prism over a regular n-gon with an inscribed circle of the given radius, centred at the origin.
inline ConvexPolyhedron prism(int n, double inradius, double height) {
  std::vector<HalfSpace> half_spaces{{{0, 0, 1}, height / 2}, {{0, 0, -1}, height / 2}};
  for (int k = 0; k < n; ++k) half_spaces.push_back({on_circle(k, n), inradius});
  return convex_polyhedron(half_spaces);
}

/// Pyramid over a regular n-gon in the plane z = 0 with an inscribed circle of the given radius; apex at (0, 0,
/// height).
inline ConvexPolyhedron pyramid(int n, double inradius, double height) {
  std::vector<HalfSpace> half_spaces{{{0, 0, -1}, 0}};
  for (int k = 0; k < n; ++k) {
    const Vec3 normal = normalized(on_circle(k, n) * height + Vec3{0, 0, inradius});
    half_spaces.push_back({normal, dot(normal, {0, 0, height})});
  }
  return convex_polyhedron(half_spaces);
}

/// Random half-spaces at distances in [1 - spread, 1 + spread] from the origin, each with a face, no edge shorter than
/// 0.03 and neighbouring normals at least `turn` degrees apart. With spread 0 all faces touch the unit sphere and the
/// axis has one junction. Normals are the best of a few candidates (Mitchell 1991), else blunt edges would abound.
/// Throws when no such solid is found: `turn` above about 30 is too much for 20 faces.
inline ConvexPolyhedron random_convex_polyhedron(std::uint64_t seed, int faces, double spread = 0.25, double turn = 0) {
  constexpr std::uint64_t kAttempts = 5000;
  constexpr double kShortestEdge = 0.03, kGreatestNorm = 4;
  constexpr int kCandidates = 6;
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    KeyedRandom random(seed, static_cast<std::uint64_t>(faces), attempt);
    std::vector<HalfSpace> half_spaces;
    while (static_cast<int>(half_spaces.size()) < faces) {
      Vec3 best;
      double least_cosine = 2;
      for (int c = 0; c < kCandidates; ++c) {
        const double z = 2 * random.uniform() - 1, angle = 2 * std::numbers::pi * random.uniform();
        const double circle = std::sqrt(1 - z * z);
        const Vec3 normal{circle * std::cos(angle), circle * std::sin(angle), z};
        double cosine = -1;
        for (const HalfSpace& h : half_spaces) cosine = std::max(cosine, dot(h.normal, normal));
        if (cosine < least_cosine) best = normal, least_cosine = cosine;
      }
      half_spaces.push_back({best, 1 + spread * (2 * random.uniform() - 1)});
    }
    const ConvexPolyhedron solid = convex_polyhedron(half_spaces);
    const auto near = [](const Vec3& v) { return norm(v) < kGreatestNorm; };
    if (solid.every_face_present() && std::all_of(solid.vertices.begin(), solid.vertices.end(), near) &&
        shortest_edge(solid) > kShortestEdge && least_turn(solid) >= turn)
      return solid;
  }
  throw std::runtime_error("no random polyhedron of this kind found");
}

// ---- as meshes ------------------------------------------------------------------------------------------------------

/// Faces cut into fans, outward.
inline TriSurface surface_of(const ConvexPolyhedron& solid) {
  TriSurface surface{solid.vertices, {}};
  for (const auto& face : solid.faces)
    for (const Triangle& t : fan(face)) surface.triangles.push_back(t);
  return surface;
}

/// Fan from the mean of the vertices (the last vertex) to the triangles of surface_of(), positively oriented.
inline TetMesh tet_mesh_of(const ConvexPolyhedron& solid) {
  TetMesh mesh{solid.vertices, {}};
  Vec3 mean;
  for (const Vec3& v : solid.vertices) mean += v;
  mesh.vertices.push_back(mean / static_cast<double>(solid.vertices.size()));
  const Index center = count(solid.vertices);
  for (const auto& [a, b, c] : surface_of(solid).triangles) mesh.tets.push_back({a, c, b, center});
  return mesh;
}

// ---- medial axis ----------------------------------------------------------------------------------------------------

struct AxisSheet {
  Edge faces;                  ///< the two half-spaces at the same distance, k < l
  std::vector<Index> polygon;  ///< axis vertices in order
};

struct ConvexAxis {
  std::vector<Vec3> vertices;  ///< corners and junctions
  std::vector<double> radii;   ///< distance to the boundary: 0 exactly at corners
  std::vector<AxisSheet> sheets;
  std::map<Edge, int> seams;       ///< sides of sheets inside the solid, with the number of sheets there (>= 3)
  std::map<Edge, int> boundaries;  ///< sides of sheets on edges of the solid, with the number of sheets there (1)

  Index corners() const { return static_cast<Index>(std::count(radii.begin(), radii.end(), 0.0)); }
  Index junctions() const { return count(radii) - corners(); }

  Polygon polygon(const AxisSheet& sheet) const {
    Polygon points;
    for (const Index v : sheet.polygon) points.push_back(vertices[uz(v)]);
    return points;
  }
};

inline ConvexAxis medial_axis(const ConvexPolyhedron& solid) {
  ConvexAxis axis;
  PointSet vertices;
  const auto& h = solid.half_spaces;
  for (Index k = 0; k < count(h); ++k) {
    for (Index l = k + 1; l < count(h); ++l) {
      const HalfSpace &hk = h[uz(k)], &hl = h[uz(l)];
      const Vec3 normal = hk.normal - hl.normal;
      Polygon sheet = square_on_plane(normalized(normal), (hk.offset - hl.offset) / norm(normal));
      sheet = clip(sheet, [&](const Vec3& p) { return hk.distance(p); });
      for (const HalfSpace& hm : h)
        if (&hm != &hk && &hm != &hl)
          sheet = clip(sheet, [&](const Vec3& p) { return hm.distance(p) - hk.distance(p); });
      auto polygon = vertices.add_polygon(sheet);
      if (!polygon.empty()) axis.sheets.push_back({{k, l}, std::move(polygon)});
    }
  }
  axis.vertices = vertices.points();
  for (const Vec3& v : axis.vertices) {
    const double depth = solid.depth(v);
    axis.radii.push_back(depth < kSamePoint ? 0 : depth);
  }
  for (const AxisSheet& sheet : axis.sheets) {
    for (std::size_t i = 0; i < sheet.polygon.size(); ++i) {
      const Edge edge = side(sheet.polygon, i);
      const bool outside = axis.radii[uz(edge[0])] == 0 && axis.radii[uz(edge[1])] == 0;
      ++(outside ? axis.boundaries : axis.seams)[edge];
    }
  }
  return axis;
}

/// The coarsest medial mesh of the axis: its envelope is the boundary of the solid.
inline MedialMesh medial_mesh_of(const ConvexAxis& axis) {
  MedialMesh mesh;
  mesh.centers = axis.vertices;
  mesh.radii = axis.radii;
  for (const double r : axis.radii) mesh.types.push_back(r > 0 ? SphereType::kJunction : SphereType::kCorner);
  std::set<Edge> edges;
  for (const AxisSheet& sheet : axis.sheets) {
    for (Triangle t : fan(sheet.polygon)) {
      std::sort(t.begin(), t.end());
      mesh.faces.push_back(t);
      edges.insert({{t[0], t[1]}, {t[0], t[2]}, {t[1], t[2]}});
    }
  }
  std::sort(mesh.faces.begin(), mesh.faces.end());
  mesh.edges.assign(edges.begin(), edges.end());
  return mesh;
}

inline double distance_to_axis(const ConvexAxis& axis, const Vec3& x) {
  double least = std::numeric_limits<double>::infinity();
  for (const AxisSheet& sheet : axis.sheets)
    for (const auto& [a, b, c] : fan(sheet.polygon))
      least = std::min(
          least, closest_on_triangle(x, axis.vertices[uz(a)], axis.vertices[uz(b)], axis.vertices[uz(c)]).distance);
  return least;
}

/// `n` points of the axis, uniform by area.
inline std::vector<Vec3> sample_axis(const ConvexAxis& axis, Index n, std::uint64_t seed) {
  std::vector<Triangle> triangles;
  std::vector<double> area_up_to;
  double total = 0;
  for (const AxisSheet& sheet : axis.sheets) {
    for (const Triangle& t : fan(sheet.polygon)) {
      triangles.push_back(t);
      area_up_to.push_back(total +=
                           triangle_area(axis.vertices[uz(t[0])], axis.vertices[uz(t[1])], axis.vertices[uz(t[2])]));
    }
  }
  std::vector<Vec3> points;
  for (Index s = 0; s < n; ++s) {
    KeyedRandom random(seed, 0, static_cast<std::uint64_t>(s));
    const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, total * random.uniform());
    const auto& [a, b, c] = triangles[static_cast<std::size_t>(found - area_up_to.begin())];
    const double root = std::sqrt(random.uniform());
    points.push_back(
        lerp(axis.vertices[uz(a)], lerp(axis.vertices[uz(b)], axis.vertices[uz(c)], random.uniform()), root));
  }
  return points;
}

}  // namespace matstruct::oracle
