// How the commands read solids: common options, and names of results when a file holds several.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <matstruct/solid.h>

namespace matstruct::tool {

/// Adds --deflection, --tet-size, --hole-size, --allow-wrap, --wrap-size and --features.
void add_read_options(CLI::App& command, ReadOptions& options);

/// UsageError if one is out of its range.
void check_usage(const ReadOptions& options);

/// `stem` alone for one solid; for several `stem`-NAME with the names in the file (letters, digits, - and _ stay, the
/// rest becomes _), or their number where there is none; a number is added where names repeat.
std::vector<std::string> result_names(const std::string& stem, const std::vector<Solid>& solids);

}  // namespace matstruct::tool
