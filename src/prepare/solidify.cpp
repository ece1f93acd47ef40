#include "prepare/solidify.h"

#include "prepare/closed_surface.h"
#include "prepare/tetrahedralise.h"

namespace matstruct {

Solidified solidify(const TriSurface& surface, const ReadOptions& options, Context& context) {
  return {.mesh = tetrahedralise(surface, context, {.tet_size = options.tet_size}), .repair = {}};
}

}  // namespace matstruct
