// matstruct compute: a solid in, its medial mesh and a report out.
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <matstruct/compute.h>
#include <matstruct/io.h>
#include <matstruct/strata.h>

#include "commands.h"
#include "console.h"
#include "export.h"
#include "output_folder.h"
#include "page.h"
#include "reading.h"

namespace matstruct::tool {

namespace {

struct ComputeArguments {
  std::filesystem::path input;
  std::filesystem::path output;
  Options options;
  ReadOptions read;
  bool html = false;
  std::vector<std::string> exports;
  ConsoleOptions console;
};

void write_results(const Result& result, const std::string& name, OutputFolder& output) {
  write_ma(result.mesh, output.staged(name + ".ma"));
  write_ply(result.mesh, trace_strata(result.mesh), output.staged(name + ".ply"));
  write_ply(result.surface, output.staged(name + ".solid.ply"));
  write_whole(output.staged(name + ".structure.json"), structure_json(result));
  write_whole(output.staged(name + ".report.json"), report_json(result));
}

std::string summary(const Result& result) {
  const Report& report = result.report;
  const Betti& betti = report.topology.betti;
  return fmt::format(
      "{} spheres, {} edges, {} faces; {} components, {} tunnels, {} cavities; Hausdorff distance {:.2f} % of the "
      "diagonal; "
      "{:.1f} s.",
      result.mesh.centers.size(), result.mesh.edges.size(), result.mesh.faces.size(), betti.b0, betti.b1, betti.b2,
      report.metrics.hausdorff_percent, report.seconds);
}

/// What does not hold, in words; empty if all does.
std::string failures(const Report& report) {
  std::vector<std::string> list;
  const auto check = [&](bool holds, std::string text) {
    if (!holds) list.push_back(std::move(text));
  };
  const Report::Features& features = report.features;
  check(report.topology.equal, "the topology differs from the solid's");
  check(report.thin.holds, "the mesh is not thin");
  check(report.tiling.holds, "the cells do not tile the solid");
  check(features.holds, fmt::format("{} of {} convex sharp lines are kept", features.lines_preserved, features.lines));
  check(report.preservation.holds, fmt::format("{} violations are left", report.preservation.violations_left));
  return fmt::format("{}", fmt::join(list, ", "));
}

int compute_command(const ComputeArguments& arguments) {
  try {
    arguments.options.validate();
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
  check_usage(arguments.read);
  Console console(arguments.console);
  Context& context = console.context();
  const std::string page_template = arguments.html ? viewer_template() : "";
  OutputFolder output(arguments.output);
  std::vector<Solid> solids =
      naming(arguments.input, [&] { return read_solids(arguments.input, arguments.read, context); });
  const std::vector<std::string> names = result_names(arguments.input.stem().string(), solids);
  std::vector<std::string> lines, warnings, broken;
  for (std::size_t s = 0; s < solids.size(); ++s) {
    console.detail(fmt::format("{}: {} vertices, {} tetrahedra.", names[s], solids[s].mesh.vertices.size(),
                               solids[s].mesh.tets.size()));
    context.warnings.clear();
    Result result = naming(arguments.input, [&] { return compute(solids[s], arguments.options, context); });
    solids[s].mesh = {};
    result.report.input.file = arguments.input.string();
    write_results(result, names[s], output);
    for (const std::string& format : std::set<std::string>(arguments.exports.begin(), arguments.exports.end()))
      if (format != "ply") write_export(result.mesh, output.staged(names[s] + "." + format));
    if (arguments.html)
      write_whole(output.staged(names[s] + ".html"),
                  viewer_page(page_template, {names[s], summary(result), result.mesh, result.surface, std::nullopt}));
    const std::string medial_mesh = (arguments.output / (names[s] + ".ma")).string();
    lines.push_back(fmt::format("{}: {}", medial_mesh, summary(result)));
    for (const std::string& warning : context.warnings)
      warnings.push_back(solids.size() == 1 ? warning : names[s] + ": " + warning);
    if (!result.report.guarantees_hold)
      broken.push_back(fmt::format("{}: a guarantee failed: {}.", medial_mesh, failures(result.report)));
  }
  context.check();  // after this the results count, whatever signal comes
  output.commit();
  context.warnings = warnings;
  console.finish();
  for (const std::string& line : lines) console.tell(line);
  for (const std::string& line : broken) say(line);
  return broken.empty() ? kDone : kGuaranteeFailed;
}

void add_method_options(CLI::App& command, Options& options) {
  command
      .add_option("--gamma", options.gamma,
                  "sampling density: points on the surface lie a bounding-box diagonal / gamma apart; in [2, 1000]")
      ->type_name("X")
      ->capture_default_str();
  command
      .add_option("--convex-angle", options.convex_angle,
                  "an edge is sharp and convex if its dihedral angle is below 180 - this; in (0, 180)")
      ->type_name("DEGREES")
      ->capture_default_str();
  command
      .add_option("--concave-angle", options.concave_angle,
                  "an edge is sharp and concave if its dihedral angle is above 180 + this; in (0, 180)")
      ->type_name("DEGREES")
      ->capture_default_str();
  command.add_option("--thinning", options.thinning, "faces of less importance than this are thinned away; in [0, 1]")
      ->type_name("X")
      ->capture_default_str();
  command.add_flag_callback(
      "--organic", [&options] { options.shape = ShapeKind::kOrganic; },
      "take the solid as a smooth, noisy shape: bumps make no seams (default: without sharp lines)");
  command.add_flag_callback(
      "--mechanical", [&options] { options.shape = ShapeKind::kMechanical; },
      "take the solid as a mechanical part, with seams (default: with sharp lines)");
  command
      .add_flag("--volume-classification,!--no-volume-classification", options.volume_classification,
                "tell sheets apart by the solid between spheres, not by its surface alone")
      ->default_str("true");
  command.add_flag("--seams,!--no-seams", options.seams, "put spheres on seams and junctions and keep them")
      ->default_str("true");
  command.add_flag("--clean,!--no-clean", options.clean, "drop strata that are there by chance, fill gaps in sheets")
      ->default_str("true");
  command.add_flag("--remesh,!--no-remesh", options.remesh, "even out the triangles of the medial mesh")
      ->default_str("true");
  command
      .add_option("--samples", options.samples,
                  "points on either side for the Hausdorff distance in the report; at least 1000")
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option(
          "--deviation", options.deviation,
          "spheres are added where the mesh cuts across a bend of the axis by more, bumps of parts below half of it "
          "make no sheets; in % of the diagonal")
      ->type_name("PERCENT")
      ->check(CLI::Range(1e-3, 100.0).description("in [0.001, 100]"))
      ->capture_default_str();
  command.add_option("--refinements", options.refinements, "cap on the rounds of that")
      ->type_name("N")
      ->check(CLI::Range(0, 100).description("in [0, 100]"))
      ->capture_default_str();
  command
      .add_option("--particle-rounds", options.particle_rounds,
                  "cap on the rounds in which all spheres spread as particles; 0: none")
      ->type_name("N")
      ->check(CLI::Range(0, 1000).description("in [0, 1000]"))
      ->capture_default_str();
  command
      .add_option("--particle-change", options.particle_change,
                  "these rounds end when the number of spheres at seams and junctions changes by less than this share")
      ->type_name("X")
      ->check(CLI::Range(0.0, 1.0).description("in [0, 1]"))
      ->capture_default_str();
  command
      .add_option("--particle-gradient", options.particle_gradient,
                  "a round ends when the mean gradient of the particles is below this")
      ->type_name("X")
      ->check(CLI::Range(1e-6, 1.0).description("in [1e-6, 1]"))
      ->capture_default_str();
  command
      .add_flag("--gradient-projection,!--no-gradient-projection", options.gradient_projection,
                "particles move only as their contacts allow, not anywhere and back")
      ->default_str("true");
  command.add_option("--max-rounds", options.max_rounds, "cap on the rounds of topology and feature preservation")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--seed", options.seed, "of all random choices")->type_name("N")->capture_default_str();
}

}  // namespace

Action add_compute(CLI::App& command) {
  auto arguments = std::make_shared<ComputeArguments>();
  command
      .add_option("INPUT", arguments->input,
                  "tetrahedral mesh (.msh, .mesh, .vtk, .vtu), closed surface (.stl, .obj, .off, .ply) or CAD model "
                  "(.step, .brep)")
      ->required();
  command
      .add_option("-o,--output", arguments->output,
                  "folder for NAME.ma, NAME.ply, NAME.solid.ply, NAME.structure.json and NAME.report.json, for an "
                  "assembly of each part; made if missing")
      ->type_name("DIR")
      ->required();
  command.add_flag("--html", arguments->html, "also make the interactive page NAME.html");
  command.add_option("--export", arguments->exports, "also write NAME.vtp, .obj or .glb; separated by commas")
      ->type_name("FORMATS")
      ->delimiter(',')
      ->check(CLI::IsMember(export_formats()));
  add_method_options(command, arguments->options);
  add_read_options(command, arguments->read);
  command.add_flag(
      "--keep-triangles", arguments->read.keep_triangles,
      "keep the file's triangles and tets, also where the surface is flat; the result depends on them then");
  add_console_options(command, arguments->console);
  return [arguments] {
    arguments->options.threads = arguments->console.threads;
    return compute_command(*arguments);
  };
}

}  // namespace matstruct::tool
