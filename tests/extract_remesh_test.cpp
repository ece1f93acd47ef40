// Remeshing: exact axes of convex polyhedra stay exact and become well shaped; strata and Betti numbers never change.

#include "extract/remesh.h"

#include <gtest/gtest.h>

#include <matstruct/metrics.h>
#include <matstruct/strata.h>

#include "base/index.h"
#include "base/random.h"
#include "convex_oracle.h"
#include "extract/axis_oracle.h"
#include "extract/guards.h"
#include "extract/sheet_complex.h"
#include "preserved.h"
#include "shapes.h"
#include "thinned.h"

namespace matstruct {
namespace {

// ---- what must not change

using Structure = std::array<std::size_t, 5>;  // sheets, seams, boundaries, medial curves, junctions

Structure structure_of(const MedialMesh& mesh) {
  const Strata s = trace_strata(mesh);
  return {static_cast<std::size_t>(s.sheets), s.seams.size(), s.boundaries.size(), s.curves.size(), s.junctions.size()};
}

MedialMesh mesh_of(const SheetComplex& complex) {
  MedialMesh mesh;
  std::vector<Index> number(uz(complex.vertices()), kInvalid);
  for (Index v = 0; v < complex.vertices(); ++v)
    if (complex.vertex_alive(v)) {
      number[uz(v)] = count(mesh.centers);
      mesh.centers.push_back({});
      mesh.radii.push_back(0);
      mesh.types.push_back(SphereType::kSheet);
    }
  mesh.edges = complex.edges();
  for (Edge& e : mesh.edges)
    for (Index& v : e) v = number[uz(v)];
  mesh.faces = complex.triangles();
  for (Triangle& f : mesh.faces)
    for (Index& v : f) v = number[uz(v)];
  return mesh;
}

MedialMesh with_edges(MedialMesh mesh) {
  for (Triangle& f : mesh.faces) {
    std::sort(f.begin(), f.end());
    mesh.edges.insert(mesh.edges.end(), {Edge{f[0], f[1]}, Edge{f[0], f[2]}, Edge{f[1], f[2]}});
  }
  std::sort(mesh.faces.begin(), mesh.faces.end());
  std::sort(mesh.edges.begin(), mesh.edges.end());
  mesh.edges.erase(std::unique(mesh.edges.begin(), mesh.edges.end()), mesh.edges.end());
  mesh.radii.resize(mesh.centers.size(), 1);
  mesh.types.resize(mesh.centers.size(), SphereType::kSheet);
  return mesh;
}

// An axis that is everywhere: every point is a sphere of radius 1.
AxisOracle anything() {
  AxisOracle axis;
  axis.distance = [](const Vec3&) { return 1.0; };
  axis.on_sheet = [](const Vec3& guess, Index, Index) { return std::optional<Ball>(Ball{guess, 1}); };
  return axis;
}

// ---- exact axes of convex polyhedra

// The axis with the sides of its sheets cut into pieces of about `spacing`, and each sheet a fan around its centroid:
// good along curves, needles inside.
struct CoarseAxis {
  MedialMesh mesh;
  std::vector<Edge> boundary_edges;
};

CoarseAxis coarse_axis(const oracle::ConvexAxis& axis, double spacing) {
  CoarseAxis result;
  MedialMesh& mesh = result.mesh;
  const auto add = [&](const Vec3& center, double radius, SphereType type) {
    mesh.centers.push_back(center);
    mesh.radii.push_back(radius);
    mesh.types.push_back(type);
    return count(mesh.centers) - 1;
  };
  for (std::size_t v = 0; v < axis.vertices.size(); ++v)
    add(axis.vertices[v], axis.radii[v], axis.radii[v] > 0 ? SphereType::kJunction : SphereType::kCorner);
  std::map<Edge, std::vector<Index>> inner;  // from the lower end to the higher
  const auto cut = [&](const Edge& e, SphereType type) {
    const Vec3 &a = axis.vertices[uz(e[0])], &b = axis.vertices[uz(e[1])];
    const int pieces = std::max(1, static_cast<int>(std::lround(distance(a, b) / spacing)));
    Index last = e[0];
    for (int k = 1; k <= pieces; ++k) {
      const double t = static_cast<double>(k) / pieces;
      const Index next =
          k == pieces ? e[1] : add(lerp(a, b, t), (1 - t) * axis.radii[uz(e[0])] + t * axis.radii[uz(e[1])], type);
      if (type == SphereType::kSharpEdge) result.boundary_edges.push_back(ordered_edge(last, next));
      if (k < pieces) inner[e].push_back(next);
      last = next;
    }
  };
  for (const auto& [e, sheets] : axis.seams) cut(e, SphereType::kSeam);
  for (const auto& [e, sheets] : axis.boundaries) cut(e, SphereType::kSharpEdge);
  for (const oracle::AxisSheet& sheet : axis.sheets) {
    std::vector<Index> loop;
    Vec3 mean;
    double radius = 0;
    for (std::size_t i = 0; i < sheet.polygon.size(); ++i) {
      std::vector<Index> between = inner[oracle::side(sheet.polygon, i)];
      if (sheet.polygon[i] > sheet.polygon[(i + 1) % sheet.polygon.size()])
        std::reverse(between.begin(), between.end());
      loop.push_back(sheet.polygon[i]);
      loop.insert(loop.end(), between.begin(), between.end());
      mean += axis.vertices[uz(sheet.polygon[i])] / static_cast<double>(sheet.polygon.size());
      radius += axis.radii[uz(sheet.polygon[i])] / static_cast<double>(sheet.polygon.size());
    }
    const Index middle = add(mean, radius, SphereType::kSheet);
    for (std::size_t i = 0; i < loop.size(); ++i) mesh.faces.push_back({loop[i], loop[(i + 1) % loop.size()], middle});
  }
  std::sort(result.boundary_edges.begin(), result.boundary_edges.end());
  mesh = with_edges(std::move(mesh));
  return result;
}

struct Remeshed {
  CoarseAxis before;    // units of the solid
  RemeshResult result;  // mesh in units of the solid
};

Remeshed remeshed(const oracle::ConvexPolyhedron& solid, double spacing, int threads = 2) {
  Context context;
  context.threads = threads;
  const Domain domain = prepare_domain(oracle::tet_mesh_of(solid), {.convex_angle = 1}, context);
  Remeshed r;
  r.before = coarse_axis(oracle::medial_axis(solid), spacing);
  MedialMesh mesh = r.before.mesh;
  for (Vec3& c : mesh.centers) c = domain.frame.to_internal(c);
  for (double& radius : mesh.radii) radius *= domain.frame.scale;
  r.result = remesh(stratify(mesh, r.before.boundary_edges), shrinking_oracle(domain, 0.01),
                    {spacing * domain.frame.scale}, context);
  for (Vec3& c : r.result.mesh.centers) c = domain.frame.to_input(c);
  for (double& radius : r.result.mesh.radii) radius /= domain.frame.scale;
  return r;
}

void expect_same_strata(const MedialMesh& before, const MedialMesh& after) {
  EXPECT_EQ(structure_of(before), structure_of(after));
  EXPECT_EQ(betti_numbers(before), betti_numbers(after));
}

// Spheres of the axis, and the old curves still there.
void expect_exact(const oracle::ConvexPolyhedron& solid, const Remeshed& r) {
  constexpr double kExact = 1e-9;
  const oracle::ConvexAxis axis = oracle::medial_axis(solid);
  const MedialMesh& mesh = r.result.mesh;
  for (Index v = 0; v < count(mesh.centers); ++v) {
    EXPECT_NEAR(mesh.radii[uz(v)], solid.depth(mesh.centers[uz(v)]), kExact);
    EXPECT_LT(oracle::distance_to_axis(axis, mesh.centers[uz(v)]), kExact);
  }
  for (const auto& [a, b] : r.before.boundary_edges) {
    const Edge now{r.result.vertex_of_input[uz(a)], r.result.vertex_of_input[uz(b)]};
    EXPECT_TRUE(std::binary_search(mesh.edges.begin(), mesh.edges.end(), now));
  }
}

TEST(Remesh, MakesTheAxisOfABoxWellShapedAndKeepsItExact) {
  const oracle::ConvexPolyhedron solid = oracle::box(1, 1.6, 2.3);
  const Remeshed r = remeshed(solid, 0.1);
  EXPECT_LT(triangle_quality(r.before.mesh), 0.4);
  EXPECT_GT(triangle_quality(r.result.mesh), 0.85);
  expect_same_strata(r.before.mesh, r.result.mesh);
  EXPECT_EQ(structure_of(r.result.mesh)[0], 13u);
  expect_exact(solid, r);
  Context context;
  const Hausdorff h = hausdorff_distance(r.result.mesh, oracle::surface_of(solid), 10000, context);
  EXPECT_LT(h.percent(), 1e-6);
}

TEST(Remesh, KeepsTheStrataOfRandomPolyhedra) {
  double quality = 0;
  constexpr int kSolids = 4;
  for (int k = 0; k < kSolids; ++k) {
    SCOPED_TRACE(k);
    const oracle::ConvexPolyhedron solid =
        oracle::random_convex_polyhedron(7 + static_cast<std::uint64_t>(k), 6 + 3 * k);
    const Remeshed r = remeshed(solid, 0.1);
    expect_same_strata(r.before.mesh, r.result.mesh);
    expect_exact(solid, r);
    quality += triangle_quality(r.result.mesh) / kSolids;
    RecordProperty("quality" + std::to_string(k), std::to_string(triangle_quality(r.result.mesh)));
  }
  EXPECT_GT(quality, 0.8);
}

TEST(Remesh, IsTheSameForAnyNumberOfThreads) {
  const oracle::ConvexPolyhedron solid = oracle::random_convex_polyhedron(3, 8);
  const MedialMesh one = remeshed(solid, 0.15, 1).result.mesh, four = remeshed(solid, 0.15, 4).result.mesh;
  EXPECT_EQ(one.centers, four.centers);
  EXPECT_EQ(one.radii, four.radii);
  EXPECT_EQ(one.faces, four.faces);
}

// ---- small meshes by hand

// Sheets of n x n squares, each cut along a diagonal and with its inner vertices moved at random, that all begin at one
// straight line.
MedialMesh book(int pages, int n, std::uint64_t seed) {
  MedialMesh mesh;
  const auto spine = [](int k) { return k; };
  for (int k = 0; k <= n; ++k) mesh.centers.push_back({0, 0, static_cast<double>(k)});
  for (int p = 0; p < pages; ++p) {
    const double angle = 2 * std::numbers::pi * p / pages;
    const int first = count(mesh.centers) - (n + 1);
    const auto at = [&](int i, int k) { return i == 0 ? spine(k) : first + i * (n + 1) + k; };
    for (int i = 1; i <= n; ++i)
      for (int k = 0; k <= n; ++k) {
        KeyedRandom random(seed, 0, static_cast<std::uint64_t>(count(mesh.centers)));
        const bool inner = i < n && k > 0 && k < n;
        const double x = i + (inner ? 0.7 * random.uniform() - 0.35 : 0);
        const double z = k + (inner ? 0.7 * random.uniform() - 0.35 : 0);
        mesh.centers.push_back({x * std::cos(angle), x * std::sin(angle), z});
      }
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) {
        mesh.faces.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
        mesh.faces.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
      }
  }
  return with_edges(std::move(mesh));
}

TEST(Remesh, KeepsTheSpineOfABook) {
  constexpr int kCells = 8;
  const MedialMesh before = book(3, kCells, 5);
  const StratifiedMesh stratified = stratify(before, {});
  EXPECT_EQ(stratified.freedom[0], Freedom::kFixed);
  EXPECT_EQ(stratified.freedom[kCells], Freedom::kFixed);
  EXPECT_EQ(stratified.freedom[kCells / 2], Freedom::kCurve);
  Context context;
  const RemeshResult after = remesh(stratified, anything(), {1.1}, context);
  expect_same_strata(before, after.mesh);
  EXPECT_GT(after.moves, 0);
  const Strata strata = trace_strata(after.mesh);
  EXPECT_EQ(after.origin.size(), after.mesh.centers.size());
  // The sheets of the input are still told apart.
  ASSERT_EQ(after.sheet_of_face.size(), strata.sheet_of_face.size());
  std::set<Edge> pairs;
  for (std::size_t f = 0; f < strata.sheet_of_face.size(); ++f)
    pairs.insert({after.sheet_of_face[f], strata.sheet_of_face[f]});
  EXPECT_EQ(pairs.size(), 3u);
  EXPECT_GT(triangle_quality(after.mesh), triangle_quality(before) + 0.05);
  for (int k = 0; k <= kCells; ++k) {
    const Index v = after.vertex_of_input[static_cast<std::size_t>(k)];
    ASSERT_NE(v, kInvalid);
    EXPECT_EQ(after.mesh.centers[uz(v)], (Vec3{0, 0, static_cast<double>(k)}));
  }
  // Every page is still in its plane: no point is off all of them.
  for (const Vec3& c : after.mesh.centers) {
    double off = 1;
    for (int p = 0; p < 3; ++p) {
      const double angle = 2 * std::numbers::pi * p / 3;
      off = std::min(off, std::abs(std::cos(angle) * c.y - std::sin(angle) * c.x));
    }
    EXPECT_LT(off, 1e-12);
  }
}

TEST(Remesh, EvensOutASeamWhereItsCurveIsKnown) {
  MedialMesh before = book(3, 8, 5);
  for (int k = 1; k < 8; ++k) before.centers[uz(k)].z += 0.3 * (k % 2 == 0 ? 1 : -1);
  AxisOracle axis = anything();
  axis.on_curve = [](const Vec3& guess, const Edge&) { return std::optional<Ball>(Ball{{0, 0, guess.z}, 1}); };
  Context context;
  // The borders of the pages are fixed, the spine is not.
  std::vector<Edge> borders;
  for (const Edge& e : stratify(before, {}).curve_edges)
    if (e[1] > 8) borders.push_back(e);
  const RemeshResult after = remesh(stratify(before, borders), axis, {1.0}, context);
  expect_same_strata(before, after.mesh);
  const Strata strata = trace_strata(after.mesh);
  ASSERT_EQ(strata.seams.size(), 1u);
  const std::vector<Index>& seam = strata.seams[0].vertices;
  double shortest = 8, longest = 0;
  for (std::size_t k = 0; k + 1 < seam.size(); ++k) {
    const double length = distance(after.mesh.centers[uz(seam[k])], after.mesh.centers[uz(seam[k + 1])]);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  EXPECT_LT(longest / shortest, 1.6);  // 4 before
}

TEST(Stratify, FixesVerticesWhereSheetsTouchInAPoint) {
  MedialMesh two_fans;
  two_fans.centers = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 1}, {0, -1, 1}};
  two_fans.faces = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_EQ(stratify(with_edges(two_fans), {}).freedom[0], Freedom::kFixed);

