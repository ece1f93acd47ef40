// Contact orders from the fixed samples beside the paper's way: sample every restricted power cell by volume, project
// every sample.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include <matstruct/io.h>

#include "cell_reference.h"
#include "shapes.h"

namespace matstruct {
namespace {

constexpr double kChance = 1.5;  // percent: up to 400 spheres, of which some hundredths are in dispute
constexpr int kPerCell = 1000;
constexpr Index kMost = 400;

struct Case {
  std::string file;
  double least_agreement;  // percent
};

class ModelsContactOrder : public ::testing::TestWithParam<Case> {};

// The agreement of two references is what can be asked for, but for chance. bench/run_agreement.py has all models.
TEST_P(ModelsContactOrder, AgreesWithSamplingEveryCell) {
  const auto file = std::filesystem::path(MATSTRUCT_SHARED_DATA) / "tet" / GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared models";
  Context context;
  const Domain domain = prepare_domain(std::get<TetMesh>(read_model(file)), {}, context);
  const reference::Agreement found = reference::agreement_of_samples(domain, {}, kPerCell, kMost, context);
  const double agreement = reference::percent(found.equal, found.compared),
               of_two = reference::percent(found.references_equal, found.compared);
  RecordProperty("agreement", std::to_string(agreement));
  RecordProperty("of_two_references", std::to_string(of_two));
  RecordProperty("disputed", std::to_string(found.disputed));
  RecordProperty("ours_right", std::to_string(found.ours_right));
  RecordProperty("reference_right", std::to_string(found.reference_right));
  EXPECT_GE(agreement, GetParam().least_agreement);
  EXPECT_GE(agreement, of_two - kChance);
}

// The clusters that the references go by are those of the library.
TEST(CellClusters, AreThoseOfCellContacts) {
  Context context;
  const Domain domain = prepare_domain(shapes::l_profile(), {}, context);
  SampledModel model(domain, {}, context);
  model.add_to_poor_cells(model.sheet_spheres(), 100, context);
  link_samples(domain, model.reach, context, model.samples);
  const CellContacts contacts = model.contacts();
  std::vector<Index> all, expected;
  for (Index s = 0; s < count(model.spheres.seeds); ++s)
    all.push_back(s), expected.push_back(contact_order(contacts, s));
  EXPECT_EQ(reference::orders_of_samples(model, all, context), expected);
}

INSTANTIATE_TEST_SUITE_P(Tet, ModelsContactOrder,
                         ::testing::Values(Case{"plate_holes.msh", 98}, Case{"cylinder.msh", 99},
                                           Case{"00000068.msh", 95}, Case{"fandisk_tm.msh", 97},
                                           Case{"fertility.msh", 92}, Case{"bunny.msh", 94}, Case{"xyz_cube.msh", 95}));

}  // namespace
}  // namespace matstruct
