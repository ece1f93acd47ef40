// Closing of open surfaces, by CGAL.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include "prepare/mesher/soup.h"
#include "prepare/mesher/tasks.h"

namespace matstruct::mesher {

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Mesh = CGAL::Surface_mesh<Inexact::Point_3>;

constexpr double kSlit = 0.02;       // a hole of any length is filled if it is this much narrower than the greatest
constexpr double kWrapOffset = 0.1;  // of the size of a wrap

Answer answer_of(const Mesh& mesh) {
  Soup soup;
  for (const auto v : mesh.vertices()) soup.points.push_back(mesh.point(v));
  for (const auto f : mesh.faces()) {
    std::array<std::size_t, 3> t{};
    std::size_t k = 0;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) t[k++] = v.idx();
    soup.triangles.push_back(t);
  }
  return mesher::answer_of(soup);
}

// Faces are oriented alike where possible; vertices and edges of many faces are doubled.
Mesh make_mesh(Soup soup) {
  PMP::orient_polygon_soup(soup.points, soup.triangles);
  Mesh mesh;
  PMP::polygon_soup_to_polygon_mesh(soup.points, soup.triangles, mesh);
  return mesh;
}

// Diameter of the box around a border, and its length.
struct Extent {
  double diameter = 0, length = 0;
};

Extent extent_of(const Mesh& mesh, Mesh::Halfedge_index border) {
  Extent extent;
  CGAL::Bbox_3 box;
  for (const auto h : CGAL::halfedges_around_face(border, mesh)) {
    box += mesh.point(mesh.target(h)).bbox();
    extent.length += std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
  }
  extent.diameter = std::hypot(box.x_span(), box.y_span(), box.z_span());
  return extent;
}

double area_of(const Mesh& mesh, const std::vector<Mesh::Face_index>& faces) {
  double area = 0;
  for (const auto f : faces) {
    std::array<Inexact::Point_3, 3> p;
    std::size_t k = 0;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) p[k++] = mesh.point(v);
    area += std::sqrt(CGAL::squared_area(p[0], p[1], p[2]));
  }
  return area;
}

}  // namespace

Answer fill_holes(const Request& request) {
  Soup soup = soup_of(request);
  weld_and_drop_flat(soup);
  const double greatest = request.size * diagonal(soup);
  Mesh mesh = make_mesh(std::move(soup));
  std::vector<Mesh::Halfedge_index> borders;
  PMP::extract_boundary_cycles(mesh, std::back_inserter(borders));
  std::int64_t filled = 0;
  std::size_t left = 0;
  for (const auto border : borders) {
    const Extent extent = extent_of(mesh, border);
    std::vector<Mesh::Face_index> patch;
    if (mesh.next(mesh.next(mesh.next(border))) == border) {  // maybe without area, which the triangulation avoids
      CGAL::Euler::fill_hole(border, mesh);
      patch.push_back(mesh.face(border));
    } else {
      PMP::triangulate_hole(mesh, border, std::back_inserter(patch));
    }
    const bool slit = 2 * area_of(mesh, patch) <= kSlit * greatest * extent.length;
    if (!patch.empty() && (extent.diameter <= greatest || slit)) {
      ++filled;
      continue;
    }
    for (const auto f : patch) CGAL::Euler::remove_face(mesh.halfedge(f), mesh);
    ++left;
  }
  if (left > 0)
    throw std::runtime_error(std::to_string(left) + (left == 1 ? " hole is" : " holes are") +
                             " larger than the hole size");
  if (filled == 0) throw std::runtime_error("there is no hole to fill");
  mesh.collect_garbage();
  Answer answer = answer_of(mesh);
  answer.changed = filled;
  return answer;
}

Answer wrap(const Request& request) {
  Soup soup = soup_of(request);
  weld_and_drop_flat(soup);
  const double size = request.size * diagonal(soup);
  Mesh mesh;
  CGAL::alpha_wrap_3(soup.points, soup.triangles, size, kWrapOffset * size, mesh);
  if (mesh.number_of_faces() == 0) throw std::runtime_error("the wrap is empty");
  return answer_of(mesh);
}

}  // namespace matstruct::mesher
