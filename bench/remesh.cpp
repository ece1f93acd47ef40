// Another mesh of the same surface, for run_stability.py: edges of one length, vertices on the given surface, sharp
// edges kept (CGAL's isotropic remeshing). Where the surface is smooth, the triangles lie otherwise than the given ones
// and their angles differ.
//
//   remesh SURFACE OUTPUT.ply
#include <cstdio>
#include <stdexcept>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

#include <matstruct/io.h>

#include "base/index.h"
#include "geometry/box.h"

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

constexpr double kLength = 0.01;  // of the edges, in bounding-box diagonals
constexpr double kAngle = 10;     // edges that turn by more than this, in degrees, stay
constexpr unsigned kIterations = 5;

Mesh mesh_of(const matstruct::TriSurface& surface) {
  std::vector<Kernel::Point_3> points;
  for (const auto& v : surface.vertices) points.emplace_back(v.x, v.y, v.z);
  std::vector<std::vector<std::size_t>> triangles;
  for (const auto& t : surface.triangles)
    triangles.push_back({matstruct::uz(t[0]), matstruct::uz(t[1]), matstruct::uz(t[2])});
  if (!pmp::is_polygon_soup_a_polygon_mesh(triangles)) throw std::runtime_error("the surface is not manifold");
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, triangles, mesh);
  return mesh;
}

matstruct::TriSurface surface_of(Mesh& mesh) {
  mesh.collect_garbage();
  matstruct::TriSurface surface;
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    surface.vertices.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : mesh.faces()) {
    matstruct::Triangle t{};
    std::size_t k = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) t[k++] = static_cast<matstruct::Index>(v);
    surface.triangles.push_back(t);
  }
  return surface;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: remesh SURFACE OUTPUT.ply\n");
    return 2;
  }
  try {
    const matstruct::TriSurface given = matstruct::read_surface(argv[1]);
    const double length = kLength * matstruct::box_diagonal(given.vertices);
    Mesh mesh = mesh_of(given);
    auto sharp = mesh.add_property_map<Mesh::Edge_index, bool>("e:sharp", false).first;
    pmp::detect_sharp_edges(mesh, kAngle, sharp);
    std::vector<Mesh::Edge_index> lines;
    for (const auto e : mesh.edges())
      if (sharp[e]) lines.push_back(e);
    pmp::split_long_edges(lines, length, mesh, CGAL::parameters::edge_is_constrained_map(sharp));
    pmp::isotropic_remeshing(
        faces(mesh), length, mesh,
        CGAL::parameters::number_of_iterations(kIterations).edge_is_constrained_map(sharp).protect_constraints(true));
    matstruct::write_ply(surface_of(mesh), argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "remesh: %s\n", error.what());
    return 1;
  }
  return 0;
}
