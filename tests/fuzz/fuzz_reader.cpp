// Feeds random bytes to one reader, MATSTRUCT_FUZZED. It may throw Error and nothing else, and what it returns keeps
// the promises of io.h.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <type_traits>

#include <matstruct/error.h>

#include "io/parsers.h"

namespace {

using namespace matstruct;

void require(bool condition) {
  if (!condition) std::abort();
}

void check_points(const std::vector<Vec3>& points) {
  for (const Vec3& p : points) require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
}

template <class Simplex>
void check_simplices(const std::vector<Simplex>& simplices, std::size_t vertices) {
  for (const Simplex& s : simplices)
    for (std::size_t i = 0; i < s.size(); ++i) {
      require(s[i] >= 0 && static_cast<std::size_t>(s[i]) < vertices);
      for (std::size_t j = 0; j < i; ++j) require(s[i] != s[j]);
    }
}

// A target has one reader, so it uses one or some of these.
[[maybe_unused]] void check(const TetMesh& mesh) {
  check_points(mesh.vertices);
  check_simplices(mesh.tets, mesh.vertices.size());
  require(!mesh.tets.empty());
}

[[maybe_unused]] void check(const TriSurface& surface) {
  check_points(surface.vertices);
  check_simplices(surface.triangles, surface.vertices.size());
  require(!surface.triangles.empty());
}

[[maybe_unused]] void check(const MedialMesh& mesh) {
  check_points(mesh.centers);
  for (const double r : mesh.radii) require(r >= 0 && std::isfinite(r));
  require(mesh.radii.size() == mesh.centers.size() && mesh.types.size() == mesh.centers.size());
  check_simplices(mesh.edges, mesh.centers.size());
  check_simplices(mesh.faces, mesh.centers.size());
}

[[maybe_unused]] void check(const Model& model) {
  std::visit([](const auto& kind) { check(kind); }, model);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    check(matstruct::MATSTRUCT_FUZZED({reinterpret_cast<const char*>(data), size}, "fuzzed"));
  } catch (const matstruct::Error&) {
    // refused
  }
  return 0;
}
