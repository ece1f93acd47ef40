// Files of a medial mesh for other programs, chosen by their extension.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <matstruct/types.h>

namespace matstruct::tool {

/// Extensions without dots.
const std::vector<std::string>& export_formats();

/// Throws UsageError if the extension is none of them.
void write_export(const MedialMesh& mesh, const std::filesystem::path& file);

}  // namespace matstruct::tool
