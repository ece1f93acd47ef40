// Exact resolution of intersections, after Zhou, Grinspun, Zorin and Jacobson, "Mesh Arrangements for Solid Geometry"
// (2016): triangles are cut along their intersections in rational arithmetic, coplanar ones that overlap together, so
// that they are cut alike. The coordinates are rounded to doubles, which may make new intersections, and this is
// repeated until there are none; on a coarser grid if asked, which takes away needles. Inside is where the generalized
// winding number (Jacobson, Kavan and Sorkine-Hornung 2013) exceeds one half.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_vertex_base_2.h>
#include <CGAL/intersections.h>
#include <boost/variant/get.hpp>

#include "base/union_find.h"
#include "prepare/mesher/soup.h"
#include "prepare/mesher/tasks.h"

namespace matstruct::mesher {

namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Point3 = Exact::Point_3;
using Point2 = Exact::Point_2;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Exact, CGAL::Default, CGAL::Exact_intersections_tag>;
using Triangle = std::array<std::size_t, 3>;

constexpr int kMostRounds = 8;
constexpr double kMostDangling = 0.1;  // of the area

std::int32_t id32(std::size_t i) {
  return static_cast<std::int32_t>(i);
}

// What coplanar overlapping triangles have in common: their plane, and the points and segments it is cut along.
struct Group {
  std::vector<std::size_t> triangles;
  std::vector<std::array<Point3, 2>> segments;  // of equal ends: points
};

// A plane with two of its coordinates as parameters.
class Plane {
 public:
  explicit Plane(const Exact::Triangle_3& t) : plane_(t.supporting_plane()) {
    const double n[3] = {std::abs(CGAL::to_double(plane_.a())), std::abs(CGAL::to_double(plane_.b())),
                         std::abs(CGAL::to_double(plane_.c()))};
    axis_ = static_cast<int>(std::max_element(n, n + 3) - n);
  }
  Point2 down(const Point3& p) const { return {p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]}; }
  Point3 up(const Point2& p) const {
    const Exact::FT normal[3] = {plane_.a(), plane_.b(), plane_.c()};
    Exact::FT x[3];
    x[(axis_ + 1) % 3] = p.x();
    x[(axis_ + 2) % 3] = p.y();
    x[axis_] = -(normal[(axis_ + 1) % 3] * p.x() + normal[(axis_ + 2) % 3] * p.y() + plane_.d()) / normal[axis_];
    return {x[0], x[1], x[2]};
  }

 private:
  Exact::Plane_3 plane_;
  int axis_;
};

class Arrangement {
 public:
  explicit Arrangement(const Soup& soup) : soup_(soup) {
    for (const auto& p : soup.points) exact_.emplace_back(p.x(), p.y(), p.z());
  }

  Soup cut(const std::vector<std::array<std::size_t, 2>>& pairs) {
    std::vector<char> is_cut(soup_.triangles.size(), 0);
    for (const Group& group : groups(pairs)) {
      cut_group(group);
      for (const std::size_t t : group.triangles) is_cut[t] = 1;
    }
    for (std::size_t t = 0; t < soup_.triangles.size(); ++t)
      if (!is_cut[t]) result_.triangles.push_back({vertex(t, 0), vertex(t, 1), vertex(t, 2)});
    return std::move(result_);
  }

 private:
  Exact::Triangle_3 exact_triangle(std::size_t t) const {
    const Triangle& v = soup_.triangles[t];
    return {exact_[v[0]], exact_[v[1]], exact_[v[2]]};
  }

  std::size_t vertex(const Point3& p) {
    const auto [entry, is_new] = ids_.try_emplace(p, result_.points.size());
    if (is_new) {
      CGAL::exact(p);  // else the rounding is that of an interval
      result_.points.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
    }
    return entry->second;
  }

  std::size_t vertex(std::size_t triangle, std::size_t k) { return vertex(exact_[soup_.triangles[triangle][k]]); }

