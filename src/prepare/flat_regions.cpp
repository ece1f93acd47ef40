#include "prepare/flat_regions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include "base/index.h"
#include "base/tolerances.h"
#include "prepare/boundary.h"

namespace matstruct {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::Exact_predicates_tag>;

// Coordinates in the plane of a region, counter-clockwise seen from outside.
struct Projection {
  std::size_t u = 0, v = 1;
  Kernel::Point_2 operator()(const Vec3& p) const {
    const std::array<double, 3> x{p.x, p.y, p.z};
    return {x[u], x[v]};
  }
};

Projection projection_along(const Vec3& normal) {
  const std::array<double, 3> n{normal.x, normal.y, normal.z};
  std::size_t k = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (std::abs(n[i]) > std::abs(n[k])) k = i;
  Projection result{(k + 1) % 3, (k + 2) % 3};
  if (n[k] < 0) std::swap(result.u, result.v);
  return result;
}

bool are_parallel(const Vec3& a, const Vec3& b) {
  return norm(cross(a, b)) <= tolerance::kFlat * norm(a) * norm(b);
}

class Merger {
 public:
  Merger(const TriSurface& surface, const std::vector<Vec3>& exact, const std::vector<Edge>& kept)
      : surface_(surface),
        exact_(exact),
        kept_(kept),
        neighbors_(pair_triangles(surface.triangles, [](Index v) { return fmt::format("vertex {}", v); })),
        region_(surface.triangles.size(), kInvalid) {}

  std::optional<FlatRegions> run() {
    find_regions();
    choose_vertices();
    find_sides();
    for (Index r = 0; r < count(regions_); ++r)
      if (!triangulate(r)) return std::nullopt;
    return in_order();
  }

 private:
  struct Region {
    Vec3 normal;                   // not normalised
    std::vector<Index> triangles;  // ascending
    std::vector<Edge> sides;       // its border between vertices that stay, as ascending pairs
  };

  const Vec3& exact(Index v) const { return exact_[uz(v)]; }
  const Triangle& triangle(Index t) const { return surface_.triangles[uz(t)]; }

  // Along the normal, twice as long as the area is large.
  Vec3 area_vector(const Triangle& t) const { return cross(exact(t[1]) - exact(t[0]), exact(t[2]) - exact(t[0])); }
  Vec3 area_vector(Index t) const { return area_vector(triangle(t)); }

  bool is_kept(const Edge& e) const { return std::binary_search(kept_.begin(), kept_.end(), e); }

  Edge edge(Index t, std::size_t k) const { return ordered_edge(triangle(t)[(k + 1) % 3], triangle(t)[(k + 2) % 3]); }

  bool is_side(Index t, std::size_t k) const {
    return region_[uz(t)] != region_[uz(neighbors_[uz(t)][k])] || is_kept(edge(t, k));
  }

  // From the largest triangles on, whose planes are the surest.
  void find_regions() {
    std::vector<std::pair<double, Index>> seeds;
    for (Index t = 0; t < count(surface_.triangles); ++t) seeds.emplace_back(-norm(area_vector(t)), t);
    std::sort(seeds.begin(), seeds.end());
    for (const auto& [area, seed] : seeds)
      if (region_[uz(seed)] == kInvalid) grow(seed);
    for (Index t = 0; t < count(region_); ++t) regions_[uz(region_[uz(t)])].triangles.push_back(t);
  }

  void grow(Index seed) {
    const Index r = count(regions_);
    const Vec3 normal = area_vector(seed);
    regions_.push_back({normal, {}, {}});
    const Vec3& origin = exact(triangle(seed)[0]);
    const double limit = tolerance::kFlat * norm(normal);
    // The angle decides, as it is the same for a triangle and its parts; the distance bounds what angles add up to.
    const auto lies_in = [&](Index t) {
      const Vec3 n = area_vector(t);
      return dot(n, normal) > 0 && are_parallel(n, normal) &&
             std::all_of(triangle(t).begin(), triangle(t).end(),
                         [&](Index v) { return std::abs(dot(normal, exact(v) - origin)) <= limit; });
    };
    std::vector<Index> front{seed};
    region_[uz(seed)] = r;
    while (!front.empty()) {
      const Index t = front.back();
      front.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const Index other = neighbors_[uz(t)][k];
        if (region_[uz(other)] != kInvalid || is_kept(edge(t, k)) || !lies_in(other)) continue;
        region_[uz(other)] = r;
        front.push_back(other);
      }
    }
  }

  // Where the surface touches itself, and at ends of kept edges, vertices stay.
  void choose_vertices() {
    const std::size_t n = surface_.vertices.size();
    stays_.assign(n, 0);
    next_.assign(n, {kInvalid, kInvalid});
    std::vector<Index> sides(n, 0), fans(n, 0);
    for (Index t = 0; t < count(surface_.triangles); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        if (!is_side(t, k) || t > neighbors_[uz(t)][k]) continue;
        const Edge e = edge(t, k);
        for (const auto& [v, other] : {std::pair(e[0], e[1]), std::pair(e[1], e[0])}) {
          if (sides[uz(v)] < 2) next_[uz(v)][uz(sides[uz(v)])] = other;
          ++sides[uz(v)];
        }
      }
    UnionFind corners_of = triangle_fans(surface_.triangles, neighbors_);
    for (Index c = 0; c < 3 * count(surface_.triangles); ++c)
      if (corners_of.find(c) == c) ++fans[uz(triangle(c / 3)[uz(c % 3)])];
    for (const Edge& e : kept_)
      for (const Index v : e) stays_[uz(v)] = 1;
    for (Index v = 0; v < count(stays_); ++v)
      if (fans[uz(v)] != 1 || (sides[uz(v)] != 0 && (sides[uz(v)] != 2 || !is_straight(v)))) stays_[uz(v)] = 1;
  }

