// Measures of the triangulation itself: triangle quality (Frey & Borouchaki 1999, as used in the paper) and thinness.
#include <algorithm>

#include <matstruct/metrics.h>

#include "base/index.h"
#include "geometry/primitives.h"

namespace matstruct {

namespace {

Index count_tetrahedra(std::vector<Triangle> faces) {
  for (Triangle& f : faces) std::sort(f.begin(), f.end());
  std::sort(faces.begin(), faces.end());
  const auto present = [&](const Triangle& f) { return std::binary_search(faces.begin(), faces.end(), f); };
  Index tetrahedra = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto [i, j, k] = faces[f];
    // The sorted faces after ijk that also begin with ij end in the l > k of the tetrahedra ijkl.
    for (std::size_t g = f + 1; g < faces.size() && faces[g][0] == i && faces[g][1] == j; ++g) {
      const Index l = faces[g][2];
      if (present({i, k, l}) && present({j, k, l})) ++tetrahedra;
    }
  }
  return tetrahedra;
}

}  // namespace

double triangle_quality(const MedialMesh& mesh) {
  if (mesh.faces.empty()) return 0;
  double sum = 0;
  for (const auto& [i, j, k] : mesh.faces)
    sum += triangle_shape(mesh.centers[uz(i)], mesh.centers[uz(j)], mesh.centers[uz(k)]);
  return sum / static_cast<double>(mesh.faces.size());
}

Thinness thinness(const MedialMesh& mesh) {
  return {count_tetrahedra(mesh.faces), betti_numbers(mesh).b2};
}

}  // namespace matstruct