  // Two closed fans, all of whose edges at the common vertex lie inside sheets.
  MedialMesh cones;
  cones.centers.push_back({});
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < 5; ++k) {
      cones.centers.push_back({std::cos(k * 1.25), std::sin(k * 1.25), side == 0 ? 1.0 : -1.0});
      cones.faces.push_back({0, 1 + 5 * side + k, 1 + 5 * side + (k + 1) % 5});
    }
  EXPECT_EQ(stratify(with_edges(cones), {}).freedom[0], Freedom::kFixed);
}

// ---- edits of a complex, without geometry

// Edits at random, as many as are allowed of those that are tried.
int edit_at_random(SheetComplex& complex, int tries, std::uint64_t seed) {
  int done = 0;
  for (int k = 0; k < tries; ++k) {
    KeyedRandom random(seed, 0, static_cast<std::uint64_t>(k));
    const auto pick = [&](Index n) { return static_cast<Index>(random.next() % static_cast<std::uint64_t>(n)); };
    const Index a = pick(complex.vertices());
    const std::vector<Index> around = complex.neighbors(a);
    if (!complex.vertex_alive(a) || around.empty()) continue;
    const Index b = around[uz(pick(count(around)))];
    const Index kind = pick(4);
    ++done;
    if (kind == 0)
      complex.split(a, b);
    else if (kind == 1 && complex.can_flip(a, b))
      complex.flip(a, b);
    else if (kind >= 2 && complex.can_collapse(a, b))
      complex.collapse(a, b);
    else
      --done;
  }
  return done;
}

