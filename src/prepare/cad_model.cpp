#include "prepare/cad_model.h"

#include <fmt/format.h>

#include <matstruct/error.h>

#include "base/index.h"
#include "base/tolerances.h"
#include "prepare/mesher_process.h"

namespace matstruct {

CadModel read_cad_model(const std::filesystem::path& file, double deflection, Context& context) {
  mesher::Request request;
  request.task = mesher::Task::kCad;
  request.file = file.string();
  request.size = deflection;
  const mesher::Answer answer = mesher::run(request, tolerance::kMesherSeconds, context);
  if (!answer.error.empty())
    throw Error(
        fmt::format("{}: the CAD file cannot be used: {}; export it again, or as STL.", file.string(), answer.error));
  CadModel model{.solids = {}, .note = answer.note};
  std::size_t point = 0, corner = 0, segment = 0;
  for (std::size_t s = 0; s < answer.solid_points.size(); ++s) {
    CadSolid solid{
        .name = answer.names[s], .surface = {}, .edges = {}, .deviation_percent = 100 * answer.deviations[s]};
    for (Index i = 0; i < answer.solid_points[s]; ++i, point += 3)
      solid.surface.vertices.push_back({answer.points[point], answer.points[point + 1], answer.points[point + 2]});
    for (Index i = 0; i < answer.solid_triangles[s]; ++i, corner += 3)
      solid.surface.triangles.push_back(
          {answer.corners[corner], answer.corners[corner + 1], answer.corners[corner + 2]});
    for (Index i = 0; i < answer.solid_segments[s]; ++i, ++segment)
      solid.edges.push_back({.a = solid.surface.vertices[uz(answer.segments[2 * segment])],
                             .b = solid.surface.vertices[uz(answer.segments[2 * segment + 1])],
                             .dihedral = answer.dihedrals[segment]});
    model.solids.push_back(std::move(solid));
  }
  if (model.solids.empty()) throw Error(fmt::format("{}: the CAD file has no solids; export it again.", file.string()));
  return model;
}

}  // namespace matstruct
