// matstruct tetrahedralize: a closed surface in, a tetrahedral mesh with the same boundary out.
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include <matstruct/io.h>

#include "commands.h"
#include "console.h"
#include "output_folder.h"
#include "prepare/tetrahedralise.h"

namespace matstruct::tool {

namespace {

struct TetrahedralizeArguments {
  std::filesystem::path surface;
  std::filesystem::path output;
  ConsoleOptions console;
};

int tetrahedralize_command(const TetrahedralizeArguments& arguments) {
  if (arguments.output.extension() != ".msh")
    throw UsageError(fmt::format("{}: the output must be a .msh file.", arguments.output.string()));
  Console console(arguments.console);
  Context& context = console.context();
  OutputFolder output(arguments.output.has_parent_path() ? arguments.output.parent_path() : ".");
  const TetMesh solid =
      naming(arguments.surface, [&] { return tetrahedralise(read_surface(arguments.surface), context); });
  write_msh(solid, output.staged(arguments.output.filename().string()));
  context.check();  // after this the result counts, whatever signal comes
  output.commit();
  console.finish();
  console.tell(fmt::format("{}: {} vertices, {} tetrahedra.", arguments.output.string(), solid.vertices.size(),
                           solid.tets.size()));
  return kDone;
}

}  // namespace

Action add_tetrahedralize(CLI::App& command) {
  auto arguments = std::make_shared<TetrahedralizeArguments>();
  command.add_option("SURFACE", arguments->surface, "closed surface (.stl, .obj, .off, .ply)")->required();
  command.add_option("-o,--output", arguments->output, "the tetrahedral mesh (Gmsh 2.2, binary)")
      ->type_name("FILE.msh")
      ->required();
  add_console_options(command, arguments->console);
  return [arguments] { return tetrahedralize_command(*arguments); };
}

}  // namespace matstruct::tool
