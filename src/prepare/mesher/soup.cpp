#include "prepare/mesher/soup.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

namespace matstruct::mesher {

namespace {

using Triangle = std::array<std::size_t, 3>;

// Triangles with one corner in common: one of them is cut by the edge of the other that is opposite to it.
bool cut_beside_vertex(const Soup& soup, std::size_t s, std::size_t t, std::size_t common) {
  const auto cuts = [&](std::size_t edge_of, std::size_t other) {
    const Triangle& v = soup.triangles[edge_of];
    const std::size_t k = static_cast<std::size_t>(std::find(v.begin(), v.end(), common) - v.begin());
    return CGAL::do_intersect(Inexact::Segment_3(soup.corner(edge_of, (k + 1) % 3), soup.corner(edge_of, (k + 2) % 3)),
                              soup.triangle(other));
  };
  return cuts(s, t) || cuts(t, s);
}

// Triangles with an edge in common: they lie in one plane and on the same side of it.
bool folded(const Soup& soup, std::size_t s, std::size_t t) {
  const Triangle &v = soup.triangles[s], &w = soup.triangles[t];
  const auto apex = [](const Triangle& of, const Triangle& other) {
    return *std::find_if(of.begin(), of.end(),
                         [&](std::size_t i) { return std::find(other.begin(), other.end(), i) == other.end(); });
  };
  const std::size_t p = apex(v, w), q = apex(w, v);
  Triangle edge = v;
  std::rotate(edge.begin(), std::find(edge.begin(), edge.end(), p), edge.end());
  const auto &a = soup.points[edge[1]], &b = soup.points[edge[2]], &x = soup.points[p], &y = soup.points[q];
  return CGAL::coplanar(a, b, x, y) && CGAL::coplanar_orientation(a, b, x, y) == CGAL::POSITIVE;
}

bool meet(const Soup& soup, std::size_t s, std::size_t t) {
  std::size_t shared = 0, common = 0;
  for (const std::size_t i : soup.triangles[s])
    for (const std::size_t j : soup.triangles[t])
      if (i == j) ++shared, common = i;
  if (shared == 0) return CGAL::do_intersect(soup.triangle(s), soup.triangle(t));
  if (shared == 1) return cut_beside_vertex(soup, s, t, common);
  return shared == 2 && folded(soup, s, t);
}

}  // namespace

Soup soup_of(const Request& request) {
  Soup soup;
  for (std::size_t i = 0; i + 2 < request.points.size(); i += 3)
    soup.points.emplace_back(request.points[i], request.points[i + 1], request.points[i + 2]);
  for (std::size_t i = 0; i + 2 < request.corners.size(); i += 3)
    soup.triangles.push_back({static_cast<std::size_t>(request.corners[i]),
                              static_cast<std::size_t>(request.corners[i + 1]),
                              static_cast<std::size_t>(request.corners[i + 2])});
  return soup;
}

Answer answer_of(const Soup& soup) {
  Answer answer;
  std::vector<std::int32_t> id(soup.points.size(), -1);
  for (const Triangle& t : soup.triangles)
    for (const std::size_t v : t) {
      if (id[v] < 0) {
        id[v] = static_cast<std::int32_t>(answer.points.size() / 3);
        answer.points.insert(answer.points.end(), {soup.points[v].x(), soup.points[v].y(), soup.points[v].z()});
      }
      answer.corners.push_back(id[v]);
    }
  return answer;
}

void weld_and_drop_flat(Soup& soup) {
  std::map<Inexact::Point_3, std::size_t> first;
  for (std::size_t i = 0; i < soup.points.size(); ++i) first.try_emplace(soup.points[i], i);
  for (Triangle& t : soup.triangles)
    for (std::size_t& v : t) v = first.at(soup.points[v]);
  std::erase_if(soup.triangles, [&](const Triangle& t) {
    return CGAL::collinear(soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]);
  });
}

std::vector<std::array<std::size_t, 2>> intersecting_pairs(const Soup& soup) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
  std::vector<Box> boxes;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) boxes.emplace_back(soup.triangle(t).bbox(), t);
  std::vector<std::array<std::size_t, 2>> pairs;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    const std::size_t s = std::min(a.info(), b.info()), t = std::max(a.info(), b.info());
    if (meet(soup, s, t)) pairs.push_back({s, t});
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

double diagonal(const Soup& soup) {
  if (soup.points.empty()) return 0;
  CGAL::Bbox_3 box = soup.points.front().bbox();
  for (const auto& p : soup.points) box += p.bbox();
  return std::hypot(box.x_span(), box.y_span(), box.z_span());
}

}  // namespace matstruct::mesher
