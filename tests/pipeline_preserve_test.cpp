// Preservation of topology and sharp lines, and what compute() promises as a whole: guarantees, determinism, refusals,
// cancellation, independence of units and position.

#include <gtest/gtest.h>

#include <atomic>
#include <set>

#include <matstruct/compute.h>

#include "base/index.h"
#include "base/tolerances.h"
#include "preserve/lines.h"
#include "preserved.h"
#include "shapes.h"
#include "spheres/feature_spheres.h"

namespace matstruct {
namespace {

Options coarse(double gamma = 10) {
  return {.gamma = gamma, .samples = 1000, .threads = 2};
}

Result computed(const TetMesh& solid, const Options& options) {
  Context context;
  return compute(solid, options, context);
}

// ---- edits ----------------------------------------------------------------------------------------------------------

TEST(ApplyEdits, LeavesOutASphereNextToAnotherUnlessTheyAreOnDifferentLines) {
  Spheres spheres;
  const auto on_line = [](double x, Index line) {
    return SphereSeed{{x, 0, 0}, 0, SphereType::kSharpEdge, line, kInvalid, 0.5};
  };
  const AppliedEdits applied = apply_edits(
      spheres, {{on_line(0, 3), on_line(0.01, 3), on_line(0.02, 4), {{0.03, 0, 0}, 1}, {{0.04, 0, 0}, 1}}, {}}, 0.1);
  EXPECT_EQ(applied.inserted.size(), 3u);
  EXPECT_EQ(spheres.seeds[1].line, 4);
  EXPECT_EQ(spheres.seeds[2].line, kInvalid);
}

// ---- lines ----------------------------------------------------------------------------------------------------------

// A box with the spheres of its lines and one sphere inside, which has nothing to say on the lines.
struct BoxOfLines {
  Domain domain;
  Spheres spheres;

  BoxOfLines() : domain(make_domain()) {
    for (const SphereSeed& s : feature_spheres(domain, domain.diagonal / 10)) spheres.add(s);
    spheres.add({domain.frame.to_internal({0.5, 1, 1.5}), 0.5 * domain.frame.scale});
  }
  static Domain make_domain() {
    Context context;
    return prepare_domain(shapes::box({1, 2, 3}, 1, 2, 3), {}, context);
  }
  LineCheck check() const {
    RpdEngine engine(domain);
    engine.compute(weighted_points(spheres), {});
    return check_lines(domain, spheres, engine.diagram());
  }
};

TEST(CheckLines, AcceptsEquallySpacedSpheresOnABox) {
  const BoxOfLines box;
  const LineCheck check = box.check();
  EXPECT_EQ(check.lines, 12);
  EXPECT_EQ(check.preserved, 12);
  EXPECT_TRUE(check.edits.insert.empty());
  // A line of n spheres and two corners makes n + 1 edges; only the sphere inside is on no line.
  EXPECT_EQ(check.feature_edges.size(), box.spheres.seeds.size() - 1 - 8 + 12);
}

TEST(CheckLines, AnswersASphereThatHugsALineAtItsFoot) {
  BoxOfLines box;
  const Vec3 hugging = box.domain.frame.to_internal({0.01, 0.01, 1.2});  // the line along z through the origin
  const double radius = 0.01 * box.domain.frame.scale;
  box.spheres.add({hugging, radius});
  const LineCheck check = box.check();
  EXPECT_EQ(check.lines - check.preserved, 1);
  ASSERT_EQ(check.edits.insert.size(), 1u);
  EXPECT_TRUE(check.edits.remove.empty());
  const SphereSeed& answer = check.edits.insert.front();
  EXPECT_NEAR(distance(answer.center, box.domain.frame.to_internal({0, 0, 1.2})), 0, 1e-12);
  EXPECT_EQ(answer.radius, 0);
  EXPECT_EQ(answer.type, SphereType::kSharpEdge);
  EXPECT_EQ(point_on_line(box.domain, box.domain.features.lines[uz(answer.line)], answer.position), answer.center);

  box.spheres.add(answer);
  EXPECT_EQ(box.check().preserved, 12);
}

TEST(CheckLines, ProposesNoSphereWhereOneOfTheLineStands) {
  BoxOfLines box;
  const auto victim = std::find_if(box.spheres.seeds.begin(), box.spheres.seeds.end(),
                                   [](const SphereSeed& s) { return s.type == SphereType::kSharpEdge; });
  // A ball about a sphere of the line: its foot is that sphere.
  const Vec3 center = victim->center;
  box.spheres.add({center, 0.02 * box.domain.frame.scale});
  const LineCheck check = box.check();
  EXPECT_LT(check.preserved, 12);
  for (const SphereSeed& s : check.edits.insert) EXPECT_GT(distance(s.center, center), 1e-6);
}

TEST(CheckLines, AnswersAMissingSphere) {
  BoxOfLines box;
  // Without the spheres of one line, those of others hold parts of it.
  const auto victim = std::find_if(box.spheres.seeds.begin(), box.spheres.seeds.end(),
                                   [](const SphereSeed& s) { return s.type == SphereType::kSharpEdge; });
  const Index line = victim->line;
  Spheres rest;
  for (const SphereSeed& s : box.spheres.seeds)
    if (s.line != line) rest.add(s);
  rest.add({victim->center * 0.9, 0});  // a little inside
  box.spheres = rest;
  const LineCheck check = box.check();
  EXPECT_LT(check.preserved, 12);
  ASSERT_FALSE(check.edits.insert.empty());
  for (const SphereSeed& s : check.edits.insert) EXPECT_EQ(s.line, line);
}

// ---- the loop -------------------------------------------------------------------------------------------------------

void expect_preserved(const shapes::Shape& shape, double gamma) {
  SCOPED_TRACE(testing::Message() << shape.name << ", gamma " << gamma);
  const Preserved p = preserved(shape.mesh, coarse(gamma));
  EXPECT_EQ(p.result.violations_left, 0);
  EXPECT_EQ(p.result.lines.lines, shape.convex_lines);
  EXPECT_EQ(p.result.lines.preserved, shape.convex_lines);
  EXPECT_NEAR(total_volume(p.rpd), p.domain.volume, tolerance::kTilingVolume * p.domain.volume);
}

TEST(Preserve, EndsWithoutViolationsOnEveryShape) {
  for (const auto& shape : shapes::all()) expect_preserved(shape, 8);
}

TEST(ModelsPreserve, EndsWithoutViolationsWhateverTheDensity) {
  for (const auto& shape : shapes::all())
    for (const double gamma : {4.0, 10.0, 15.0, 20.0}) expect_preserved(shape, gamma);
}

// Regression: at a sharp angle the spheres of two lines chased each other into the corner, each placed at the foot of
// the other.
TEST(Preserve, LinesThatMeetAtASharpAngle) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const PreserveResult result = preserved(shapes::wedge(), {.gamma = 6, .seed = seed, .threads = 2}).result;
    EXPECT_EQ(result.lines.preserved, 9) << "seed " << seed;
  }
}

