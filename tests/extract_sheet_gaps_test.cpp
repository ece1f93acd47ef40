// Gaps in sheets beside seams: on the exact axis of a box from which faces are taken.
#include "extract/sheet_gaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include <matstruct/metrics.h>

#include "base/index.h"
#include "refined.h"
#include "solid_domain.h"

namespace matstruct {
namespace {

using Keep = std::function<bool(const Triangle&)>;

struct ExactBox {
  ExactBox() : box(1, 2, 3), finders(box.domain, kSmoothAngle) {
    mesh = refined(oracle::medial_mesh_of(oracle::medial_axis(oracle::box(1, 2, 3))), 3);
    for (const Vec3& c : mesh.centers) medial.push_back(box.sphere_at(c));
    spheres.resize(mesh.centers.size());
    std::iota(spheres.begin(), spheres.end(), 0);
  }

  bool in_middle(const Triangle& t) const {
    return std::all_of(t.begin(), t.end(), [&](Index v) { return std::abs(mesh.centers[uz(v)].x) < 1e-9; });
  }
  bool on_side(Index v) const {
    const Vec3& c = mesh.centers[uz(v)];
    return std::abs(c.x) < 1e-9 && std::abs(c.y - 0.5) < 1e-9;
  }
  /// A sphere inside the seam at the side y = 1/2 of the middle sheet.
  Index on_seam() const {
    Index best = kInvalid;
    for (Index v = 0; v < count(mesh.centers); ++v)
      if (on_side(v) && (best == kInvalid || std::abs(mesh.centers[uz(v)].z) < std::abs(mesh.centers[uz(best)].z)))
        best = v;
    return best;
  }
  /// Faces that are not kept go, with edges that are in no other.
  void keep(const Keep& kept) {
    std::erase_if(mesh.faces, [&](const Triangle& t) { return !kept(t); });
    std::set<Edge> edges;
    for (const auto& [a, b, c] : mesh.faces) edges.insert({{a, b}, {a, c}, {b, c}});
    mesh.edges.assign(edges.begin(), edges.end());
  }
  Index fill() { return fill_sheet_gaps(finders, medial, spheres, 0, mesh); }

