// The interactive page of a result: the template that viewer/ is bundled into, with the data put in.
#pragma once

#include <optional>
#include <string>

#include <matstruct/types.h>

namespace matstruct::tool {

/// What a page shows; lengths in units of the input.
struct PageContents {
  std::string name;
  std::string facts;  ///< a line below the name
  MedialMesh mesh;
  TriSurface solid;                          ///< boundary of the solid; may be empty
  std::optional<TriSurface> reconstruction;  ///< boundary of the union of the medial primitives
};

/// The page without data: the file named by the environment variable MATSTRUCT_VIEWER, else viewer.html beside the
/// program or in ../share/matstruct. Throws Error if there is none.
std::string viewer_template();

/// One self-contained HTML page.
std::string viewer_page(std::string page_template, const PageContents& contents);

}  // namespace matstruct::tool
