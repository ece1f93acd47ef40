// Which sharp edges are noise: drawings of sharp edges in the plane, and real scans and CAD models.
#include "prepare/noise_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <string>

#include <matstruct/io.h>

#include "base/index.h"

namespace matstruct {
namespace {

// Sharp edges that turn by the given degrees, for a diagonal of 1: by default lines with a free end are noise below
// 1 / 40, weak ones (below 45 degrees) below 1 / 10.
class Drawing {
 public:
  // A big square that turns by 90 degrees, so that the rest is not much of all.
  Drawing() { line({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}, {-2, -2, 0}}, 90); }

  Drawing& line(const std::vector<Vec3>& points, double degrees, EdgeKind kind = EdgeKind::kConvex) {
    const double turn = degrees * std::numbers::pi / 180;
    for (std::size_t k = 1; k < points.size(); ++k) {
      const Index a = vertex(points[k - 1]), b = vertex(points[k]);
      edges.push_back({.vertices = ordered_edge(a, b),
                       .kind = kind,
                       .dihedral = std::numbers::pi + (kind == EdgeKind::kConcave ? turn : -turn)});
    }
    return *this;
  }

  // Edges without the square's that are not noise.
  std::ptrdiff_t kept(const Options& options = {}) const {
    const NoiseLines found = find_noise_lines(surface, edges, 1, options);
    EXPECT_EQ(std::count(found.noise.begin(), found.noise.begin() + 4, 0), 4) << "the square is no noise";
    EXPECT_FALSE(found.mostly);
    return std::count(found.noise.begin() + 4, found.noise.end(), 0);
  }

  TriSurface surface;
  std::vector<SharpEdge> edges;

 private:
  Index vertex(const Vec3& p) {
    const auto place = std::find(surface.vertices.begin(), surface.vertices.end(), p);
    const auto id = static_cast<Index>(place - surface.vertices.begin());
    if (place == surface.vertices.end()) surface.vertices.push_back(p);
    return id;
  }
};

std::vector<Vec3> straight(const Vec3& from, const Vec3& step, int edges) {
  std::vector<Vec3> points;
  for (int k = 0; k <= edges; ++k) points.push_back(from + step * k);
  return points;
}

std::vector<Vec3> circle(double r, int n) {
  std::vector<Vec3> points;
  for (int k = 0; k < n; ++k)
    points.push_back({r * std::cos(2 * std::numbers::pi * k / n), r * std::sin(2 * std::numbers::pi * k / n), 0});
  points.push_back(points.front());
  return points;
}

TEST(NoiseLines, FreeChainsMustBeLongAndIfWeakLonger) {
  const auto chain = [](double length, double degrees, EdgeKind kind) {
    return Drawing().line(straight({0, 0, 0}, {length / 3, 0, 0}, 3), degrees, kind);
  };
  for (const EdgeKind kind : {EdgeKind::kConvex, EdgeKind::kConcave}) {
    EXPECT_EQ(chain(0.024, 90, kind).kept(), 0);
    EXPECT_EQ(chain(0.026, 90, kind).kept(), 3);
    EXPECT_EQ(chain(0.026, 90, kind).kept({.gamma = 30}), 0);
    EXPECT_EQ(chain(0.09, 46, kind).kept(), 3);
    EXPECT_EQ(chain(0.09, 44, kind).kept(), 0);
    EXPECT_EQ(chain(0.11, 44, kind).kept(), 3);
  }
  EXPECT_EQ(chain(0.09, 44, EdgeKind::kConvex).kept({.convex_angle = 25}), 3);
  EXPECT_EQ(chain(0.09, 44, EdgeKind::kConcave).kept({.convex_angle = 25}), 0);
}

TEST(NoiseLines, TheStrengthOfAChainIsItsAverageByLength) {
  const auto fading = [](double strong_part) {
    return Drawing().line({{0, 0, 0}, {strong_part, 0, 0}}, 60).line({{strong_part, 0, 0}, {0.08, 0, 0}}, 31).kept();
  };
  EXPECT_EQ(fading(0.04), 2);  // 45.5 degrees
  EXPECT_EQ(fading(0.03), 0);  // 41.9 degrees
}

TEST(NoiseLines, AChainRunsThroughChangesOfKindAndTurns) {
  const Vec3 a{0, 0, 0}, b{0.02, 0, 0}, c{0.02, 0.02, 0};
  EXPECT_EQ(Drawing().line({a, b}, 90).line({b, c}, 90, EdgeKind::kConcave).kept(), 2);
  EXPECT_EQ(Drawing().line({a, b}, 90).kept(), 0);
}

TEST(NoiseLines, ShortLinesBetweenOthersStay) {
  // A weak rung of a ladder, and a small strong hole.
  EXPECT_EQ(Drawing().line({{-2, -2, 0}, {-1.999, -1.999, 0}, {2, -2, 0}}, 31).kept(), 2);
  EXPECT_EQ(Drawing().line(circle(0.002, 8), 90).kept(), 8);
}

TEST(NoiseLines, TwigsGoAndTheirLineStays) {
  Drawing drawing;
  drawing.line(straight({-2, -2, 0}, {0.4, 0.4, 0}, 10), 90);
  for (int k = 1; k < 10; ++k) drawing.line(straight({-2 + 0.4 * k, -2 + 0.4 * k, 0}, {0, 0, 0.005}, 2), 90);
  EXPECT_EQ(drawing.kept(), 10);
}

TEST(NoiseLines, RemovingAChainFreesAnother) {
  // A fork at the end of a fork: its two tips go first, then its stem has a free end and goes too.
  Drawing drawing;
  const Vec3 root{-2, -2, 0}, knee{-1.98, -2, 0.01};
  drawing.line({root, knee}, 35).line({knee, {-1.96, -2, 0.01}}, 90).line({knee, {-1.98, -2, 0.02}}, 90);
  EXPECT_EQ(drawing.kept(), 0);
}

TEST(NoiseLines, WeakClosedLinesMustBeLong) {
  EXPECT_EQ(Drawing().line(circle(0.015, 12), 40).kept(), 0);
  EXPECT_EQ(Drawing().line(circle(0.017, 12), 40).kept(), 12);
  EXPECT_EQ(Drawing().line(circle(0.015, 12), 50).kept(), 12);
}

// Random weak edges beside a strong square: with many, the surface is a scan, and a long weak line is noise as well.
Drawing scan(int scratches, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-1, 1), step(-0.05, 0.05), degrees(30, 50);
  Drawing drawing;
  drawing.line(straight({-1, 0, 1}, {0.05, 0, 0}, 10), 40);
  for (int k = 0; k < scratches; ++k) {
    const Vec3 p{place(random), place(random), 0};
    drawing.line({p, p + Vec3{step(random), step(random), step(random)}}, degrees(random));
  }
  return drawing;
}

