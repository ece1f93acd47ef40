// matstruct reconstruct: the solid that a medial mesh stands for, as a surface.
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <matstruct/io.h>
#include <matstruct/metrics.h>
#include <matstruct/options.h>
#include <matstruct/reconstruct.h>

#include "boundary.h"
#include "commands.h"
#include "console.h"
#include "output_folder.h"
#include "prepare/self_intersection.h"

namespace matstruct::tool {

namespace {

namespace fs = std::filesystem;
using Replace = nlohmann::json::error_handler_t;  // file names need not be UTF-8

struct ReconstructArguments {
  std::filesystem::path mesh;
  std::filesystem::path output;
  std::filesystem::path surface;
  double tolerance_percent = 0.1;
  Index samples = Options{}.samples;
  bool verify = false, json = false;
  ConsoleOptions console;
};

/// Distances between the reconstruction and the input.
struct Deviation {
  SurfaceDistance to_input, from_input;
};

nlohmann::ordered_json to_json(const ReconstructArguments& arguments, const Reconstruction& r,
                               const std::optional<Deviation>& deviation, std::optional<bool> cuts_itself) {
  const auto percent = [&](double distance) { return 100 * distance / r.diagonal; };
  nlohmann::ordered_json json{
      {"file", arguments.mesh.string()},
      {"surface", {{"vertices", r.surface.vertices.size()}, {"triangles", r.surface.triangles.size()}}},
      {"topology",
       {{"components", r.topology.components},
        {"genus", r.topology.genus},
        {"expected_components", r.expected.components},
        {"expected_genus", r.expected.genus},
        {"equal", r.topology == r.expected}}},
      {"envelope",
       {{"tolerance_percent", percent(r.tolerance)},
        {"surface_to_envelope_percent", percent(r.to_envelope)},
        {"envelope_to_surface_percent", percent(r.from_envelope)},
        {"hidden_share", r.hidden_share},
        {"deepest_filling_percent", percent(r.deepest_filling)},
        {"holds", r.within_tolerance()}}}};
  if (cuts_itself) json["surface"]["self_intersection"] = *cuts_itself;
  if (deviation)
    json["input"] = {{"surface_to_input_percent", percent(deviation->to_input.greatest)},
                     {"input_to_surface_percent", percent(deviation->from_input.greatest)},
                     {"mean_surface_to_input_percent", percent(deviation->to_input.mean)},
                     {"mean_input_to_surface_percent", percent(deviation->from_input.mean)}};
  return json;
}

std::string summary(const Reconstruction& r, const std::optional<Deviation>& deviation) {
  const auto percent = [&](double distance) { return 100 * distance / r.diagonal; };
  std::string text = fmt::format(
      "{} triangles, {} components, genus {}; to the envelope and back {:.3f} % and {:.3f} % "
      "of the diagonal",
      r.surface.triangles.size(), r.topology.components, r.topology.genus, percent(r.to_envelope),
      percent(r.from_envelope));
  if (r.deepest_filling > 0)
    text += fmt::format(", tunnels and bubbles of half widths up to {:.2f} % filled", percent(r.deepest_filling));
  if (deviation)
    text += fmt::format(", to the input and back {:.2f} % and {:.2f} %", percent(deviation->to_input.greatest),
                        percent(deviation->from_input.greatest));
  return text + ".";
}

int reconstruct_command(ReconstructArguments arguments) {
  if (arguments.output.empty()) arguments.output = fs::path(arguments.mesh).replace_extension(".surface.ply");
  if (arguments.output.extension() != ".ply")
    throw UsageError(fmt::format("{}: the output must be a .ply file.", arguments.output.string()));
  Console console(arguments.console);
  Context& context = console.context();
  OutputFolder output(arguments.output.has_parent_path() ? arguments.output.parent_path() : ".");
  const Reconstruction result = naming(
      arguments.mesh, [&] { return reconstruct(read_ma(arguments.mesh), arguments.tolerance_percent, context); });
  std::optional<Deviation> deviation;
  std::optional<bool> cuts_itself;  // nothing if nobody asked
  if (arguments.verify) cuts_itself = find_self_intersection(result.surface).has_value();
  const auto staged = output.staged(arguments.output.filename().string());
  if (arguments.surface.empty()) {
    write_ply(result.surface, staged);
  } else {
    const TriSurface input = read_boundary(arguments.surface, context);
    deviation = Deviation{surface_distance(result.surface, input, arguments.samples, context),
                          surface_distance(input, result.surface, arguments.samples, context)};
    write_ply(result.surface, deviation->to_input.of_vertices, staged);
  }
  context.check();  // after this the result counts, whatever signal comes
  output.commit();
  console.finish();
  console.tell(fmt::format("{}: {}", arguments.output.string(), summary(result, deviation)));
  if (arguments.json)
    fmt::print("{}\n", to_json(arguments, result, deviation, cuts_itself).dump(2, ' ', false, Replace::replace));
  if (cuts_itself.value_or(false)) {
    say(fmt::format("{}: a guarantee failed: the surface intersects itself.", arguments.output.string()));
    return kGuaranteeFailed;
  }
  if (result.topology == result.expected && result.within_tolerance()) return kDone;
  say(fmt::format("{}: a guarantee failed: {}.", arguments.output.string(),
                  result.within_tolerance()
                      ? fmt::format("it has {} components and genus {}, the medial mesh stands for {} and {}",
                                    result.topology.components, result.topology.genus, result.expected.components,
                                    result.expected.genus)
                      : "it is not within the tolerance"));
  return kGuaranteeFailed;
}

}  // namespace

Action add_reconstruct(CLI::App& command) {
  auto arguments = std::make_shared<ReconstructArguments>();
  command.add_option("MESH", arguments->mesh, "medial mesh (.ma)")->required();
  command
      .add_option("-o,--output", arguments->output,
                  "the closed surface (binary PLY); if not given, NAME.surface.ply beside NAME.ma, where pages and "
                  "pictures find it")
      ->type_name("FILE.ply");
  command
      .add_option("--tolerance", arguments->tolerance_percent,
                  "greatest distance to the envelope of the balls, cones and slabs, in % of the diagonal")
      ->type_name("PERCENT")
      ->check(CLI::Range(0.02, 10.0).description("in [0.02, 10]"))
      ->capture_default_str();
  command
      .add_option("--surface", arguments->surface,
                  "surface of the solid, or its tetrahedral mesh: the output is coloured by the distance to it")
      ->type_name("FILE");
  command.add_option("--samples", arguments->samples, "points on either side for the distance to the input")
      ->type_name("N")
      ->check(CLI::Range(1000, 100'000'000).description("at least 1000"))
      ->capture_default_str();
  command.add_flag("--verify", arguments->verify,
                   "also look for self-intersections, which there should never be (slow)");
  command.add_flag("--json", arguments->json, "print the figures as JSON");
  add_console_options(command, arguments->console);
  return [arguments] { return reconstruct_command(*arguments); };
}

}  // namespace matstruct::tool
