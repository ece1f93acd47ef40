// matstruct export: a medial mesh for other programs.
#include "export.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <matstruct/io.h>
#include <matstruct/strata.h>

#include "commands.h"
#include "console.h"
#include "output_folder.h"

namespace matstruct::tool {

namespace {

namespace fs = std::filesystem;

struct Format {
  const char* extension;
  void (*write)(const MedialMesh&, const Strata&, const fs::path&);
};
constexpr Format kFormats[] = {{"vtp", write_vtp}, {"ply", write_ply}, {"obj", write_obj}, {"glb", write_glb}};

const Format& format_of(const fs::path& file) {
  for (const Format& format : kFormats)
    if (file.extension() == std::string(".") + format.extension) return format;
  throw UsageError(
      fmt::format("{}: the output must end in one of .{}", file.string(), fmt::join(export_formats(), ", .")));
}

struct ExportArguments {
  fs::path mesh;
  std::vector<fs::path> files;
  ConsoleOptions console;
};

int export_command(const ExportArguments& arguments) {
  for (const fs::path& file : arguments.files) format_of(file);
  Console console(arguments.console);
  const MedialMesh mesh = naming(arguments.mesh, [&] { return read_ma(arguments.mesh); });
  for (const fs::path& file : arguments.files) {
    console.context().check();
    OutputFolder output(file.has_parent_path() ? file.parent_path() : ".");
    write_export(mesh, output.staged(file.filename().string()));
    output.commit();
    console.tell(fmt::format("{}: {} vertices, {} faces.", file.string(), mesh.centers.size(), mesh.faces.size()));
  }
  return kDone;
}

}  // namespace

const std::vector<std::string>& export_formats() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const Format& format : kFormats) names.emplace_back(format.extension);
    return names;
  }();
  return kNames;
}

void write_export(const MedialMesh& mesh, const fs::path& file) {
  format_of(file).write(mesh, trace_strata(mesh), file);
}

Action add_export(CLI::App& command) {
  auto arguments = std::make_shared<ExportArguments>();
  command.add_option("MESH", arguments->mesh, "medial mesh (.ma)")->required();
  command
      .add_option("-o,--output", arguments->files,
                  "one or more files: .vtp (ParaView), .ply, .obj (a group for each stratum), .glb (coloured scene)")
      ->type_name("FILE")
      ->required();
  add_console_options(command, arguments->console);
  return [arguments] { return export_command(*arguments); };
}

}  // namespace matstruct::tool