MedialMesh medial_mesh(const TetMesh& solid) {
  const Options options{.gamma = 12, .threads = 2};
  const Preserved p = preserved(solid, options);
  const GuardRemoval guarded = remove_guards(dual_complex(p.rpd), p.spheres);
  return thinned_by_importance(p, options, guarded.dual, ThinningOptions{}.importance);
}

TEST(SheetComplex, EditsKeepStrataAndBettiNumbers) {
  for (const TetMesh& solid :
       {shapes::plate_with_hole(), shapes::hollow_box(), shapes::l_profile(), shapes::torus(3, 1, 24, 12)}) {
    const MedialMesh before = medial_mesh(solid);
    SheetComplex complex(stratify(before, {}));
    EXPECT_GT(edit_at_random(complex, 20000, 1), 1000);
    expect_same_strata(before, mesh_of(complex));
  }
}

// A tube of rings of three vertices: each ring is a loop that no collapse may close.
MedialMesh narrow_tube(int rings) {
  MedialMesh mesh;
  for (int r = 0; r < rings; ++r)
    for (int k = 0; k < 3; ++k) {
      mesh.centers.push_back({std::cos(2.1 * k), std::sin(2.1 * k), static_cast<double>(r)});
      if (r + 1 == rings) continue;
      const Index a = 3 * r + k, b = 3 * r + (k + 1) % 3;
      mesh.faces.push_back({a, b, a + 3});
      mesh.faces.push_back({b, a + 3, b + 3});
    }
  return with_edges(std::move(mesh));
}