TEST(NoiseLines, InAScanOnlyStrongLinesAreLeft) {
  EXPECT_GE(scan(20, 1).kept(), 10);
  const Drawing drawing = scan(400, 1);
  const NoiseLines found = find_noise_lines(drawing.surface, drawing.edges, 1, {});
  EXPECT_TRUE(found.mostly);
  for (std::size_t e = 0; e < found.noise.size(); ++e) EXPECT_EQ(found.noise[e] != 0, e >= 4);
}

TEST(NoiseLines, OrderDoesNotMatter) {
  for (const int scratches : {20, 400}) {
    const Drawing drawing = scan(scratches, 2);
    const NoiseLines expected = find_noise_lines(drawing.surface, drawing.edges, 1, {});
    std::mt19937 random(3);
    std::vector<Index> id(drawing.surface.vertices.size()), order(drawing.edges.size());
    std::iota(id.begin(), id.end(), 0);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(id.begin(), id.end(), random);
    std::shuffle(order.begin(), order.end(), random);
    TriSurface surface = drawing.surface;
    for (std::size_t v = 0; v < id.size(); ++v) surface.vertices[uz(id[v])] = drawing.surface.vertices[v];
    std::vector<SharpEdge> edges;
    for (const Index e : order) {
      SharpEdge edge = drawing.edges[uz(e)];
      for (Index& v : edge.vertices) v = id[uz(v)];
      std::sort(edge.vertices.begin(), edge.vertices.end());
      edges.push_back(edge);
    }
    const NoiseLines found = find_noise_lines(surface, edges, 1, {});
    EXPECT_EQ(found.mostly, expected.mostly);
    for (std::size_t e = 0; e < edges.size(); ++e) EXPECT_EQ(found.noise[e], expected.noise[uz(order[e])]);
  }
}

class ModelsNoiseLines : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder_)) GTEST_SKIP() << "the shared models are not here";
  }
  Domain prepare(const std::string& name) {
    warnings_ = {};
    Context context;
    Domain domain = prepare_domain(read_tet_mesh(folder_ / (name + ".msh")), {}, context);
    warnings_ = context.warnings;
    return domain;
  }
  std::filesystem::path folder_ = std::filesystem::path(MATSTRUCT_SHARED_DATA) / "tet";
  std::vector<std::string> warnings_;
};

TEST_F(ModelsNoiseLines, ScansHaveNoFeatures) {
  for (const char* name : {"3holes", "bear", "bunny", "elephant_igl", "fertility", "quadknot"}) {
    SCOPED_TRACE(name);
    const Features features = prepare(name).features;
    EXPECT_TRUE(features.lines.empty());
    EXPECT_TRUE(features.corners.empty());
    EXPECT_GT(features.noise_edges, 0);
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("no sharp features but noise"), std::string::npos) << warnings_[0];
  }
}

TEST_F(ModelsNoiseLines, CadModelsKeepTheirs) {
  const std::map<std::string, int> lines = {{"00000068", 10},      {"00000329", 18}, {"00000802", 47}, {"69058", 12},
                                            {"angle_block", 40},   {"cylinder", 2},  {"tube", 4},      {"torus", 0},
                                            {"origin_inside", 24}, {"xyz_cube", 198}};
  for (const auto& [name, number] : lines) {
    SCOPED_TRACE(name);
    const Features features = prepare(name).features;
    EXPECT_EQ(count(features.lines), number);
    EXPECT_EQ(features.noise_edges, 0);
  }
  // These have short free edges where a fillet is coarse.
  for (const char* name : {"00000125", "fandisk_tm", "featuretype", "octagonal_pocket", "plate_holes", "socket"}) {
    SCOPED_TRACE(name);
    const Features features = prepare(name).features;
    EXPECT_FALSE(features.mostly_noise);
    EXPECT_LT(features.noise_edges, 100);
    EXPECT_GT(count(features.edges), 250);
  }
}

}  // namespace
}  // namespace matstruct
