// Which spheres of a scan stand for its noise alone.
#include "pipeline/seam_stage.h"

#include <gtest/gtest.h>

#include "base/index.h"

namespace matstruct {
namespace {

constexpr double kHeight = 0.1;

/// Spheres in a row whose cells all meet, with two contacts each, which are not looked at.
struct Row {
  Spheres spheres;
  std::vector<TangentSphere> medial;
  Rpd diagram;

  void add(double x, double radius, SphereType type = SphereType::kSheet) {
    for (Index other = 0; other < count(medial); ++other) {
      diagram.facets.emplace_back();
      diagram.facets.back().spheres = {other, count(medial)};
    }
    spheres.add({{x, 0, 0}, radius, type});
    medial.push_back({{x, 0, 0}, radius, Contacts(2)});
  }
  std::vector<Index> bumps() const { return spheres_of_bumps(spheres, medial, diagram, kHeight); }
};

TEST(SpheresOfBumps, AreHeldByALargerOneThatIsGrownByTheirHeight) {
  Row row;
  row.add(0.5, 0.55);  // sticks out by 0.05
  row.add(0, 1);
  row.add(-0.5, 0.65);  // by 0.15
  row.add(0.5, 0.45, SphereType::kSeam);
  EXPECT_EQ(row.bumps(), (std::vector<Index>{0}));
}

TEST(SpheresOfBumps, DoNotHoldOthers) {
  // Each of a tapering row sticks out of the one before by 0.08, and of the one before that by 0.16.
  Row row;
  for (int k = 0; k < 5; ++k) row.add(0.2 * k, 1 - 0.12 * k);
  EXPECT_EQ(row.bumps(), (std::vector<Index>{1, 3}));
}

TEST(SpheresOfBumps, AreNotThoseOfMedialCurves) {
  Row row;
  row.add(0, 1);
  row.add(0.5, 0.55);
  row.medial[1].contacts.resize(1);
  EXPECT_EQ(row.bumps(), (std::vector<Index>{1})) << "a single contact on one side";
  row.medial[1].spread = 3;  // radians: all around
  EXPECT_TRUE(row.bumps().empty());
}

TEST(SpheresOfBumps, AreThoseWhoseCellsMeet) {
  Row row;
  row.add(0, 1);
  row.add(0.5, 0.55);
  row.diagram.facets.clear();
  EXPECT_TRUE(row.bumps().empty());
}

}  // namespace
}  // namespace matstruct
