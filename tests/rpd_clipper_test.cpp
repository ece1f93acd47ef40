// Vertices of clipped pieces are interpolated: their error bounds and measures against exact positions.

#include <gtest/gtest.h>

#include "base/index.h"
#include "base/random.h"
#include "base/tolerances.h"
#include "rpd/clipper.h"

namespace matstruct {
namespace {

const std::array<Vec3, 4> kTet{{{0.1, 0.1, 0.1}, {0.6, 0.15, 0.1}, {0.2, 0.55, 0.12}, {0.25, 0.2, 0.5}}};

// The vertex by its spheres and simplex, located in exact arithmetic where rounding would matter.
LocatedVertex exact_place(const Clipper& clipper, const PieceVertex& v, const std::vector<WeightedPoint>& spheres,
                          Index self) {
  PowerVertex name;
  std::array<bool, 4> on_facet{};
  name.spheres[0] = spheres[uz(self)];
  for (const int p : v.planes) {
    if (p < kFirstBisector)
      on_facet[uz(p)] = true;
    else
      name.spheres[uz(++name.k)] = spheres[uz(clipper.sphere_of_plane(p))];
  }
  for (std::size_t k = 0, n = 0; k < 4; ++k)
    if (!on_facet[k]) name.simplex[n++] = kTet[k];
  return locate(name);
}

// Clips the tet to every cell; all vertices are where they claim to be, and the pieces fill the tet.
void expect_accurate(const std::vector<WeightedPoint>& spheres) {
  Clipper clipper;
  double volume = 0;
  for (Index self = 0; self < count(spheres); ++self) {
    std::vector<Bisector> others;
    for (Index s = 0; s < count(spheres); ++s)
      if (s != self) others.push_back(bisector(spheres, self, s));
    if (!clipper.clip(kTet, spheres, self, others)) continue;
    for (const PieceVertex& v : clipper.vertices()) {
      const LocatedVertex exact = exact_place(clipper, v, spheres, self);
      EXPECT_LE(distance(v.point, exact.point), v.error + exact.error);
      EXPECT_LE(v.error, 1.01 * tolerance::kClippedVertex);
    }
    volume += clipper.volume();
  }
  const double whole = dot(cross(kTet[1] - kTet[0], kTet[2] - kTet[0]), kTet[3] - kTet[0]) / 6;
  EXPECT_NEAR(volume, whole, 1e-11 * whole);
}

std::vector<WeightedPoint> random_spheres(std::uint64_t seed, Vec3 extent) {
  std::vector<WeightedPoint> spheres;
  for (std::uint64_t k = 0; k < 60; ++k) {
    KeyedRandom random(seed, 0, k);
    const Vec3 c{extent.x * random.uniform(), extent.y * random.uniform(), extent.z * random.uniform()};
    const double r = 0.1 * random.uniform();
    spheres.push_back({Vec3{0.1, 0.1, 0.1} + c, r * r});
  }
  return spheres;
}

TEST(Clipper, VerticesAreWithinTheirErrorBounds) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) expect_accurate(random_spheres(seed, {0.5, 0.5, 0.4}));
}

// Centres nearly in a plane or on a line: edges of pieces are nearly parallel to the bisectors that cut them.
TEST(Clipper, VerticesOfNearlyParallelBisectors) {
  for (const double flat : {1e-3, 1e-6, 1e-9, 1e-12}) {
    SCOPED_TRACE(flat);
    expect_accurate(random_spheres(6, {0.5, 0.5, flat}));
    expect_accurate(random_spheres(7, {0.5, flat, flat}));
  }
}

// Every vertex of the diagram inside the tet is a tie of eight spheres.
TEST(Clipper, VerticesOfAGrid) {
  std::vector<WeightedPoint> spheres;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) spheres.push_back({{0.1 + i / 8.0, 0.1 + j / 8.0, 0.1 + k / 8.0}, 0.01});
  expect_accurate(spheres);
}

}  // namespace
}  // namespace matstruct
