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
#include "extract/thinning.h"
#include "preserved.h"
#include "shapes.h"

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
      if (type == SphereType::kSharpEdge) result.boundary_edges.push_back({std::min(last, next), std::max(last, next)});
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
  constexpr int kSolids = 8;
  for (int k = 0; k < kSolids; ++k) {
    SCOPED_TRACE(k);
    const oracle::ConvexPolyhedron solid = oracle::random_convex_polyhedron(7 + static_cast<std::uint64_t>(k), 6 + k);
    const Remeshed r = remeshed(solid, 0.1);
    expect_same_strata(r.before.mesh, r.result.mesh);
    expect_exact(solid, r);
    quality += triangle_quality(r.result.mesh) / kSolids;
    RecordProperty("quality" + std::to_string(k), std::to_string(triangle_quality(r.result.mesh)));
  }
  EXPECT_GT(quality, 0.8);
}

}  // namespace
}  // namespace matstruct
