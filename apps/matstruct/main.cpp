// The command line tool: parses, runs the chosen command, and turns every way to fail into one line and an exit code.
#include <new>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <matstruct/error.h>
#include <matstruct/version.h>

#include "commands.h"
#include "console.h"

namespace matstruct::tool {

namespace {

constexpr const char* kDescription =
    "Medial meshes of solids, with a proof of their topology.\n"
    "Lengths are in the units of the input. Exit codes: 0 done, 1 input refused or output not\n"
    "writable, 2 bad usage, 3 finished but a guarantee failed (see the report), 130 interrupted.";

int run(const Action& action) {
  try {
    return action();
  } catch (const UsageError& error) {
    say(error.what());
    return kBadUsage;
  } catch (const std::bad_alloc&) {
    say("out of memory; try a smaller --gamma or a coarser input.");
  } catch (const std::exception& error) {
    // A helper process that was interrupted too may end a run with an Error of its own.
    if (!interrupted()) say(error.what());
  }
  if (!interrupted()) return kRefused;
  say("interrupted; nothing was written.");
  return kInterrupted;
}

int usage(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);  // --help and --version
  std::string command = "matstruct";
  for (const CLI::App* chosen : app.get_subcommands()) command += " " + chosen->get_name();
  say(fmt::format("{}. See '{} --help'.", error.what(), command));
  return kBadUsage;
}

int main(int argc, const char* const* argv) {
  CLI::App app(kDescription, "matstruct");
  app.set_version_flag("--version", fmt::format("matstruct {}", kVersion));
  app.require_subcommand(1);
  std::vector<std::pair<CLI::App*, Action>> commands;
  const auto add = [&](const char* name, const char* description, Action (*build)(CLI::App&)) {
    CLI::App* command = app.add_subcommand(name, description);
    commands.emplace_back(command, build(*command));
  };
  add("compute", "Compute the medial mesh of a solid", add_compute);
  add("evaluate", "Measure a medial mesh against the surface of its solid", add_evaluate);
  add("tetrahedralize", "Fill a closed surface with tetrahedra", add_tetrahedralize);
  add("info", "Describe a surface, a tetrahedral mesh or a medial mesh", add_info);
  add("view", "Make interactive pages of results", add_view);
  add("render", "Make pictures of results", add_render);
  add("reconstruct", "Make the surface of the solid that a medial mesh stands for", add_reconstruct);
  add("export", "Write a medial mesh for other programs", add_export);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return usage(app, error);
  }
  catch_interrupts();
  for (const auto& [command, action] : commands)
    if (command->parsed()) return run(action);
  return kBadUsage;
}

}  // namespace

}  // namespace matstruct::tool

int main(int argc, char** argv) {
  return matstruct::tool::main(argc, argv);
}