// Regression: the guards on the concave line of a low step swallowed its convex line.
TEST(Preserve, StepsFarLowerThanTheSpacing) {
  for (const double height : {1e-2, 1e-3, 1e-5, 1e-7}) {
    const TetMesh step =
        shapes::grid({0, 1, 2}, {0, 1}, {0, 1, 1 + height}, [](int i, int, int k) { return i + k < 2; });
    const PreserveResult result = preserved(step, {.gamma = 10, .threads = 2}).result;
    EXPECT_EQ(result.lines.preserved, result.lines.lines) << "height " << height;
    EXPECT_EQ(result.violations_left, 0) << "height " << height;
  }
}

// Regression: across a slit narrower than the clearance that pins keep, both parts of a cell seemed to hold its
// contact; spheres were inserted on the sphere's own side, round after round.
TEST(Preserve, SlitsFarNarrowerThanTheSpacing) {
  for (const double width : {1e-3, 1e-4, 1e-5}) {
    const TetMesh slit = shapes::grid({0, 1, 1 + width, 2}, {0, 1}, {0, 0.5, 1, 1.1},
                                      [](int i, int, int k) { return k == 0 || i == 0 || (i == 2 && k == 1); });
    const PreserveResult result = preserved(slit, {.gamma = 8, .threads = 2}).result;
    EXPECT_EQ(result.lines.preserved, result.lines.lines) << "width " << width;
    EXPECT_EQ(result.violations_left, 0) << "width " << width;
  }
}

TEST(Preserve, SaysWhatIsLeftWhenTheRoundsAreCapped) {
  // Without rounds nothing may be added; seams would keep the lines by themselves here.
  const Result result = computed(
      shapes::l_profile(),
      {.gamma = 6, .shape = ShapeKind::kOrganic, .refinements = 0, .max_rounds = 0, .samples = 1000, .threads = 2});
  EXPECT_EQ(result.report.preservation.rounds, 0);
  EXPECT_EQ(result.report.preservation.inserted, 0);
  EXPECT_LT(result.report.features.lines_preserved, result.report.features.lines);
  EXPECT_FALSE(result.report.features.holds);
  EXPECT_FALSE(result.report.guarantees_hold);
}

// ---- the whole ------------------------------------------------------------------------------------------------------

void expect_guarantees(const Report& report, const shapes::Shape& shape) {
  SCOPED_TRACE(shape.name);
  EXPECT_EQ(report.input.betti, shape.topology);
  EXPECT_EQ(report.topology.betti, shape.topology);
  EXPECT_NEAR(report.input.volume, shape.volume, 1e-9 * shape.volume);
  EXPECT_TRUE(report.topology.equal);
  EXPECT_TRUE(report.thin.holds);
  EXPECT_TRUE(report.tiling.holds);
  EXPECT_TRUE(report.features.holds);
  EXPECT_TRUE(report.guarantees_hold);
}

TEST(ModelsCompute, KeepsItsGuaranteesOnEveryShape) {
  for (const auto& shape : shapes::all()) expect_guarantees(computed(shape.mesh, coarse(20)).report, shape);
}