  std::vector<Group> groups(const std::vector<std::array<std::size_t, 2>>& pairs) {
    UnionFind sets(id32(soup_.triangles.size()));
    std::map<std::size_t, std::vector<std::array<Point3, 2>>> cuts;
    for (const auto& [s, t] : pairs) {
      const auto common = CGAL::intersection(exact_triangle(s), exact_triangle(t));
      if (!common) continue;
      std::vector<std::array<Point3, 2>> segments;
      if (const auto* p = boost::get<Point3>(&*common)) {
        segments.push_back({*p, *p});
      } else if (const auto* segment = boost::get<Exact::Segment_3>(&*common)) {
        segments.push_back({segment->source(), segment->target()});
      } else {  // an area: both triangles are cut along all their edges, since they are in one group
        sets.unite(id32(s), id32(t));
      }
      for (const auto& [a, b] : segments) {  // evaluated once and for all, not at each predicate
        CGAL::exact(a);
        CGAL::exact(b);
      }
      for (const std::size_t i : {s, t}) {
        auto& list = cuts[i];
        list.insert(list.end(), segments.begin(), segments.end());
      }
    }
    std::map<std::int32_t, Group> by_set;
    for (auto& [t, segments] : cuts) {
      Group& group = by_set[sets.find(id32(t))];
      group.triangles.push_back(t);
      group.segments.insert(group.segments.end(), segments.begin(), segments.end());
    }
    std::vector<Group> result;
    for (auto& [set, group] : by_set) result.push_back(std::move(group));
    return result;
  }

  void cut_group(const Group& group) {
    const Plane plane(exact_triangle(group.triangles.front()));
    Triangulation cdt;
    std::vector<Exact::Triangle_2> outlines;
    for (const std::size_t t : group.triangles) {
      const auto p = [&](std::size_t k) { return plane.down(exact_[soup_.triangles[t][k]]); };
      outlines.emplace_back(p(0), p(1), p(2));
      for (std::size_t k = 0; k < 3; ++k) cdt.insert_constraint(p(k), p((k + 1) % 3));
    }
    for (const auto& [a, b] : group.segments) {
      if (a == b)
        cdt.insert(plane.down(a));
      else
        cdt.insert_constraint(plane.down(a), plane.down(b));
    }
    for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
      Triangle piece{};
      for (int k = 0; k < 3; ++k) piece[static_cast<std::size_t>(k)] = vertex(plane.up(f->vertex(k)->point()));
      const Point2 centre = CGAL::centroid(f->vertex(0)->point(), f->vertex(1)->point(), f->vertex(2)->point());
      for (const Exact::Triangle_2& outline : outlines) {
        if (!outline.has_on_bounded_side(centre)) continue;
        result_.triangles.push_back(
            outline.orientation() == CGAL::COUNTERCLOCKWISE ? piece : Triangle{piece[0], piece[2], piece[1]});
      }
    }
  }

  const Soup& soup_;
  std::vector<Point3> exact_;  // the soup's points
  std::map<Point3, std::size_t> ids_;
  Soup result_;
};

// A triangle of the arrangement with the number of times it runs one way less the number it runs the other.
struct Wall {
  Triangle corners{};
  int multiplicity = 0;
};

std::vector<Wall> walls_of(const Soup& soup) {
  std::map<Triangle, Wall> walls;
  for (const Triangle& t : soup.triangles) {
    Triangle key = t;
    std::sort(key.begin(), key.end());
    Wall& wall = walls.try_emplace(key, Wall{t, 0}).first->second;
    const auto turn = std::find(t.begin(), t.end(), wall.corners[0]) - t.begin();
    const bool same = t[static_cast<std::size_t>(turn + 1) % 3] == wall.corners[1];
    wall.multiplicity += same ? 1 : -1;
  }
  std::vector<Wall> result;
  for (const auto& [key, wall] : walls) result.push_back(wall);
  return result;
}

