#include "reading.h"

#include <algorithm>
#include <cctype>
#include <set>

#include <fmt/format.h>

#include <matstruct/error.h>

#include "commands.h"

namespace matstruct::tool {

void add_read_options(CLI::App& command, ReadOptions& options) {
  command
      .add_option("--deflection", options.deflection,
                  "CAD files: greatest distance of triangles from the surface, in bounding-box diagonals")
      ->type_name("X")
      ->capture_default_str();
  command
      .add_option("--tet-size", options.tet_size,
                  "greatest length of edges inside the solid, in diagonals; 0 = as coarse as the surface allows")
      ->type_name("X")
      ->capture_default_str();
  command
      .add_option("--hole-size", options.hole_size,
                  "holes of a surface up to this diameter, in diagonals, are filled if need be")
      ->type_name("X")
      ->capture_default_str();
  command.add_flag("--allow-wrap", options.allow_wrap,
                   "wrap a surface that cannot be closed otherwise; this rounds its edges");
  command.add_option("--wrap-size", options.wrap_size, "a wrap closes openings narrower than this, in diagonals")
      ->type_name("X")
      ->capture_default_str();
  command
      .add_option(
          "--features", options.features,
          "the sharp lines: a text file with a polyline of vertex ids (from 0) on each line; default: the edges "
          "of a CAD model, else edges found by their angle")
      ->type_name("FILE");
}

void check_usage(const ReadOptions& options) {
  try {
    options.validate();
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
}

std::vector<std::string> result_names(const std::string& stem, const std::vector<Solid>& solids) {
  if (solids.size() == 1) return {stem};
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (std::size_t s = 0; s < solids.size(); ++s) {
    std::string part = solids[s].name.empty() ? std::to_string(s + 1) : solids[s].name;
    std::replace_if(
        part.begin(), part.end(),
        [](unsigned char c) { return !(std::isalnum(c) || c == '-' || c == '_') || c >= 0x80; }, '_');
    std::string name = stem + "-" + part;
    for (int copy = 2; !taken.insert(name).second; ++copy) name = fmt::format("{}-{}-{}", stem, part, copy);
    names.push_back(name);
  }
  return names;
}

}  // namespace matstruct::tool
