// The readers behind io.h, each from the bytes of a file in memory: also what the fuzzers call. `name` is only used in
// messages. All throw Error as io.h says, and nothing else, whatever the bytes (up to 4 GiB).
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include <matstruct/types.h>

namespace matstruct {

using Model = std::variant<TetMesh, TriSurface>;

Model parse_msh(std::string_view bytes, const std::string& name);
Model parse_medit(std::string_view bytes, const std::string& name);
Model parse_vtk(std::string_view bytes, const std::string& name);
Model parse_vtu(std::string_view bytes, const std::string& name);
TriSurface parse_stl(std::string_view bytes, const std::string& name);
TriSurface parse_obj(std::string_view bytes, const std::string& name);
TriSurface parse_off(std::string_view bytes, const std::string& name);
TriSurface parse_ply(std::string_view bytes, const std::string& name);
MedialMesh parse_ma(std::string_view bytes, const std::string& name);

}  // namespace matstruct
