#include "boundary.h"

#include <utility>
#include <variant>

#include <matstruct/io.h>
#include <matstruct/options.h>

#include "console.h"
#include "prepare/domain.h"

namespace matstruct::tool {

TriSurface read_boundary(const std::filesystem::path& file, Context& context) {
  return naming(file, [&] {
    auto model = read_model(file);
    if (auto* surface = std::get_if<TriSurface>(&model)) return std::move(*surface);
    Domain domain = prepare_domain(std::get<TetMesh>(model), Options{}, context);
    for (Vec3& vertex : domain.surface.vertices) vertex = domain.frame.to_input(vertex);
    return std::move(domain.surface);
  });
}

}  // namespace matstruct::tool