using WallsOfEdge = std::map<std::array<std::size_t, 2>, std::vector<std::size_t>>;

WallsOfEdge walls_of_edges(const std::vector<Wall>& walls) {
  WallsOfEdge edges;
  for (std::size_t w = 0; w < walls.size(); ++w)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = walls[w].corners[k], b = walls[w].corners[(k + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}].push_back(w);
    }
  return edges;
}

// Sets of walls that hang together across edges with two walls each.
std::vector<std::vector<std::size_t>> patches_of(const std::vector<Wall>& walls, const WallsOfEdge& edges) {
  UnionFind sets(id32(walls.size()));
  const auto same_multiplicity = [&](std::size_t a, std::size_t b) {
    return std::abs(walls[a].multiplicity) == std::abs(walls[b].multiplicity);
  };
  for (const auto& [edge, around] : edges)
    if (around.size() == 2 && same_multiplicity(around[0], around[1])) sets.unite(id32(around[0]), id32(around[1]));
  std::map<std::int32_t, std::vector<std::size_t>> patches;
  for (std::size_t w = 0; w < walls.size(); ++w) patches[sets.find(id32(w))].push_back(w);
  std::vector<std::vector<std::size_t>> result;
  for (auto& [set, patch] : patches) result.push_back(std::move(patch));
  return result;
}

// Signed solid angle of a triangle as seen from p, in units of the whole sphere (van Oosterom and Strackee 1983).
double solid_angle(const Soup& soup, const Triangle& t, const Inexact::Point_3& p) {
  const Inexact::Vector_3 a = soup.points[t[0]] - p, b = soup.points[t[1]] - p, c = soup.points[t[2]] - p;
  const double la = std::sqrt(a * a), lb = std::sqrt(b * b), lc = std::sqrt(c * c);
  const double above = a * CGAL::cross_product(b, c);
  const double below = la * lb * lc + (a * b) * lc + (b * c) * la + (c * a) * lb;
  return std::atan2(above, below) / (2 * std::numbers::pi);
}

double area2(const Soup& soup, const Wall& wall) {
  return CGAL::squared_area(soup.points[wall.corners[0]], soup.points[wall.corners[1]], soup.points[wall.corners[2]]);
}

// Takes away patches with a free edge, which have the same space on both sides, until there are none. Returns their
// area.
double drop_dangling(const Soup& soup, std::vector<Wall>& walls) {
  double dropped = 0;
  while (true) {
    const WallsOfEdge edges = walls_of_edges(walls);
    std::vector<char> dangling(walls.size(), 0);
    for (const auto& [edge, around] : edges)
      if (around.size() == 1) dangling[around[0]] = 1;
    if (std::none_of(dangling.begin(), dangling.end(), [](char d) { return d; })) return dropped;
    for (const std::vector<std::size_t>& patch : patches_of(walls, edges)) {
      if (std::none_of(patch.begin(), patch.end(), [&](std::size_t w) { return dangling[w]; })) continue;
      for (const std::size_t w : patch) {
        dangling[w] = 1;
        dropped += std::sqrt(area2(soup, walls[w]));
      }
    }
    std::size_t next = 0;
    for (std::size_t w = 0; w < walls.size(); ++w)
      if (!dangling[w]) walls[next++] = walls[w];
    walls.resize(next);
  }
}

