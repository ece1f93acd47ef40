#include <matstruct/compute.h>
#include <matstruct/version.h>

#include <nlohmann/json.hpp>

namespace matstruct {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Betti& b) {
  return Json::array({b.b0, b.b1, b.b2});
}

const char* name_of(ShapeKind shape) {
  switch (shape) {
    case ShapeKind::kMechanical:
      return "mechanical";
    case ShapeKind::kOrganic:
      return "organic";
    default:
      return "auto";
  }
}

Json json_of(const Options& o) {
  return {{"gamma", o.gamma},
          {"convex_angle", o.convex_angle},
          {"concave_angle", o.concave_angle},
          {"shape", name_of(o.shape)},
          {"thinning", o.thinning},
          {"deviation", o.deviation},
          {"refinements", o.refinements},
          {"volume_classification", o.volume_classification},
          {"seams", o.seams},
          {"clean", o.clean},
          {"remesh", o.remesh},
          {"particle_rounds", o.particle_rounds},
          {"particle_change", o.particle_change},
          {"particle_gradient", o.particle_gradient},
          {"gradient_projection", o.gradient_projection},
          {"max_rounds", o.max_rounds},
          {"seed", o.seed},
          {"samples", o.samples},
          {"threads", o.threads}};
}

// Not-a-number, which JSON does not have, becomes null.
Json json_of(const Repair& r) {
  return {{"steps", r.steps},
          {"volume_change_percent", r.volume_change_percent},
          {"distance_percent", r.distance_percent},
          {"sharp_edges_kept_percent", r.sharp_edges_kept_percent}};
}

Json json_of(const Report::Input& i) {
  return {{"file", i.file},
          {"part", i.part},
          {"tets", i.tets},
          {"surface_triangles", i.surface_triangles},
          {"diagonal", i.diagonal},
          {"volume", i.volume},
          {"betti", json_of(i.betti)},
          {"repair", json_of(i.repair)},
          {"deviation_percent", i.deviation_percent},
          {"seconds", i.seconds}};
}

Json json_of(const Report::Strata& s) {
  return {{"sheets", s.sheets},
          {"seams", s.seams},
          {"junctions", s.junctions},
          {"boundaries", s.boundaries},
          {"curves", s.curves},
          {"seam_spheres", s.seam_spheres},
          {"seam_spheres_tangent", s.seam_spheres_tangent},
          {"junction_spheres", s.junction_spheres},
          {"junction_spheres_tangent", s.junction_spheres_tangent},
          {"stray_seam_spheres", s.stray_seam_spheres},
          {"worst_tangency", s.worst_tangency}};
}

Json json_of(const std::vector<StageCost>& stages) {
  Json list = Json::array();
  for (const StageCost& s : stages)
    list.push_back({{"name", s.name}, {"seconds", s.seconds}, {"peak_memory_mib", s.peak_memory_mib}});
  return list;
}

}  // namespace

std::string report_json(const Result& result) {
  const Report& r = result.report;
  Json json;
  json["version"] = kVersion;
  json["options"] = json_of(r.options);
  json["input"] = json_of(r.input);
  json["mesh"] = {{"spheres", result.mesh.centers.size()},
                  {"edges", result.mesh.edges.size()},
                  {"faces", result.mesh.faces.size()}};
  json["topology"] = {{"betti", json_of(r.topology.betti)}, {"equal", r.topology.equal}};
  json["thin"] = {{"tetrahedra", r.thin.tetrahedra}, {"pockets", r.thin.pockets}, {"holds", r.thin.holds}};
  json["tiling"] = {
      {"volume_error", r.tiling.volume_error}, {"euler_equal", r.tiling.euler_equal}, {"holds", r.tiling.holds}};
  json["features"] = {{"lines", r.features.lines},
                      {"lines_preserved", r.features.lines_preserved},
                      {"corners", r.features.corners},
                      {"holds", r.features.holds}};
  json["preservation"] = {{"rounds", r.preservation.rounds},
                          {"inserted", r.preservation.inserted},
                          {"violations_left", r.preservation.violations_left},
                          {"holds", r.preservation.holds}};
  json["particles"] = {{"rounds", r.particles.rounds}, {"converged", r.particles.converged}};
  json["structure"] = json_of(r.structure);
  json["metrics"] = {{"triangle_quality", r.metrics.triangle_quality},
                     {"hausdorff_percent", r.metrics.hausdorff_percent},
                     {"surface_to_envelope_percent", r.metrics.surface_to_envelope_percent},
                     {"envelope_to_surface_percent", r.metrics.envelope_to_surface_percent},
                     {"medialness_mean_percent", r.metrics.medialness_mean_percent},
                     {"medialness_max_percent", r.metrics.medialness_max_percent},
                     {"mser", r.metrics.mser},
                     {"spikes", r.metrics.spikes},
                     {"spike_share", r.metrics.spike_share}};
  json["stages"] = json_of(r.stages);
  json["seconds"] = r.seconds;
  json["peak_memory_mib"] = r.peak_memory_mib;
  json["warnings"] = r.warnings;
  json["guarantees_hold"] = r.guarantees_hold;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace matstruct
