// matstruct view: the interactive pages of the results in a folder.
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include <matstruct/io.h>

#include "commands.h"
#include "console.h"
#include "results.h"

namespace matstruct::tool {

namespace {

struct ViewArguments {
  std::filesystem::path folder;
  ConsoleOptions console;
};

int view_command(const ViewArguments& arguments) {
  Console console(arguments.console);
  const std::string page_template = viewer_template();
  for (const std::filesystem::path& file : results_in(arguments.folder)) {
    console.context().check();
    std::filesystem::path page = file;
    page.replace_extension(".html");
    write_whole(page, viewer_page(page_template, read_result(file, true)));
    console.tell(fmt::format("{}: open it in a browser.", page.string()));
  }
  return kDone;
}

}  // namespace

Action add_view(CLI::App& command) {
  auto arguments = std::make_shared<ViewArguments>();
  command.add_option("DIR", arguments->folder, "folder with results of compute; a page NAME.html is put beside each")
      ->required();
  add_console_options(command, arguments->console);
  return [arguments] { return view_command(*arguments); };
}

}  // namespace matstruct::tool
