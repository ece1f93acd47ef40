// What a file holds, told by its name alone.
#pragma once

#include <filesystem>
#include <string>

namespace matstruct {

/// ".stl" of "a.b/Part.STL".
std::string lower_extension(const std::filesystem::path& file);

/// Whether files of this extension hold surfaces, never tetrahedra.
bool is_surface_file(const std::filesystem::path& file);

}  // namespace matstruct
