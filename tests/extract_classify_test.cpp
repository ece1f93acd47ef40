// Simplices judged by the surface alone: what the cells hold of it decides, whatever the solid between them.

#include "extract/classify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "base/index.h"

namespace matstruct {
namespace {

/// Spheres in a row between two walls, of which each holds a foot on the upper one, and on the lower one but for those
/// in `hidden`. Feet of neighbours lie side by side.
struct Row {
  Spheres spheres;
  DualComplex dual;
  VolumeSamples samples;

  explicit Row(Index n, const std::vector<Index>& hidden = {}) {
    std::array<Index, 2> last{kInvalid, kInvalid};
    std::vector<std::vector<Index>> beside;
    for (Index s = 0; s < n; ++s) {
      spheres.add({.center = {static_cast<double>(s), 0.1 * (s % 2), 0}, .radius = 1});
      dual.vertices.push_back(s);
      for (const Index wall : {0, 1}) {
        if (wall == 1 && std::find(hidden.begin(), hidden.end(), s) != hidden.end()) continue;
        const Vec3 normal{0, 0, wall == 0 ? 1.0 : -1.0}, foot = spheres.seeds[uz(s)].center + normal;
        samples.samples.push_back({.point = {}, .foot = foot, .normal = normal, .patch = wall, .weight = 1});
        beside.emplace_back();
        if (last[uz(wall)] != kInvalid) {
          beside.back().push_back(last[uz(wall)]);
          beside[uz(last[uz(wall)])].push_back(count(beside) - 1);
        }
        last[uz(wall)] = count(beside) - 1;
      }
    }
    samples.start.push_back(0);
    for (const auto& list : beside) {
      samples.list.insert(samples.list.end(), list.begin(), list.end());
      samples.start.push_back(count(samples.list));
    }
    for (Index s = 0; s + 1 < n; ++s) dual.edges.push_back({s, s + 1});
  }

  SimplexClasses classes(const std::vector<Edge>& features = {}) const {
    return classify_by_surface(samples, spheres, dual, features, Context{});
  }
};

TEST(ClassifyBySurface, NeighboursOnBothWallsAreInOneSheet) {
  EXPECT_EQ(Row(4).classes().edge_contacts, (std::vector<std::uint8_t>{2, 2, 2}));
}

TEST(ClassifyBySurface, ASphereHiddenFromAWallLooksLikeACurve) {
  EXPECT_EQ(Row(4, {3}).classes().edge_contacts, (std::vector<std::uint8_t>{2, 2, 1}));
}

TEST(ClassifyBySurface, FacesNeedThreeEdgesOfASheet) {
  for (const bool hidden : {false, true}) {
    Row row(3, hidden ? std::vector<Index>{2} : std::vector<Index>{});
    row.dual.edges = {{0, 1}, {0, 2}, {1, 2}};
    row.dual.triangles = {{0, 1, 2}};
    const SimplexClasses classes = row.classes();
    EXPECT_EQ(classes.edge_contacts[1], 0);
    EXPECT_EQ(classes.face_valid[0], 0);
    EXPECT_EQ(row.classes({{0, 2}}).face_valid[0], !hidden);
  }
}

TEST(ClassifyBySurface, WithoutAPartOfTheSurfaceOnlyFeaturesAreValid) {
  Row row(2);
  row.samples = {.samples = {}, .start = {0}, .list = {}};
  EXPECT_EQ(row.classes().edge_contacts, (std::vector<std::uint8_t>{0}));
  EXPECT_EQ(row.classes({{0, 1}}).edge_contacts, (std::vector<std::uint8_t>{2}));
}

}  // namespace
}  // namespace matstruct
