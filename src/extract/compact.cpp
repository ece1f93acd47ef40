#include "extract/compact.h"

#include "base/index.h"

namespace matstruct {

std::vector<Index> compact(MedialMesh& mesh, const std::vector<std::uint8_t>& kept) {
  std::vector<Index> left, number(mesh.centers.size(), kInvalid);
  MedialMesh result;
  for (Index v = 0; v < count(mesh.centers); ++v) {
    if (!kept[uz(v)]) continue;
    number[uz(v)] = count(left);
    left.push_back(v);
    result.centers.push_back(mesh.centers[uz(v)]);
    result.radii.push_back(mesh.radii[uz(v)]);
    result.types.push_back(mesh.types[uz(v)]);
  }
  for (const auto& [a, b] : mesh.edges) result.edges.push_back({number[uz(a)], number[uz(b)]});
  for (const auto& [a, b, c] : mesh.faces) result.faces.push_back({number[uz(a)], number[uz(b)], number[uz(c)]});
  mesh = std::move(result);
  return left;
}

}  // namespace matstruct
