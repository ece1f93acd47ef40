// close_line_gaps(): a straight line of unit edges that ends in a strong one across it; what the gap before the end
// must be like to be closed.
#include "prepare/line_gaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "base/index.h"

namespace matstruct {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kStrong = 45 * kDegree;

struct Line {
  TriSurface surface;
  std::vector<SharpEdge> edges;
  std::vector<char> sharp;

  void add(Index a, Index b, double turn, bool is_sharp) {
    edges.push_back({.vertices = ordered_edge(a, b),
                     .kind = turn > 0 ? EdgeKind::kConvex : EdgeKind::kConcave,
                     .dihedral = std::numbers::pi - turn * kDegree,
                     .triangles = {}});
    sharp.push_back(is_sharp);
  }
};

// `known` sharp edges, a gap of some more, and an edge across the end that turns by `across` degrees.
Line line_with_gap(Index known, Index gap, double across) {
  Line line;
  for (Index k = 0; k <= known + gap; ++k) line.surface.vertices.push_back({static_cast<double>(k), 0, 0});
  for (Index k = 0; k < known + gap; ++k) line.add(k, k + 1, k < known ? 32 : 28, k < known);
  line.surface.vertices.push_back({static_cast<double>(known + gap), 1, 0});
  line.add(known + gap, known + gap + 1, across, true);
  return line;
}

bool closes(Line line) {
  const std::vector<char> before = line.sharp;
  close_line_gaps(line.surface, line.edges, 2, kStrong, line.sharp);
  const bool all = std::count(line.sharp.begin(), line.sharp.end(), 0) == 0;
  EXPECT_TRUE(all || line.sharp == before) << "a gap is closed in part";
  return all;
}

TEST(LineGaps, CloseUpToAStrongEdge) {
  EXPECT_TRUE(closes(line_with_gap(3, 2, 90)));
  EXPECT_TRUE(closes(line_with_gap(3, 2, -90)));
  EXPECT_FALSE(closes(line_with_gap(3, 2, 32))) << "where the limit cuts through noise, nothing is strong";
}

TEST(LineGaps, AreNoLongerThanTwiceTheLine) {
  EXPECT_TRUE(closes(line_with_gap(2, 4, 90)));
  EXPECT_FALSE(closes(line_with_gap(2, 5, 90)));
  EXPECT_FALSE(closes(line_with_gap(1, 1, 90))) << "the line is shorter than asked for";
}

TEST(LineGaps, AreStraightAndOfOneKind) {
  Line bent = line_with_gap(3, 2, 90);
  bent.surface.vertices[4] = {3, 1, 0};
  EXPECT_FALSE(closes(bent));
  Line mixed = line_with_gap(3, 2, 90);
  mixed.edges[3].kind = EdgeKind::kConcave;
  EXPECT_FALSE(closes(mixed));
}

TEST(LineGaps, ThatEndFreelyStay) {
  Line free = line_with_gap(3, 2, 90);
  free.edges.pop_back();
  free.sharp.pop_back();
  EXPECT_FALSE(closes(free));
}

}  // namespace
}  // namespace matstruct
