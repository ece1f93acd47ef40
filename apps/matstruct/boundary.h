// The boundary of a solid in a file.
#pragma once

#include <filesystem>

#include <matstruct/context.h>
#include <matstruct/types.h>

namespace matstruct::tool {

/// A surface as it is, or the boundary of a tetrahedral mesh; input units. Throws Error, with the file's name, if it is
/// refused.
TriSurface read_boundary(const std::filesystem::path& file, Context& context);

}  // namespace matstruct::tool
