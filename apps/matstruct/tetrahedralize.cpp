// matstruct tetrahedralize: a closed surface or a CAD model in, tetrahedral meshes with the same boundary out.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <matstruct/io.h>

#include "commands.h"
#include "console.h"
#include "output_folder.h"
#include "reading.h"

namespace matstruct::tool {

namespace {

struct TetrahedralizeArguments {
  std::filesystem::path surface;
  std::filesystem::path output;
  ReadOptions read{.keep_triangles = true};
  ConsoleOptions console;
};

int tetrahedralize_command(const TetrahedralizeArguments& arguments) {
  if (arguments.output.extension() != ".msh")
    throw UsageError(fmt::format("{}: the output must be a .msh file.", arguments.output.string()));
  check_usage(arguments.read);
  Console console(arguments.console);
  Context& context = console.context();
  OutputFolder output(arguments.output.has_parent_path() ? arguments.output.parent_path() : ".");
  const std::vector<Solid> solids =
      naming(arguments.surface, [&] { return read_solids(arguments.surface, arguments.read, context); });
  const std::vector<std::string> names = result_names(arguments.output.stem().string(), solids);
  std::vector<std::string> lines;
  for (std::size_t s = 0; s < solids.size(); ++s) {
    write_msh(solids[s].mesh, output.staged(names[s] + ".msh"));
    lines.push_back(fmt::format("{}: {} vertices, {} tetrahedra.",
                                (arguments.output.parent_path() / (names[s] + ".msh")).string(),
                                solids[s].mesh.vertices.size(), solids[s].mesh.tets.size()));
    context.warnings.insert(context.warnings.end(), solids[s].warnings.begin(), solids[s].warnings.end());
  }
  context.check();  // after this the result counts, whatever signal comes
  output.commit();
  console.finish();
  for (const std::string& line : lines) console.tell(line);
  return kDone;
}

}  // namespace

Action add_tetrahedralize(CLI::App& command) {
  auto arguments = std::make_shared<TetrahedralizeArguments>();
  command
      .add_option("SURFACE", arguments->surface, "closed surface (.stl, .obj, .off, .ply) or CAD model (.step, .brep)")
      ->required();
  command
      .add_option("-o,--output", arguments->output,
                  "the tetrahedral mesh (Gmsh 2.2, binary); for an assembly one per part")
      ->type_name("FILE.msh")
      ->required();
  add_read_options(command, arguments->read);
  add_console_options(command, arguments->console);
  return [arguments] { return tetrahedralize_command(*arguments); };
}

}  // namespace matstruct::tool
