#include <algorithm>

#include <gmsh.h>

#include "prepare/mesher/tasks.h"

namespace matstruct::mesher {

namespace {

constexpr int kTriangle = 2, kTetrahedron = 4;  // Gmsh's element types

void set_options(const Request& request) {
  const auto set = [](const char* name, double value) { gmsh::option::setNumber(name, value); };
  set("General.Terminal", 0);
  set("General.NumThreads", 1);
  set("Mesh.MaxNumThreads3D", 1);
  set("Mesh.Algorithm3D", static_cast<double>(request.algorithm));
  set("Mesh.MeshSizeExtendFromBoundary", 0);  // as coarse inside as the surface allows
  set("Mesh.Renumber", 0);                    // the tags of the request name its vertices in the answer
  if (request.size > 0) set("Mesh.MeshSizeMax", request.size);
  set("Mesh.Optimize", 0);  // takes minutes where, as here, it may not add points; slivers do no harm to exact signs
}

int tag(std::int32_t id) {
  return static_cast<int>(id) + 1;
}  // Gmsh counts from 1

void build_model(const Request& request) {
  const std::size_t vertices = request.points.size() / 3;
  std::vector<std::vector<std::size_t>> shell_nodes;
  for (std::size_t t = 0; t < request.shells.size(); ++t) {
    const auto shell = static_cast<std::size_t>(request.shells[t]);
    if (shell >= shell_nodes.size()) shell_nodes.resize(shell + 1);
    for (std::size_t k = 0; k < 3; ++k)
      shell_nodes[shell].push_back(static_cast<std::size_t>(request.corners[3 * t + k]) + 1);
  }
  for (std::size_t s = 0; s < shell_nodes.size(); ++s) gmsh::model::addDiscreteEntity(2, static_cast<int>(s) + 1);
  std::vector<std::size_t> tags(vertices);
  for (std::size_t v = 0; v < vertices; ++v) tags[v] = v + 1;
  gmsh::model::mesh::addNodes(2, 1, tags, request.points);
  for (std::size_t s = 0; s < shell_nodes.size(); ++s)
    gmsh::model::mesh::addElementsByType(static_cast<int>(s) + 1, kTriangle, {}, shell_nodes[s]);
  gmsh::model::mesh::reclassifyNodes();
  for (std::size_t i = 0; i < request.solids.size();) {
    std::vector<int> loops;
    const auto end = i + 1 + static_cast<std::size_t>(request.solids[i]);
    for (++i; i < end; ++i) loops.push_back(gmsh::model::geo::addSurfaceLoop({tag(request.solids[i])}));
    gmsh::model::geo::addVolume(loops);
  }
  gmsh::model::geo::synchronize();
}

// The request's vertices keep their places; what Gmsh added follows in order of its tags.
Answer collect(const Request& request) {
  Answer answer;
  answer.points = request.points;
  std::vector<std::size_t> tags, elements, nodes;
  std::vector<double> points, parameters;
  gmsh::model::mesh::getNodes(tags, points, parameters, -1, -1, false, false);
  gmsh::model::mesh::getElementsByType(kTetrahedron, elements, nodes);
  if (nodes.empty()) {
    answer.error = "no tetrahedra were made";
    return answer;
  }
  const std::size_t greatest = *std::max_element(tags.begin(), tags.end());
  std::vector<std::size_t> place(greatest + 1, tags.size());
  for (std::size_t i = 0; i < tags.size(); ++i) place[tags[i]] = i;
  std::vector<std::int32_t> id(greatest + 1, -1);
  const std::size_t given = request.points.size() / 3;
  for (std::size_t t = 1; t <= greatest; ++t) {
    if (t <= given) {
      id[t] = static_cast<std::int32_t>(t - 1);
    } else if (place[t] < tags.size()) {
      id[t] = static_cast<std::int32_t>(answer.points.size() / 3);
      answer.points.insert(answer.points.end(), &points[3 * place[t]], &points[3 * place[t]] + 3);
    }
  }
  for (const std::size_t node : nodes) answer.corners.push_back(id[node]);
  return answer;
}

}  // namespace

Answer fill(const Request& request) {
  constexpr bool kReadUserOptions = false;  // a file in the home folder could change the mesh
  gmsh::initialize(0, nullptr, kReadUserOptions);
  set_options(request);
  build_model(request);
  gmsh::model::mesh::generate(3);
  return collect(request);
}

}  // namespace matstruct::mesher