  Box box;
  FinderPool finders;
  MedialMesh mesh;
  std::vector<TangentSphere> medial;
  std::vector<Index> spheres;
};

bool has(const Triangle& t, Index v) {
  return std::find(t.begin(), t.end(), v) != t.end();
}

TEST(SheetGaps, NoneOnTheExactAxis) {
  ExactBox exact;
  const MedialMesh before = exact.mesh;
  EXPECT_EQ(exact.fill(), 0);
  EXPECT_EQ(exact.mesh.faces, before.faces);
}

TEST(SheetGaps, AFaceOfAStripBesideASeamIsPutBack) {
  ExactBox exact;
  // Of the middle sheet the faces at one of its seams are left.
  exact.keep([&](const Triangle& t) {
    return !exact.in_middle(t) || std::any_of(t.begin(), t.end(), [&](Index v) { return exact.on_side(v); });
  });
  EXPECT_EQ(exact.fill(), 0);
  const MedialMesh strip = exact.mesh;
  const Index v = exact.on_seam();
  ASSERT_NE(v, kInvalid);
  const auto gap = std::find_if(strip.faces.begin(), strip.faces.end(), [&](const Triangle& t) {
    return exact.in_middle(t) && has(t, v) &&
           std::count_if(t.begin(), t.end(), [&](Index w) { return exact.on_side(w); }) == 1;
  });
  ASSERT_NE(gap, strip.faces.end());
  exact.keep([&](const Triangle& t) { return t != *gap; });
  EXPECT_EQ(exact.fill(), 1);
  EXPECT_EQ(exact.mesh.faces, strip.faces);
  EXPECT_EQ(exact.mesh.edges, strip.edges);
}

TEST(SheetGaps, AWhiskerBecomesAFace) {
  ExactBox exact;
  // A corner of the middle sheet's faces, cut off but for one edge to a sphere of its inside.
  const auto corner = std::find_if(exact.mesh.faces.begin(), exact.mesh.faces.end(), [&](const Triangle& t) {
    return exact.in_middle(t) &&
           std::all_of(t.begin(), t.end(), [&](Index v) { return exact.mesh.types[uz(v)] == SphereType::kSheet; });
  });
  ASSERT_NE(corner, exact.mesh.faces.end());
  const Index tip = (*corner)[0], root = (*corner)[1];
  exact.keep([tip](const Triangle& t) { return !has(t, tip); });
  exact.mesh.edges.push_back(ordered_edge(tip, root));
  std::sort(exact.mesh.edges.begin(), exact.mesh.edges.end());
  const Betti topology = betti_numbers(exact.mesh);
  EXPECT_GE(exact.fill(), 1);  // and notches of the hole around the tip
  EXPECT_TRUE(std::any_of(exact.mesh.faces.begin(), exact.mesh.faces.end(),
                          [&](const Triangle& t) { return has(t, tip) && has(t, root); }));
  EXPECT_EQ(betti_numbers(exact.mesh), topology);
}

TEST(SheetGaps, ABareSharpLineGetsItsSheetBack) {
  ExactBox exact;
  const auto on_line = [&](Index v) { return exact.mesh.radii[uz(v)] < 1e-9; };
  // A sphere inside a sharp line, and all faces that have two of the line's spheres there.
  const auto bare = std::find_if(exact.mesh.edges.begin(), exact.mesh.edges.end(), [&](const Edge& e) {
    return on_line(e[0]) && on_line(e[1]) && exact.mesh.types[uz(e[0])] == SphereType::kSharpEdge &&
           exact.mesh.types[uz(e[1])] == SphereType::kSharpEdge;
  });
  ASSERT_NE(bare, exact.mesh.edges.end());
  const auto [v, w] = *bare;
  const auto face = std::find_if(exact.mesh.faces.begin(), exact.mesh.faces.end(),
                                 [v, w](const Triangle& t) { return has(t, v) && has(t, w); });
  ASSERT_NE(face, exact.mesh.faces.end());
  const Index inside = (*face)[0] + (*face)[1] + (*face)[2] - v - w;
  // The edge from w inwards goes, too: what is left is no hole but a notch with the bare edge at its mouth.
  exact.keep([&, v, w](const Triangle& t) { return !(has(t, w) && (has(t, v) || has(t, inside))); });
  exact.mesh.edges.push_back({v, w});
  std::sort(exact.mesh.edges.begin(), exact.mesh.edges.end());
  const Betti topology = betti_numbers(exact.mesh);
  EXPECT_GE(exact.fill(), 1);
  EXPECT_TRUE(std::any_of(exact.mesh.faces.begin(), exact.mesh.faces.end(),
                          [v, w](const Triangle& t) { return has(t, v) && has(t, w); }));
  EXPECT_EQ(betti_numbers(exact.mesh), topology);
}

// Where a sheet hangs on a sharp line in two fans of faces that have only a vertex of the line in common.
TEST(SheetGaps, FansAtASharpLineAreJoined) {
  ExactBox exact;
  const auto on_line = [&](Index v) { return exact.mesh.radii[uz(v)] < 1e-9; };
  Index v = kInvalid;
  const auto face = std::find_if(exact.mesh.faces.begin(), exact.mesh.faces.end(), [&](const Triangle& t) {
    if (std::count_if(t.begin(), t.end(), on_line) != 1) return false;
    v = *std::find_if(t.begin(), t.end(), on_line);
    return exact.mesh.types[uz(v)] == SphereType::kSharpEdge;
  });
  ASSERT_NE(face, exact.mesh.faces.end());
  const Triangle gone = *face;
  const auto others = [&](const Triangle& t) {
    return std::count_if(t.begin(), t.end(), [&](Index w) { return w != v && has(gone, w); });
  };
  exact.keep([&](const Triangle& t) { return others(t) < 2; });
  EXPECT_GE(exact.fill(), 1);
  EXPECT_TRUE(std::binary_search(exact.mesh.faces.begin(), exact.mesh.faces.end(), gone));
}

// Two edges of a line, one of them bare: what stands on the other one is farther away than the line's own next sphere.
TEST(SheetGaps, SharpLinesMakeNoFacesAmongThemselves) {
  ExactBox exact;
  const auto on_line = [&](Index v) { return exact.mesh.radii[uz(v)] < 1e-9; };
  const auto is_middle = [&](Index v) { return exact.mesh.types[uz(v)] == SphereType::kSharpEdge; };
  const auto face = std::find_if(exact.mesh.faces.begin(), exact.mesh.faces.end(), [&](const Triangle& t) {
    return std::count_if(t.begin(), t.end(), on_line) == 2 && std::count_if(t.begin(), t.end(), is_middle) == 2;
  });
  ASSERT_NE(face, exact.mesh.faces.end());
  const Triangle kept = *face;
  // A neighbour on the line of one of its two spheres there.
  Index root = kInvalid, next = kInvalid;
  for (const auto& [a, b] : exact.mesh.edges)
    for (const auto& [v, w] : {std::pair(a, b), std::pair(b, a)})
      if (has(kept, v) && on_line(v) && on_line(w) && !has(kept, w)) root = v, next = w;
  ASSERT_NE(next, kInvalid);
  const Index inside = *std::find_if_not(kept.begin(), kept.end(), on_line);
  exact.mesh.centers[uz(inside)] += (exact.mesh.centers[uz(root)] - exact.mesh.centers[uz(next)]) * 4;
  exact.keep([&](const Triangle& t) { return t == kept; });
  exact.mesh.edges.push_back(ordered_edge(root, next));
  std::sort(exact.mesh.edges.begin(), exact.mesh.edges.end());
  exact.fill();
  EXPECT_TRUE(std::none_of(exact.mesh.faces.begin(), exact.mesh.faces.end(),
                           [&](const Triangle& t) { return std::all_of(t.begin(), t.end(), on_line); }));
}

TEST(SheetGaps, ANotchInAFreeBorderIsFilled) {
  ExactBox exact;
  const auto& c = exact.mesh.centers;
  // Half of the middle sheet, and nothing else, so that its border is free.
  exact.keep([&](const Triangle& t) {
    return exact.in_middle(t) && std::all_of(t.begin(), t.end(), [&](Index v) { return c[uz(v)].z < 1e-9; });
  });
  exact.fill();
  const MedialMesh half = exact.mesh;
  std::map<Index, int> border_edges;
  std::map<Edge, int> degree;
  for (const auto& [a, b, d] : half.faces)
    for (const Edge& e : {Edge{a, b}, Edge{a, d}, Edge{b, d}}) ++degree[e];
  for (const auto& [e, n] : degree)
    if (n == 1) ++border_edges[e[0]], ++border_edges[e[1]];
  // A face at the border whose third vertex is inside.
  const auto gap = std::find_if(half.faces.begin(), half.faces.end(), [&](const Triangle& t) {
    return std::count_if(t.begin(), t.end(), [&](Index v) { return border_edges.contains(v); }) == 2 &&
           (degree[{t[0], t[1]}] == 1 || degree[{t[0], t[2]}] == 1 || degree[{t[1], t[2]}] == 1);
  });
  ASSERT_NE(gap, half.faces.end());
  exact.keep([&](const Triangle& t) { return t != *gap; });
  EXPECT_EQ(exact.fill(), 1);
  EXPECT_EQ(exact.mesh.faces, half.faces);
}

TEST(SheetGaps, EndsOfTwoSheetsAreNotJoined) {
  ExactBox exact;
  const Index v = exact.on_seam();
  const double z = exact.mesh.centers[uz(v)].z;
  // Above the sphere the seam's middle sheet and one of the two others end.
  exact.keep([&](const Triangle& t) {
    const auto& c = exact.mesh.centers;
    const bool left = std::all_of(t.begin(), t.end(), [&](Index w) { return c[uz(w)].x > -1e-9; });
    return !left || !has(t, v) || std::none_of(t.begin(), t.end(), [&](Index w) { return c[uz(w)].z > z + 1e-9; });
  });
  const MedialMesh before = exact.mesh;
  const Betti topology = betti_numbers(before);
  exact.fill();
  EXPECT_EQ(betti_numbers(exact.mesh), topology);
  for (const Triangle& t : exact.mesh.faces)
    if (!std::binary_search(before.faces.begin(), before.faces.end(), t)) {
      // One sheet: in the middle plane, or in a plane at 45 degrees.
      const auto& c = exact.mesh.centers;
      const Vec3 n = normalized(cross(c[uz(t[1])] - c[uz(t[0])], c[uz(t[2])] - c[uz(t[0])]));
      EXPECT_NEAR(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), exact.in_middle(t) ? 1 : std::sqrt(0.5),
                  1e-9);
    }
}

}  // namespace
}  // namespace matstruct
