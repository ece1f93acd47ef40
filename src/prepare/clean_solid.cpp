#include "prepare/clean_solid.h"

#include <algorithm>
#include <cmath>

#include <matstruct/error.h>

#include "base/index.h"
#include "geometry/exact.h"
#include "prepare/boundary.h"
#include "prepare/messages.h"
#include "prepare/weld.h"

namespace matstruct {

namespace {

void check_elements(const TetMesh& solid) {
  if (solid.tets.empty()) throw Error("the solid has no tetrahedra.");
  for (std::size_t v = 0; v < solid.vertices.size(); ++v) {
    const Vec3& p = solid.vertices[v];
    if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
      throw Error(fmt::format("vertex {} has a coordinate that is not a finite number: {}.", v, place(p)));
  }
  for (std::size_t t = 0; t < solid.tets.size(); ++t)
    for (const Index v : solid.tets[t])
      if (v < 0 || v >= count(solid.vertices))
        throw Error(
            fmt::format("tet {} refers to vertex {}, but the vertices are 0 to {}.", t, v, count(solid.vertices) - 1));
}

// Facets of only one tet, where vertices with equal coordinates are one; all if there are none.
std::vector<Triangle> outer_facets(const TetMesh& solid) {
  const std::vector<Index> first = weld_equal(solid.vertices);
  std::vector<Triangle> facets;
  facets.reserve(4 * solid.tets.size());
  for (const Tetrahedron& tet : solid.tets)
    for (const auto& corners : kTetFacets) {
      Triangle& facet = facets.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) facet[k] = first[uz(tet[corners[k]])];
      std::sort(facet.begin(), facet.end());
    }
  std::sort(facets.begin(), facets.end());
  std::vector<Triangle> outer;
  for (std::size_t n = 0; n < facets.size();) {
    std::size_t end = n;
    while (end < facets.size() && facets[end] == facets[n]) ++end;
    if (end == n + 1) outer.push_back(facets[n]);
    n = end;
  }
  return outer.empty() ? facets : outer;
}

[[noreturn]] void refuse_flat_tet(const TetMesh& solid, std::size_t t) {
  const Tetrahedron& v = solid.tets[t];
  const auto p = [&](std::size_t k) { return place(solid.vertices[uz(v[k])]); };
  throw Error(fmt::format("tet {} (vertices {} {} {} {}) has zero volume: its corners are {}, {}, {} and {}.", t, v[0],
                          v[1], v[2], v[3], p(0), p(1), p(2), p(3)));
}

// Whether the tets stay the way round in a rounded frame.
bool keeps(const Frame& rounded, const TetMesh& solid) {
  const std::vector<Vec3>& input = solid.vertices;
  return std::all_of(solid.tets.begin(), solid.tets.end(), [&](const Tetrahedron& t) {
    const auto p = [&](std::size_t k) { return rounded.to_internal(input[uz(t[k])]); };
    return orientation(p(0), p(1), p(2), p(3)) ==
           orientation(input[uz(t[0])], input[uz(t[1])], input[uz(t[2])], input[uz(t[3])]);
  });
}

// Vertices of the input that are used, welded and mapped; `tets` is made to refer to them.
void compact(const TetMesh& solid, CleanSolid& clean) {
  std::vector<Vec3> mapped(solid.vertices.size());
  std::transform(solid.vertices.begin(), solid.vertices.end(), mapped.begin(),
                 [&](const Vec3& p) { return clean.frame.to_internal(p); });
  const std::vector<Index> first = weld_equal(mapped);
  std::vector<Index> id(mapped.size(), kInvalid);
  for (const Tetrahedron& tet : solid.tets)
    for (const Index v : tet) id[uz(first[uz(v)])] = 0;
  for (Index v = 0; v < count(mapped); ++v) {
    if (id[uz(v)] == kInvalid) continue;
    id[uz(v)] = count(clean.mesh.vertices);
    clean.mesh.vertices.push_back(mapped[uz(v)]);
    clean.input_vertex.push_back(v);
  }
  clean.mesh.tets = solid.tets;
  for (Tetrahedron& tet : clean.mesh.tets)
    for (Index& v : tet) v = id[uz(first[uz(v)])];
}

}  // namespace

std::vector<Frame> frames_of(const TetMesh& solid) {
  const std::vector<Triangle> facets = outer_facets(solid);
  return {fit_frame(solid.vertices, facets, Coordinates::kExact),
          fit_frame(solid.vertices, facets, Coordinates::kRounded)};
}

CleanSolid clean_solid(const TetMesh& solid, Coordinates coordinates, Context& context) {
  check_elements(solid);
  CleanSolid clean;
  const std::vector<Triangle> facets = outer_facets(solid);
  clean.frame = fit_frame(solid.vertices, facets, coordinates);
  if (clean.frame.grid > 0 && !keeps(clean.frame, solid))
    clean.frame = fit_frame(solid.vertices, facets, Coordinates::kExact);
  compact(solid, clean);
  std::size_t flipped = 0;
  for (std::size_t t = 0; t < clean.mesh.tets.size(); ++t) {
    Tetrahedron& tet = clean.mesh.tets[t];
    const auto p = [&](std::size_t k) -> const Vec3& { return clean.mesh.vertices[uz(tet[k])]; };
    const int sign = orientation(p(0), p(1), p(2), p(3));
    if (sign == 0) refuse_flat_tet(solid, t);
    if (sign > 0) continue;
    std::swap(tet[2], tet[3]);
    ++flipped;
  }
  if (flipped > 0)
    context.warnings.push_back(fmt::format("{} of {} tets had negative orientation and {} flipped.", flipped,
                                           solid.tets.size(), flipped == 1 ? "was" : "were"));
  return clean;
}

}  // namespace matstruct
