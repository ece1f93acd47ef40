// matstruct evaluate: the measures of any .ma file, of this program or another.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <matstruct/io.h>
#include <matstruct/metrics.h>
#include <matstruct/options.h>

#include "boundary.h"
#include "commands.h"
#include "console.h"

namespace matstruct::tool {

namespace {

using Json = nlohmann::ordered_json;
using Replace = nlohmann::json::error_handler_t;  // file names need not be UTF-8

struct EvaluateArguments {
  std::filesystem::path mesh;
  std::filesystem::path surface;
  std::filesystem::path other;  // to compare with; empty: none
  Index samples = Options{}.samples;
  double convex_angle = Options{}.convex_angle;
  bool json = false;
  ConsoleOptions console;
};

struct Evaluation {
  MedialMesh mesh;
  Betti betti;
  Thinness thin;
  double triangle_quality = 0;
  Hausdorff hausdorff;
  Medialness medialness;
  StructureErrors errors;
  StructureCounts structure;
  Spacing spacing;
  std::optional<MeshComparison> comparison;
};

Evaluation evaluate(const EvaluateArguments& arguments, Context& context) {
  Evaluation result;
  result.mesh = naming(arguments.mesh, [&] { return read_ma(arguments.mesh); });
  const TriSurface surface = read_boundary(arguments.surface, context);
  result.betti = betti_numbers(result.mesh);
  result.thin = thinness(result.mesh);
  result.triangle_quality = triangle_quality(result.mesh);
  result.hausdorff = hausdorff_distance(result.mesh, surface, arguments.samples, context);
  result.medialness = medialness(result.mesh, surface, arguments.samples, context);
  result.errors = structure_errors(result.mesh, surface, arguments.convex_angle, context);
  result.structure = structure_counts(result.mesh);
  result.spacing = spacing(result.mesh);
  if (!arguments.other.empty())
    result.comparison = naming(arguments.other, [&] {
      return compare_meshes(result.mesh, read_ma(arguments.other), arguments.samples, context);
    });
  return result;
}

double percent(double distance, const Hausdorff& hausdorff) {
  return 100 * distance / hausdorff.diagonal;
}

Json json_of(const StructureCounts& s) {
  return {{"sheets", s.sheets},
          {"seams", s.seams},
          {"closed_seams", s.closed_seams},
          {"boundaries", s.boundaries},
          {"closed_boundaries", s.closed_boundaries},
          {"curves", s.curves},
          {"closed_curves", s.closed_curves},
          {"junctions", s.junctions},
          {"corners", s.corners}};
}

Json json_of(const StructureErrors& e) {
  return {{"told_by", e.told_by_types ? "types" : "strata"},
          {"seam_spheres", e.seam_spheres},
          {"seam_spheres_wrong", e.seam_spheres_wrong},
          {"junction_spheres", e.junction_spheres},
          {"junction_spheres_wrong", e.junction_spheres_wrong},
          {"sheet_spheres", e.sheet_spheres},
          {"wrong_spheres", e.wrong}};
}

Json json_of(const EdgeLengths& l) {
  return {{"edges", l.edges}, {"min", l.min}, {"mean", l.mean}, {"max", l.max}, {"variation", l.variation}};
}

Json json_of(const MeshComparison::Side& side, const Hausdorff& h) {
  return {{"max_distance_percent", percent(side.max_distance, h)},
          {"mean_distance_percent", percent(side.mean_distance, h)},
          {"max_radius_difference_percent", percent(side.max_radius_difference, h)},
          {"mean_radius_difference_percent", percent(side.mean_radius_difference, h)}};
}

Json metrics_json(const Evaluation& e) {
  const Hausdorff& h = e.hausdorff;
  return {{"triangle_quality", e.triangle_quality},
          {"hausdorff_percent", h.percent()},
          {"surface_to_envelope_percent", percent(h.surface_to_envelope, h)},
          {"envelope_to_surface_percent", percent(h.envelope_to_surface, h)},
          {"mean_surface_to_envelope_percent", percent(h.mean_surface_to_envelope, h)},
          {"mean_envelope_to_surface_percent", percent(h.mean_envelope_to_surface, h)},
          {"medialness_mean_percent", percent(e.medialness.mean, h)},
          {"medialness_max_percent", percent(e.medialness.max, h)},
          {"mser", e.errors.mser()},
          {"spikes", e.errors.spikes},
          {"spike_share", e.errors.spike_share()}};
}

/// The same names as in the report of a computation.
Json to_json(const EvaluateArguments& arguments, const Evaluation& e) {
  Json json = {
      {"file", arguments.mesh.string()},
      {"surface", arguments.surface.string()},
      {"mesh", {{"spheres", e.mesh.centers.size()}, {"edges", e.mesh.edges.size()}, {"faces", e.mesh.faces.size()}}},
      {"topology", {{"betti", {e.betti.b0, e.betti.b1, e.betti.b2}}}},
      {"thin", {{"tetrahedra", e.thin.tetrahedra}, {"pockets", e.thin.pockets}}},
      {"metrics", metrics_json(e)},
      {"structure", json_of(e.structure)},
      {"structure_errors", json_of(e.errors)},
      {"spacing",
       {{"sheets", json_of(e.spacing.sheets)},
        {"seams", json_of(e.spacing.seams)},
        {"boundaries", json_of(e.spacing.boundaries)},
        {"curves", json_of(e.spacing.curves)}}}};
  if (e.comparison)
    json["comparison"] = {{"file", arguments.other.string()},
                          {"hausdorff_percent", percent(e.comparison->hausdorff(), e.hausdorff)},
                          {"to_other", json_of(e.comparison->first_to_second, e.hausdorff)},
                          {"from_other", json_of(e.comparison->second_to_first, e.hausdorff)},
                          {"structure", json_of(e.comparison->second)},
                          {"structure_equal", e.comparison->first == e.comparison->second}};
  return json;
}

std::string in_words(const StructureCounts& s) {
  return fmt::format("{} sheets, {} seams, {} junctions, {} corners, {} boundaries, {} curves", s.sheets, s.seams,
                     s.junctions, s.corners, s.boundaries, s.curves);
}

void print_structure(const Evaluation& e) {
  const StructureErrors& errors = e.errors;
  fmt::print("structure                  {}\n", in_words(e.structure));
  fmt::print("MSER                       {:.4f}: {} of {} seam and {} of {} junction spheres wrong, told by {}\n",
             errors.mser(), errors.seam_spheres_wrong, errors.seam_spheres, errors.junction_spheres_wrong,
             errors.junction_spheres, errors.told_by_types ? "their types" : "the faces at edges");
  fmt::print("spikes                     {} of {} sheet spheres\n", errors.spikes, errors.sheet_spheres);
  const auto line = [&](const char* kind, const EdgeLengths& l) {
    if (l.edges > 0)
      fmt::print("  on {:<22}  {} edges, length {:.4g} to {:.4g}, mean {:.4g}, variation {:.2f}\n", kind, l.edges,
                 l.min, l.max, l.mean, l.variation);
  };
  fmt::print("spacing\n");
  line("sheets", e.spacing.sheets);
  line("seams", e.spacing.seams);
  line("boundaries", e.spacing.boundaries);
  line("curves", e.spacing.curves);
}

void print_comparison(const MeshComparison& c, const Hausdorff& h) {
  fmt::print("compared with the other    {:.4f} % of the diagonal\n", percent(c.hausdorff(), h));
  const auto line = [&](const char* direction, const MeshComparison::Side& side) {
    fmt::print("  {:<24} {:.4f} %, mean {:.4f} %; radii differ by {:.4f} %, mean {:.4f} %\n", direction,
               percent(side.max_distance, h), percent(side.mean_distance, h), percent(side.max_radius_difference, h),
               percent(side.mean_radius_difference, h));
  };
  line("to the other", c.first_to_second);
  line("from the other", c.second_to_first);
  fmt::print("  structure of the other   {}{}\n", in_words(c.second), c.first == c.second ? ": the same" : "");
}

void print_table(const Evaluation& e) {
  const Hausdorff& h = e.hausdorff;
  fmt::print("spheres, edges, faces      {}, {}, {}\n", e.mesh.centers.size(), e.mesh.edges.size(),
             e.mesh.faces.size());
  fmt::print("components, tunnels, voids {}, {}, {}\n", e.betti.b0, e.betti.b1, e.betti.b2);
  fmt::print("tetrahedra                 {}\n", e.thin.tetrahedra);
  fmt::print("triangle quality           {:.4f}\n", e.triangle_quality);
  fmt::print("Hausdorff distance         {:.4f} % of the diagonal\n", h.percent());
  fmt::print("  surface to envelope      {:.4f} %, mean {:.4f} %\n", percent(h.surface_to_envelope, h),
             percent(h.mean_surface_to_envelope, h));
  fmt::print("  envelope to surface      {:.4f} %, mean {:.4f} %\n", percent(h.envelope_to_surface, h),
             percent(h.mean_envelope_to_surface, h));
  fmt::print("medialness of faces        {:.4f} %, mean {:.4f} %\n", percent(e.medialness.max, h),
             percent(e.medialness.mean, h));
  print_structure(e);
  if (e.comparison) print_comparison(*e.comparison, h);
}

int evaluate_command(const EvaluateArguments& arguments) {
  Console console(arguments.console);
  const Evaluation evaluation = evaluate(arguments, console.context());
  console.finish();
  if (arguments.json)
    fmt::print("{}\n", to_json(arguments, evaluation).dump(2, ' ', false, Replace::replace));
  else
    print_table(evaluation);
  return kDone;
}

}  // namespace

Action add_evaluate(CLI::App& command) {
  auto arguments = std::make_shared<EvaluateArguments>();
  command.add_option("MESH", arguments->mesh, "medial mesh (.ma)")->required();
  command.add_option("--surface", arguments->surface, "surface of the solid, or its tetrahedral mesh")
      ->type_name("FILE")
      ->required();
  command.add_option("--compare", arguments->other, "another medial mesh of the solid (.ma), to compare with")
      ->type_name("FILE");
  command
      .add_option("--convex-angle", arguments->convex_angle,
                  "contacts are distinct across edges with a dihedral angle below 180 - this; in (0, 180)")
      ->type_name("DEGREES")
      ->check(CLI::Range(0.001, 179.999).description(""))
      ->capture_default_str();
  command
      .add_option("--samples", arguments->samples,
                  "points on either side of the Hausdorff distance, and for each other mean; at least 1000")
      ->type_name("N")
      ->check(CLI::Range(1000, 100'000'000).description(""))
      ->capture_default_str();
  command.add_flag("--json", arguments->json, "print JSON");
  add_console_options(command, arguments->console);
  return [arguments] { return evaluate_command(*arguments); };
}

}  // namespace matstruct::tool
