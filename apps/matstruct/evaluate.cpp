// matstruct evaluate: the measures of any .ma file, of this program or another.
#include <filesystem>
#include <memory>

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

using Replace = nlohmann::json::error_handler_t;  // file names need not be UTF-8

struct EvaluateArguments {
  std::filesystem::path mesh;
  std::filesystem::path surface;
  Index samples = Options{}.samples;
  bool json = false;
  ConsoleOptions console;
};

struct Evaluation {
  MedialMesh mesh;
  Betti betti;
  Thinness thin;
  double triangle_quality = 0;
  Hausdorff hausdorff;
};

Evaluation evaluate(const EvaluateArguments& arguments, Context& context) {
  Evaluation result;
  result.mesh = naming(arguments.mesh, [&] { return read_ma(arguments.mesh); });
  const TriSurface surface = read_boundary(arguments.surface, context);
  result.betti = betti_numbers(result.mesh);
  result.thin = thinness(result.mesh);
  result.triangle_quality = triangle_quality(result.mesh);
  result.hausdorff = hausdorff_distance(result.mesh, surface, arguments.samples, context);
  return result;
}

double percent(double distance, const Hausdorff& hausdorff) {
  return 100 * distance / hausdorff.diagonal;
}

/// The same names as in the report of a computation.
nlohmann::ordered_json to_json(const EvaluateArguments& arguments, const Evaluation& e) {
  const Hausdorff& h = e.hausdorff;
  return {
      {"file", arguments.mesh.string()},
      {"surface", arguments.surface.string()},
      {"mesh", {{"spheres", e.mesh.centers.size()}, {"edges", e.mesh.edges.size()}, {"faces", e.mesh.faces.size()}}},
      {"topology", {{"betti", {e.betti.b0, e.betti.b1, e.betti.b2}}}},
      {"thin", {{"tetrahedra", e.thin.tetrahedra}, {"pockets", e.thin.pockets}}},
      {"metrics",
       {{"triangle_quality", e.triangle_quality},
        {"hausdorff_percent", h.percent()},
        {"surface_to_envelope_percent", percent(h.surface_to_envelope, h)},
        {"envelope_to_surface_percent", percent(h.envelope_to_surface, h)},
        {"mean_surface_to_envelope_percent", percent(h.mean_surface_to_envelope, h)},
        {"mean_envelope_to_surface_percent", percent(h.mean_envelope_to_surface, h)}}}};
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
  command.add_option("--samples", arguments->samples, "points on either side of the Hausdorff distance; at least 1000")
      ->type_name("N")
      ->check(CLI::Range(1000, 100'000'000).description(""))
      ->capture_default_str();
  command.add_flag("--json", arguments->json, "print JSON");
  add_console_options(command, arguments->console);
  return [arguments] { return evaluate_command(*arguments); };
}

}  // namespace matstruct::tool