// The walls between inside and outside, turned outward.
Soup boundary_of_inside(const Soup& soup) {
  std::vector<Wall> walls = walls_of(soup);
  double area = 0;
  for (const Wall& wall : walls) area += std::sqrt(area2(soup, wall));
  if (drop_dangling(soup, walls) > kMostDangling * area)
    throw std::runtime_error("a good part of the surface has free edges and separates nothing");
  Soup result{.points = soup.points, .triangles = {}};
  for (const std::vector<std::size_t>& patch : patches_of(walls, walls_of_edges(walls))) {
    const std::size_t widest = *std::max_element(patch.begin(), patch.end(), [&](std::size_t a, std::size_t b) {
      return area2(soup, walls[a]) < area2(soup, walls[b]);
    });
    const Wall& wall = walls[widest];
    const Inexact::Point_3 centre =
        CGAL::centroid(soup.points[wall.corners[0]], soup.points[wall.corners[1]], soup.points[wall.corners[2]]);
    double winding = 0;  // on the wall itself, which is the mean of its two sides
    for (std::size_t w = 0; w < walls.size(); ++w)
      if (w != widest) winding += walls[w].multiplicity * solid_angle(soup, walls[w].corners, centre);
    const bool behind = winding + wall.multiplicity / 2.0 > 0.5, before = winding - wall.multiplicity / 2.0 > 0.5;
    if (behind == before) continue;
    for (const std::size_t w : patch) {
      Triangle t = walls[w].corners;
      // Within a patch corners may run either way; where the wall counts tells.
      const bool outward = (walls[w].multiplicity > 0) == (wall.multiplicity > 0);
      if (behind != outward) std::swap(t[1], t[2]);
      result.triangles.push_back(t);
    }
  }
  return result;
}

void snap(Soup& soup, double grid) {
  for (auto& p : soup.points)
    p = {grid * std::round(p.x() / grid), grid * std::round(p.y() / grid), grid * std::round(p.z() / grid)};
}

Point3 exact(const Inexact::Point_3& p) {
  return {p.x(), p.y(), p.z()};
}

Point3 first_point(const Exact::Triangle_3& s, const Exact::Triangle_3& t) {
  const auto common = CGAL::intersection(s, t);
  if (!common) return s.vertex(0);
  if (const auto* p = boost::get<Point3>(&*common)) return *p;
  if (const auto* segment = boost::get<Exact::Segment_3>(&*common))
    return CGAL::midpoint(segment->source(), segment->target());
  if (const auto* triangle = boost::get<Exact::Triangle_3>(&*common))
    return CGAL::centroid(triangle->vertex(0), triangle->vertex(1), triangle->vertex(2));
  const auto& polygon = boost::get<std::vector<Point3>>(*common);
  return CGAL::centroid(polygon[0], polygon[1], polygon[2]);
}

}  // namespace

Answer find_intersections(const Request& request) {
  Soup soup = soup_of(request);
  weld_and_drop_flat(soup);
  const auto pairs = intersecting_pairs(soup);
  Answer answer;
  answer.changed = static_cast<std::int64_t>(pairs.size());
  const auto triangle = [&](std::size_t t) {
    return Exact::Triangle_3(exact(soup.corner(t, 0)), exact(soup.corner(t, 1)), exact(soup.corner(t, 2)));
  };
  for (std::size_t i = 0; i < pairs.size() && static_cast<double>(i) < request.size; ++i) {
    const Point3 p = first_point(triangle(pairs[i][0]), triangle(pairs[i][1]));
    answer.points.insert(answer.points.end(), {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())});
  }
  return answer;
}

Answer resolve(const Request& request) {
  Soup soup = soup_of(request);
  const double grid = request.size > 0 ? std::exp2(std::floor(std::log2(request.size * diagonal(soup)))) : 0;
  std::int64_t cut = 0;
  for (int round = 0;; ++round) {
    if (grid > 0) snap(soup, grid);
    weld_and_drop_flat(soup);
    const auto pairs = intersecting_pairs(soup);
    if (round == 0) cut = static_cast<std::int64_t>(pairs.size());
    if (pairs.empty()) break;
    if (round == kMostRounds) throw std::runtime_error("rounding makes new intersections again and again");
    soup = Arrangement(soup).cut(pairs);
  }
  const Soup boundary = boundary_of_inside(soup);
  if (boundary.triangles.empty()) throw std::runtime_error("the surface encloses no volume");
  Answer answer = answer_of(boundary);
  answer.changed = cut;
  return answer;
}

}  // namespace matstruct::mesher
