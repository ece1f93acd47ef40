// Results of earlier runs, as `compute` left them in a folder.
#pragma once

#include <filesystem>
#include <vector>

#include "page.h"

namespace matstruct::tool {

/// The .ma files of a results folder, sorted by name. Throws Error if it cannot be read or has none.
std::vector<std::filesystem::path> results_in(const std::filesystem::path& folder);

/// What there is of one result: NAME.ma, and NAME.solid.ply, NAME.report.json and, if wanted, NAME.surface.ply (which
/// may be large) where they exist.
PageContents read_result(const std::filesystem::path& medial_mesh, bool with_reconstruction);

}  // namespace matstruct::tool