  bool is_straight(Index v) const {
    const Vec3 a = exact(next_[uz(v)][0]) - exact(v), b = exact(next_[uz(v)][1]) - exact(v);
    return dot(a, b) < 0 && are_parallel(a, b);
  }

  // Walks along straight borders to the next vertex that stays.
  void find_sides() {
    for (Index t = 0; t < count(surface_.triangles); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        if (!is_side(t, k)) continue;
        const Index from = triangle(t)[(k + 1) % 3];
        if (!stays_[uz(from)]) continue;
        Index last = from, to = triangle(t)[(k + 2) % 3];
        while (!stays_[uz(to)]) {
          const auto& [a, b] = next_[uz(to)];
          last = std::exchange(to, a == last ? b : a);
        }
        regions_[uz(region_[uz(t)])].sides.push_back(ordered_edge(from, to));
      }
  }

  bool triangulate(Index r) {
    const Region& region = regions_[uz(r)];
    if (region.triangles.size() == 1 && region.sides.size() == 3) {
      add(triangle(region.triangles[0]), region);
      return true;
    }
    std::vector<Index> vertices;
    for (const Index t : region.triangles)
      for (const Index v : triangle(t))
        if (stays_[uz(v)]) vertices.push_back(v);
    sort_by_coordinates(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    // A needle whose corner lies on its longest side: the regions beside it meet there.
    if (vertices.size() == 2) return true;
    Triangulation cdt;
    std::map<Index, Triangulation::Vertex_handle> handle;
    const Projection project = projection_along(region.normal);
    for (const Index v : vertices) {
      handle[v] = cdt.insert(project(surface_.vertices[uz(v)]));
      handle[v]->info() = v;
    }
    if (cdt.number_of_vertices() != vertices.size() || cdt.dimension() < 2) return false;
    // Where the region lies on both sides of an edge, that is no border of it.
    std::map<Edge, int> times;
    for (const Edge& e : region.sides) ++times[e];
    for (const auto& [e, n] : times) {
      if (n > 2) return false;
      cdt.insert_constraint(handle[e[0]], handle[e[1]]);
    }
    if (cdt.number_of_vertices() != vertices.size()) return false;
    return take_inside(cdt, times, region);
  }

  bool take_inside(const Triangulation& cdt, const std::map<Edge, int>& times, const Region& region) {
    std::map<Triangulation::Face_handle, bool> inside;
    std::vector<Triangulation::Face_handle> front{cdt.infinite_face()};
    inside[front[0]] = false;
    double area = 0;
    while (!front.empty()) {
      const Triangulation::Face_handle f = front.back();
      front.pop_back();
      for (int k = 0; k < 3; ++k) {
        const Triangulation::Face_handle other = f->neighbor(k);
        if (inside.contains(other)) continue;
        bool crosses = false;
        if (f->is_constrained(k)) {
          const auto found = times.find(ordered_edge(f->vertex(cdt.cw(k))->info(), f->vertex(cdt.ccw(k))->info()));
          if (found == times.end()) return false;  // a vertex lies on a side
          crosses = found->second == 1;
        }
        inside[other] = inside[f] != crosses;
        front.push_back(other);
      }
    }
    for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
      if (!inside[f]) continue;
      const Triangle t{f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()};
      const double share = dot(area_vector(t), region.normal);
      if (share <= 0) return false;
      area += share;
      add(t, region);
    }
    double before = 0;
    for (const Index t : region.triangles) before += dot(area_vector(t), region.normal);
    return std::abs(area - before) <= tolerance::kSameMeasure * before;
  }

  void add(const Triangle& t, const Region& region) { made_.push_back({t, region.triangles.front()}); }

  void sort_by_coordinates(std::vector<Index>& vertices) const {
    const auto key = [&](Index v) {
      const Vec3& p = surface_.vertices[uz(v)];
      return std::tuple(p.x, p.y, p.z, v);
    };
    std::sort(vertices.begin(), vertices.end(), [&](Index a, Index b) { return key(a) < key(b); });
  }

  FlatRegions in_order() {
    FlatRegions result;
    std::vector<Index> id(surface_.vertices.size(), kInvalid);
    for (const auto& [t, origin] : made_)
      for (const Index v : t)
        if (std::exchange(id[uz(v)], 0) == kInvalid) result.vertices.push_back(v);
    sort_by_coordinates(result.vertices);
    for (Index n = 0; n < count(result.vertices); ++n) id[uz(result.vertices[uz(n)])] = n;
    for (auto& [t, origin] : made_) {
      for (Index& v : t) v = id[uz(v)];
      t = from_least_vertex(t);
    }
    std::sort(made_.begin(), made_.end());
    for (const auto& [t, origin] : made_) {
      result.triangles.push_back(t);
      result.input_triangles.push_back(origin);
    }
    return result;
  }

  const TriSurface& surface_;
  const std::vector<Vec3>& exact_;
  const std::vector<Edge>& kept_;
  std::vector<std::array<Index, 3>> neighbors_;
  std::vector<Index> region_;  // per triangle
  std::vector<Region> regions_;
  std::vector<std::uint8_t> stays_;         // per vertex
  std::vector<std::array<Index, 2>> next_;  // per vertex: along the border, if two edges of it end there
  std::vector<std::pair<Triangle, Index>> made_;
};

}  // namespace

std::optional<FlatRegions> merge_flat_regions(const TriSurface& surface, const std::vector<Vec3>& exact,
                                              const std::vector<Edge>& kept) {
  return Merger(surface, exact, kept).run();
}

}  // namespace matstruct