TEST(SheetComplex, TheLinkConditionIsNeeded) {
  const MedialMesh tube = narrow_tube(5);
  const Betti betti = betti_numbers(tube);
  EXPECT_EQ(betti, (Betti{1, 1, 0}));
  const Index a = 6, b = 7;  // on the middle ring
  SheetComplex complex(stratify(tube, {}));
  EXPECT_FALSE(complex.can_collapse(a, b));
  complex.collapse(a, b);  // all the same
  EXPECT_NE(betti_numbers(mesh_of(complex)), betti);

  // Nor may a border of three edges, or the whole tube, get lost.
  SheetComplex kept(stratify(tube, {}));
  EXPECT_FALSE(kept.can_collapse(0, 1));
  edit_at_random(kept, 20000, 2);
  expect_same_strata(tube, mesh_of(kept));
}

TEST(SheetComplex, FlipsOnlyWhereTheOtherDiagonalIsNoEdge) {
  // A tetrahedron without its inside: both diagonals of any two faces are edges.
  MedialMesh sphere;
  sphere.centers = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  sphere.faces = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  const SheetComplex closed(stratify(with_edges(sphere), {}));
  EXPECT_FALSE(closed.can_flip(0, 1));
  EXPECT_FALSE(closed.can_collapse(0, 1));

  MedialMesh square;
  square.centers = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.faces = {{0, 1, 2}, {0, 2, 3}};
  SheetComplex open(stratify(with_edges(square), {}));
  EXPECT_FALSE(open.can_flip(0, 1));  // the border
  ASSERT_TRUE(open.can_flip(0, 2));
  open.flip(0, 2);
  EXPECT_EQ(open.triangles(), (std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}}));
}

}  // namespace
}  // namespace matstruct