void expect_same_bytes(const MedialMesh& a, const MedialMesh& b) {
  EXPECT_EQ(a.centers, b.centers);
  EXPECT_EQ(a.radii, b.radii);
  EXPECT_EQ(a.types, b.types);
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_EQ(a.faces, b.faces);
}

void expect_same_for_one_and_two_threads(const TetMesh& solid, double gamma) {
  const Result one = computed(solid, {.gamma = gamma, .samples = 1000, .threads = 1});
  const Result two = computed(solid, {.gamma = gamma, .samples = 1000, .threads = 2});
  ASSERT_FALSE(one.mesh.edges.empty());
  expect_same_bytes(one.mesh, two.mesh);
  EXPECT_EQ(one.report.metrics.hausdorff_percent, two.report.metrics.hausdorff_percent);
}

TEST(Compute, GivesTheSameBytesForOneAndTwoThreads) {
  expect_same_for_one_and_two_threads(shapes::l_profile(), 6);
}

TEST(ModelsCompute, GivesTheSameBytesForOneAndTwoThreads) {
  for (const auto& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    expect_same_for_one_and_two_threads(shape.mesh, 15);
  }
}

TEST(Compute, DependsOnTheSeedOnly) {
  const TetMesh solid = shapes::wedge();
  const Result first = computed(solid, coarse(6)), again = computed(solid, coarse(6));
  expect_same_bytes(first.mesh, again.mesh);
  const Result other = computed(solid, {.gamma = 6, .seed = 2, .samples = 1000, .threads = 2});
  EXPECT_NE(first.mesh.centers, other.mesh.centers);
  EXPECT_TRUE(other.report.guarantees_hold);
}

// A power of two scales every coordinate exactly.
TEST(Compute, ScalesExactlyByPowersOfTwo) {
  const Result plain = computed(shapes::wedge(), coarse(6));
  for (const double scale : {0x1p-20, 0x1p20}) {
    Result scaled = computed(shapes::transformed(shapes::wedge(), [&](Vec3 p) { return p * scale; }), coarse(6));
    for (Vec3& c : scaled.mesh.centers) c = c / scale;
    for (double& r : scaled.mesh.radii) r /= scale;
    expect_same_bytes(plain.mesh, scaled.mesh);
  }
}

TEST(ModelsCompute, KeepsItsGuaranteesAtAnyScaleAndPlace) {
  const std::vector<std::function<Vec3(Vec3)>> maps{[](Vec3 p) { return p * 1e-6; }, [](Vec3 p) { return p * 1e6; },
                                                    [](Vec3 p) {
                                                      return p + Vec3{1e4, -2e4, 3e4};
                                                    }};
  for (const auto& shape : shapes::all()) {
    if (shape.name != "L profile" && shape.name != "hollow box" && shape.name != "torus") continue;
    for (const auto& map : maps) {
      shapes::Shape mapped = shape;
      mapped.mesh = shapes::transformed(shape.mesh, map);
      mapped.volume = shapes::volume(mapped.mesh);
      expect_guarantees(computed(mapped.mesh, coarse()).report, mapped);
    }
  }
}

TEST(Compute, KeepsCavitiesAndComponents) {
  for (const auto& shape : shapes::all())
    if (shape.name == "box in box") expect_guarantees(computed(shape.mesh, coarse(6)).report, shape);
}

TEST(Compute, RefusesOptionsOutOfRange) {
  for (const Options& options :
       {Options{.gamma = 1}, Options{.gamma = std::nan("")}, Options{.convex_angle = 180}, Options{.concave_angle = 0},
        Options{.thinning = 1.5}, Options{.max_rounds = -1}, Options{.samples = 10}, Options{.threads = -1}})
    EXPECT_THROW(computed(shapes::tetrahedron(), options), Error);
}

TEST(Compute, RefusesAnEmptySolid) {
  EXPECT_THROW(computed({}, {}), Error);
}

TEST(Compute, IsCancelledByTheStopFlag) {
  const std::atomic<bool> stop = true;
  Context context;
  context.stop = &stop;
  EXPECT_THROW(compute(shapes::tetrahedron(), coarse(), context), Cancelled);
}

TEST(Compute, IsCancelledByTheProgressCallbackInAnyStage) {
  std::set<std::string> stages;
  Context listening;
  listening.progress = [&](const std::string& stage, double fraction) {
    EXPECT_TRUE(fraction >= 0 && fraction <= 1);
    stages.insert(stage);
    return true;
  };
  const Result result = compute(shapes::tetrahedron(), coarse(4), listening);
  for (const StageCost& stage : result.report.stages) EXPECT_TRUE(stages.contains(stage.name)) << stage.name;
  for (const std::string& victim : stages) {
    Context context;
    context.progress = [&](const std::string& stage, double) { return stage != victim; };
    EXPECT_THROW(compute(shapes::tetrahedron(), coarse(4), context), Cancelled) << victim;
  }
}

}  // namespace
}  // namespace matstruct
