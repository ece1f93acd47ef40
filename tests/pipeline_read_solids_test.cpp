// read_solids(): CAD files, their units, names and sharp lines, and sharp lines from a file.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include <matstruct/error.h>
#include <matstruct/solid.h>

#include "base/index.h"
#include "prepare/domain.h"
#include "shapes.h"
#include "temp_folder.h"

namespace matstruct {
namespace {

namespace fs = std::filesystem;

const fs::path kAssembly = fs::path(MATSTRUCT_DATA) / "assembly.step";

Domain domain_of(const Solid& solid) {
  Context context;
  return prepare_domain(solid.mesh, {}, context, solid.known_sharp());
}

std::string refusal(const fs::path& file, const ReadOptions& options = {}) {
  Context context;
  try {
    read_solids(file, options, context);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ReadSolids, AnAssemblyIsItsSolidsInTheirPlacesAndUnits) {
  Context context;
  const std::vector<Solid> solids = read_solids(kAssembly, {}, context);
  ASSERT_EQ(solids.size(), 3u);
  EXPECT_EQ(solids[0].name, "plate");
  EXPECT_EQ(solids[1].name, "plate");
  EXPECT_EQ(solids[2].name, "round pin");
  const double plate = 4 * 3 * 0.5 - std::numbers::pi * 0.25 * 0.5, pin = std::numbers::pi * 0.45 * 0.45 * 2;
  for (std::size_t s = 0; s < solids.size(); ++s) {
    EXPECT_NEAR(shapes::volume(solids[s].mesh), s < 2 ? plate : pin, 0.01) << "in cubic inches";
    EXPECT_LE(solids[s].deviation_percent, 0.05);
    EXPECT_GT(solids[s].deviation_percent, 0);
    EXPECT_TRUE(solids[s].repair.steps.empty());
    EXPECT_TRUE(solids[s].warnings.empty());
  }
  const Vec3 apart = solids[1].mesh.vertices[0] - solids[0].mesh.vertices[0];
  EXPECT_NEAR(norm(apart - Vec3{0, 0, 1}), 0, 1e-9) << "the second plate is an inch above";
}

TEST(ReadSolids, SharpLinesAreTheCadEdges) {
  Context context;
  const std::vector<Solid> solids = read_solids(kAssembly, {}, context);
  const Domain plate = domain_of(solids[0]), pin = domain_of(solids[2]);
  EXPECT_EQ(plate.topology, (Betti{1, 1, 0}));
  EXPECT_EQ(plate.features.lines.size(), 14u);  // 12 of the box, two rims; the seam of the hole is smooth
  EXPECT_EQ(plate.features.given_lost, 0);
  EXPECT_EQ(pin.features.lines.size(), 2u);
  EXPECT_EQ(pin.features.corners.size(), 0u);
}

TEST(ReadSolids, DeflectionAndTetSizeAreObeyed) {
  Context context;
  const Solid coarse = std::move(read_solids(kAssembly, {}, context)[2]);
  const Solid fine = std::move(read_solids(kAssembly, {.deflection = 1e-5}, context)[2]);
  EXPECT_GT(fine.mesh.tets.size(), 2 * coarse.mesh.tets.size());
  EXPECT_LE(fine.deviation_percent, 1e-3);
  const Solid filled = std::move(read_solids(kAssembly, {.tet_size = 0.05}, context)[2]);
  EXPECT_GT(filled.mesh.vertices.size(), 2 * coarse.mesh.vertices.size());
}

TEST(ReadSolids, RefusesBrokenCadFiles) {
  const testing::TempFolder folder;
  const auto file = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return folder / name;
  };
  std::ifstream in(kAssembly);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  for (const auto& [path, word] : {std::pair{folder / "none.step", "does not exist"},
                                   {file("empty.step", ""), "empty"},
                                   {file("noise.step", "noise"), "no valid STEP"},
                                   {file("half.step", whole.substr(0, whole.size() / 2)), "CAD file"},
                                   {file("noise.brep", "noise"), "no valid BREP"}}) {
    const std::string text = refusal(path);
    EXPECT_NE(text.find(word), std::string::npos) << path << ": " << text;
  }
}

TEST(ReadSolids, SharpLinesOfAFileReplaceTheFoundOnes) {
  const testing::TempFolder folder;
  // A box of 2 x 1 x 1 cells along its longest edge in two pieces.
  std::ofstream(folder / "box.off") << "OFF\n8 12 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n"
                                       "3 0 2 3\n3 0 3 1\n3 4 5 7\n3 4 7 6\n3 0 1 5\n3 0 5 4\n3 2 6 7\n3 2 7 3\n"
                                       "3 0 4 6\n3 0 6 2\n3 1 3 7\n3 1 7 5\n";
  std::ofstream(folder / "lines.txt") << "# three sides of the lower face\n0 1 3 2\n\n4 5  # one above\n0 3 # flat\n";
  Context context;
  const Solid solid = std::move(read_solids(folder / "box.off", {.features = folder / "lines.txt"}, context)[0]);
  ASSERT_TRUE(solid.sharp);
  EXPECT_EQ(solid.sharp->size(), 5u);
  const Domain domain = domain_of(solid);
  EXPECT_EQ(domain.features.edges.size(), 4u);
  EXPECT_EQ(domain.features.lines.size(), 4u);
  EXPECT_EQ(domain.features.given_lost, 1) << "the diagonal of a face is flat";
  for (const auto& [text, word] :
       {std::pair{"0 8\n", "'8'"}, {"0 1\n2 x\n", "line 2"}, {"0\n", "needs two"}, {"-1 2\n", "'-1'"}}) {
    std::ofstream(folder / "lines.txt") << text;
    const std::string message = refusal(folder / "box.off", {.features = folder / "lines.txt"});
    EXPECT_NE(message.find(word), std::string::npos) << message;
  }
}

TEST(ReadSolids, OptionsHaveRanges) {
  for (const ReadOptions& options :
       {ReadOptions{.deflection = 0}, {.tet_size = -1}, {.hole_size = 2}, {.wrap_size = 0}})
    EXPECT_NE(refusal(kAssembly, options).find("must be between"), std::string::npos);
}

TEST(ModelsReadSolids, StepPartsHaveTheTopologyOfTheirTwins) {
  const fs::path folder = MATSTRUCT_SHARED_DATA;
  if (!fs::exists(folder)) GTEST_SKIP() << "the shared models are not here";
  for (int i = 1; i <= 10; ++i) {
    const std::string name = "part-" + std::to_string(i);
    SCOPED_TRACE(name);
    Context context;
    const Domain cad = domain_of(read_solids(folder / "cad" / (name + ".step"), {}, context).front());
    const Domain twin = domain_of(read_solids(folder / "surface" / (name + ".stl"), {}, context).front());
    EXPECT_EQ(cad.topology, twin.topology);
    EXPECT_GE(cad.features.lines.size(), twin.features.lines.size()) << "facets hide edges that turn by little";
    EXPECT_EQ(cad.features.given_lost, 0);
  }
}

TEST(ModelsReadSolids, EveryCadModelIsRead) {
  const fs::path folder = fs::path(MATSTRUCT_SHARED_DATA) / "cad";
  if (!fs::exists(folder)) GTEST_SKIP() << "the shared models are not here";
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().filename().string());
    Context context;
    for (const Solid& solid : read_solids(entry.path(), {}, context)) {
      EXPECT_EQ(domain_of(solid).topology.b0, 1);
      EXPECT_LE(solid.deviation_percent, 0.05);
    }
  }
}

}  // namespace
}  // namespace matstruct
