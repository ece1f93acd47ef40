// matstruct render: still pictures of results, without a display.
#include <filesystem>
#include <memory>
#include <regex>
#include <vector>

#include <fmt/format.h>

#include <matstruct/error.h>
#include <matstruct/io.h>

#include "browser.h"
#include "commands.h"
#include "console.h"
#include "output_folder.h"
#include "results.h"

namespace matstruct::tool {

namespace {

namespace fs = std::filesystem;

constexpr int kTile = 320, kColumns = 6, kCaption = 44;

struct RenderArguments {
  std::vector<fs::path> sources;
  fs::path picture;
  std::string view = "iso", layers = "solid,mesh,seams,junctions,boundaries,curves", color = "sheet", theme = "light";
  std::string size = "1280x960";
  bool gallery = false;
  ConsoleOptions console;
};

// A name as text of a page.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  return result;
}

bool shows_reconstruction(const RenderArguments& a) {
  return a.layers.find("surface") != std::string::npos;
}

std::string address(const RenderArguments& a) {
  return fmt::format("#bare=1&view={}&layers={}&color={}&theme={}", a.view, a.layers, a.color, a.theme);
}

// The page of a result as a file in `folder`.
fs::path page_of(const PageContents& contents, const std::string& page_template, const fs::path& folder, int number) {
  const fs::path page = folder / fmt::format("{}.html", number);
  write_whole(page, viewer_page(page_template, contents));
  return page;
}

std::pair<int, int> parse_size(const std::string& text) {
  std::smatch match;
  if (!std::regex_match(text, match, std::regex("([1-9][0-9]{1,3})x([1-9][0-9]{1,3})")))
    throw UsageError(fmt::format("--size is {}; it must be like 1280x960, each number from 10 to 9999", text));
  return {std::stoi(match[1]), std::stoi(match[2])};
}

void render_one(const RenderArguments& arguments, const fs::path& folder, Console& console) {
  const auto [width, height] = parse_size(arguments.size);
  if (arguments.sources.size() > 1) throw UsageError("one picture shows one result; ask for --gallery to show several");
  fs::path mesh = arguments.sources.front();
  if (fs::is_directory(mesh)) {
    const std::vector<fs::path> results = results_in(mesh);
    if (results.size() > 1)
      throw UsageError(fmt::format("{} has {} results; name one of them (NAME.ma) or ask for --gallery", mesh.string(),
                                   results.size()));
    mesh = results.front();
  }
  const fs::path page = page_of(read_result(mesh, shows_reconstruction(arguments)), viewer_template(), folder, 0);
  photograph(find_browser(), page, address(arguments), width, height, arguments.picture);
  console.tell(fmt::format("{}: {} x {} pixels.", arguments.picture.string(), width, height));
}

void render_gallery(const RenderArguments& arguments, const fs::path& folder, Console& console) {
  std::vector<fs::path> results;
  for (const fs::path& source : arguments.sources) {
    const std::vector<fs::path> more = fs::is_directory(source) ? results_in(source) : std::vector{source};
    results.insert(results.end(), more.begin(), more.end());
  }
  const std::string page_template = viewer_template();
  const fs::path browser = find_browser();
  std::string sheet = fmt::format(
      "<!doctype html><meta charset=\"utf-8\"><style>body{{margin:0;background:{};color:{};font:13px/1.3 sans-serif;"
      "display:grid;grid-template-columns:repeat({},{}px)}}figure{{margin:0;height:{}px;overflow:hidden}}"
      "figcaption{{padding:0 8px}}b{{display:block}}img{{display:block}}</style>",
      arguments.theme == "dark" ? "#14181e" : "#f6f7f9", arguments.theme == "dark" ? "#eef2f6" : "#16202c", kColumns,
      kTile, kTile + kCaption);
  for (std::size_t k = 0; k < results.size(); ++k) {
    console.context().check();
    console.context().report("drawing", static_cast<double>(k) / static_cast<double>(results.size()));
    const PageContents contents = read_result(results[k], shows_reconstruction(arguments));
    const int number = static_cast<int>(k);
    const fs::path page = page_of(contents, page_template, folder, number);
    photograph(browser, page, address(arguments), kTile, kTile, folder / fmt::format("{}.png", number));
    fs::remove(page);
    // Results of several folders may have the same name.
    const std::string folder_name = fs::absolute(results[k]).parent_path().filename().string();
    const std::string name = arguments.sources.size() > 1 ? folder_name + "/" + contents.name : contents.name;
    sheet += fmt::format("<figure><img src=\"{}.png\" alt=\"\"><figcaption><b>{}</b>{}</figcaption></figure>", number,
                         escaped(name), escaped(contents.facts));
  }
  const fs::path page = folder / "gallery.html";
  write_whole(page, sheet);
  const int rows = (static_cast<int>(results.size()) + kColumns - 1) / kColumns;
  photograph(browser, page, "", kColumns * kTile, rows * (kTile + kCaption), arguments.picture);
  console.finish();
  console.tell(fmt::format("{}: {} results.", arguments.picture.string(), results.size()));
}

int render_command(const RenderArguments& arguments) {
  Console console(arguments.console);
  OutputFolder folder(fs::absolute(arguments.picture).parent_path());  // holds the pages; nothing of it stays
  const fs::path pages = folder.staged("pages");
  fs::create_directories(pages);
  if (arguments.gallery)
    render_gallery(arguments, pages, console);
  else
    render_one(arguments, pages, console);
  return kDone;
}

}  // namespace

Action add_render(CLI::App& command) {
  auto a = std::make_shared<RenderArguments>();
  command
      .add_option("SOURCE", a->sources,
                  "folder with results of compute, or one medial mesh (.ma) in it; several for --gallery")
      ->required();
  command.add_option("-o,--output", a->picture, "the picture")->type_name("FILE.png")->required();
  command.add_option("--view", a->view, "where to look from")
      ->check(CLI::IsMember({"iso", "front", "back", "left", "right", "top", "bottom"}))
      ->capture_default_str();
  command
      .add_option(
          "--layers", a->layers,
          "what to show, separated by commas: solid, mesh, wire, seams, junctions, boundaries, curves, spheres, "
          "surface")
      ->check(CLI::Validator(
          [](const std::string& text) {
            static const std::regex kList(
                "(solid|mesh|wire|seams|junctions|boundaries|curves|spheres|surface)"
                "(,(solid|mesh|wire|seams|junctions|boundaries|curves|spheres|surface))*");
            return std::regex_match(text, kList) ? std::string() : "not a list of layers: " + text;
          },
          ""))
      ->type_name("LIST")
      ->capture_default_str();
  command.add_option("--color", a->color, "of the sheets")
      ->check(CLI::IsMember({"sheet", "radius"}))
      ->capture_default_str();
  command.add_option("--theme", a->theme, "background")->check(CLI::IsMember({"light", "dark"}))->capture_default_str();
  command.add_option("--size", a->size, "pixels")->type_name("WIDTHxHEIGHT")->capture_default_str();
  command.add_flag("--gallery", a->gallery, "one picture of all results in the folders");
  add_console_options(command, a->console);
  return [a] { return render_command(*a); };
}

}  // namespace matstruct::tool
