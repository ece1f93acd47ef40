// The structure of whole computations: exact on a box, consistent on any solid.

#include <gtest/gtest.h>

#include <matstruct/compute.h>
#include <matstruct/metrics.h>

#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "base/index.h"
#include "convex_oracle.h"
#include "shapes.h"
#include "solids.h"

namespace matstruct {
namespace {

constexpr double kTangent = 1e-6;  // in diagonals

Result computed(const TetMesh& solid, double gamma) {
  Context context;
  return compute(solid, {.gamma = gamma, .samples = 1000, .threads = 2}, context);
}

const Result& box() {
  static const Result result = computed(oracle::tet_mesh_of(oracle::box(2, 3, 5)), 16);
  return result;
}

void expect_contacts_on_surface(const Result& r) {
  const VertexContacts& c = r.contacts;
  ASSERT_EQ(c.start.size(), r.mesh.centers.size() + 1);
  ASSERT_EQ(c.points.size(), uz(c.start.back()));
  ASSERT_EQ(c.triangles.size(), c.points.size());
  ASSERT_EQ(c.patch_of_triangle.size(), r.surface.triangles.size());
  for (Index v = 0; v < count(r.mesh.centers); ++v) {
    ASSERT_GE(c.of(v), 1);
    double least = 0;
    for (Index k = c.start[uz(v)]; k < c.start[uz(v) + 1]; ++k) {
      const Triangle& t = r.surface.triangles.at(uz(c.triangles[uz(k)]));
      const auto at = [&](std::size_t corner) { return r.surface.vertices[uz(t[corner])]; };
      const Vec3& p = c.points[uz(k)];
      EXPECT_LE(closest_on_triangle(p, at(0), at(1), at(2)).distance, 1e-9 * r.report.input.diagonal);
      const double away = distance(p, r.mesh.centers[uz(v)]);
      if (k == c.start[uz(v)]) least = away;
      EXPECT_GE(away, least - 1e-12);
      EXPECT_LE(away - least, 2 * kTangent * r.report.input.diagonal);
    }
  }
}

// Every face is in one sheet, every edge of other than two faces in one curve, ids are in order.
void expect_partition(const Result& r) {
  const Structure& s = r.structure;
  std::vector<Index> sheet(r.mesh.faces.size(), kInvalid);
  for (Index k = 0; k < count(s.sheets); ++k)
    for (const Index f : s.sheets[uz(k)].faces) {
      EXPECT_EQ(sheet[uz(f)], kInvalid);
      sheet[uz(f)] = k;
    }
  EXPECT_EQ(sheet, s.sheet_of_face);
  std::map<Edge, int> faces;
  for (const Edge& e : r.mesh.edges) faces[e] = 0;
  for (const auto& [a, b, c] : r.mesh.faces)
    for (const Edge& e : {Edge{a, b}, Edge{a, c}, Edge{b, c}}) ++faces.at(e);
  std::map<Edge, int> curves;
  const auto walk = [&](const std::vector<CurveStratum>& list, int least, int most) {
    for (const CurveStratum& c : list) {
      EXPECT_EQ(c.closed, c.vertices.front() == c.vertices.back());
      for (std::size_t k = 1; k < c.vertices.size(); ++k) {
        const Edge e{std::min(c.vertices[k - 1], c.vertices[k]), std::max(c.vertices[k - 1], c.vertices[k])};
        EXPECT_GE(faces.at(e), least);
        EXPECT_LE(faces.at(e), most);
        EXPECT_EQ(uz(faces.at(e)), c.sheets.size());
        ++curves[e];
      }
    }
  };
  walk(s.seams, 3, 1000);
  walk(s.boundaries, 1, 1);
  walk(s.curves, 0, 0);
  for (const auto& [edge, n] : faces) EXPECT_EQ(curves[edge], n == 2 ? 0 : 1);
  EXPECT_TRUE(std::is_sorted(s.adjacency.begin(), s.adjacency.end()));
  for (const auto& [lower, higher] : s.adjacency) EXPECT_TRUE(0 <= higher && higher < lower && lower < s.strata());
}

void expect_types_and_facts(const Result& r) {
  EXPECT_EQ(r.mesh.types, types_by_structure(r.mesh, r.structure));
  const Report::Strata& facts = r.report.structure;
  EXPECT_EQ(facts.sheets, count(r.structure.sheets));
  EXPECT_EQ(facts.seams, count(r.structure.seams));
  EXPECT_EQ(facts.junctions, structure_counts(r.mesh).junctions);
  EXPECT_EQ(facts.seam_spheres, std::count(r.mesh.types.begin(), r.mesh.types.end(), SphereType::kSeam));
  EXPECT_EQ(facts.junction_spheres, std::count(r.mesh.types.begin(), r.mesh.types.end(), SphereType::kJunction));
  EXPECT_LE(facts.seam_spheres_tangent, facts.seam_spheres);
  EXPECT_LE(facts.junction_spheres_tangent, facts.junction_spheres);
}

TEST(StructureOfABox, IsExact) {
  const Report::Strata& facts = box().report.structure;
  EXPECT_EQ(facts.sheets, 13);
  EXPECT_EQ(facts.seams, 12);
  EXPECT_EQ(facts.junctions, 4);
  EXPECT_EQ(facts.boundaries, 12);
  EXPECT_EQ(facts.curves, 0);
  EXPECT_EQ(box().structure.corners.size(), 8u);
  double area = 0, exact = 0;
  for (const SheetStratum& s : box().structure.sheets) area += s.area;
  const oracle::ConvexAxis axis = oracle::medial_axis(oracle::box(2, 3, 5));
  for (const oracle::AxisSheet& s : axis.sheets) exact += oracle::area(axis.polygon(s));
  EXPECT_NEAR(area, exact, 1e-6 * exact);
  for (const CurveStratum& b : box().structure.boundaries) EXPECT_TRUE(b.sharp);
}

TEST(StructureOfABox, SeamsAndJunctionsAreTangent) {
  const Result& r = box();
  expect_contacts_on_surface(r);
  for (Index v = 0; v < count(r.mesh.centers); ++v) {
    std::set<Index> patches;
    for (Index k = r.contacts.start[uz(v)]; k < r.contacts.start[uz(v) + 1]; ++k)
      patches.insert(r.contacts.patch_of_triangle[uz(r.contacts.triangles[uz(k)])]);
    EXPECT_EQ(count(patches), r.contacts.of(v));
    switch (r.mesh.types[uz(v)]) {
      case SphereType::kSheet:
        EXPECT_EQ(r.contacts.of(v), 2);
        break;
      case SphereType::kSeam:
        EXPECT_EQ(r.contacts.of(v), 3);
        break;
      case SphereType::kJunction:
        EXPECT_EQ(r.contacts.of(v), 4);
        break;
      case SphereType::kSharpEdge:
      case SphereType::kCorner:
        EXPECT_EQ(r.mesh.radii[uz(v)], 0);
        break;
    }
  }
  const Report::Strata& facts = r.report.structure;
  EXPECT_GT(facts.seam_spheres, 0);
  EXPECT_EQ(facts.seam_spheres_tangent, facts.seam_spheres);
  EXPECT_EQ(facts.junction_spheres, 4);
  EXPECT_EQ(facts.junction_spheres_tangent, 4);
  EXPECT_EQ(facts.stray_seam_spheres, 0);
  EXPECT_LE(facts.worst_tangency, kTangent);
}

TEST(StructureOfABox, WithoutSeamsOrCleaningTheGuaranteesHold) {
  const TetMesh solid = oracle::tet_mesh_of(oracle::box(2, 3, 5));
  Context context;
  const Result loose = compute(solid, {.gamma = 16, .seams = false, .samples = 1000, .threads = 2}, context);
  const Result rough = compute(solid, {.gamma = 16, .clean = false, .samples = 1000, .threads = 2}, context);
  EXPECT_TRUE(loose.report.guarantees_hold);
  EXPECT_TRUE(rough.report.guarantees_hold);
  EXPECT_EQ(box().report.metrics.mser, 0);
  EXPECT_EQ(rough.report.metrics.mser, 0);
  EXPECT_GT(loose.report.metrics.mser, 0.1);
}

TEST(StructureOfATube, IsFoundWithoutCleaning) {
  const TetMesh solid = shapes::tube(1, 0.4, 2, 24);
  Context context;
  Options options{.gamma = 20, .clean = false, .samples = 1000, .threads = 2};
  for (const bool by_volume : {true, false}) {
    options.volume_classification = by_volume;
    const Result result = compute(solid, options, context);
    EXPECT_TRUE(result.report.guarantees_hold) << by_volume;
    EXPECT_EQ(result.report.structure.sheets, 5) << by_volume;
  }
}

TEST(StructureOfAFlatCylinder, IsNotFoundBySurfaceAloneThoughItsTopologyIs) {
  const TetMesh solid = shapes::prism(1, 0.8, 96);
  Context context;
  const Options options{.clean = false, .samples = 1000, .threads = 2};
  Options by_surface = options;
  by_surface.volume_classification = false;
  const Result by_volume = compute(solid, options, context), other = compute(solid, by_surface, context);
  EXPECT_TRUE(by_volume.report.guarantees_hold);
  EXPECT_TRUE(other.report.guarantees_hold);
  EXPECT_EQ(by_volume.report.structure.sheets, 3);
  EXPECT_EQ(by_volume.report.structure.seams, 1);
  EXPECT_GT(other.report.structure.seams, 1) << "a round wall is several contacts to the surface samples of a cell";
  EXPECT_EQ(by_volume.report.metrics.mser, 0);
  EXPECT_GT(other.report.metrics.mser, 0);
}

TEST(StructureOfABox, IsInTheFile) {
  const auto json = nlohmann::json::parse(structure_json(box()));
  EXPECT_EQ(json["schema"], "matstruct-structure");
  EXPECT_EQ(json["schema_version"], 1);
  EXPECT_EQ(json["sheets"].size(), 13u);
  EXPECT_EQ(json["seams"].size(), 12u);
  EXPECT_EQ(json["boundaries"].size(), 12u);
  EXPECT_EQ(json["junctions"].size(), 4u);
  EXPECT_EQ(json["corners"].size(), 8u);
  EXPECT_EQ(json["adjacency"].get<decltype(Structure::adjacency)>(), box().structure.adjacency);
  EXPECT_EQ(json["sheets"][3]["area"].get<double>(), box().structure.sheets[3].area);
  EXPECT_EQ(json["seams"][2]["id"], 15);
  EXPECT_EQ(json["seams"][2]["vertices"].get<std::vector<Index>>(), box().structure.seams[2].vertices);
  EXPECT_EQ(json["contacts"]["start"].get<std::vector<Index>>(), box().contacts.start);
}

TEST(StructureOfABox, IsInTheUnitsOfTheInput) {
  const auto larger = [](const Vec3& p) { return 1024 * p; };
  const Result large = computed(shapes::transformed(oracle::tet_mesh_of(oracle::box(2, 3, 5)), larger), 16);
  ASSERT_EQ(large.structure.sheets.size(), box().structure.sheets.size());
  for (std::size_t k = 0; k < 13; ++k) {
    EXPECT_NEAR(large.structure.sheets[k].area, 1024 * 1024 * box().structure.sheets[k].area, 1e-3);
    EXPECT_NEAR(large.structure.sheets[k].max_radius, 1024 * box().structure.sheets[k].max_radius, 1e-6);
  }
  EXPECT_NEAR(large.structure.seams[0].length, 1024 * box().structure.seams[0].length, 1e-6);
}

TEST(StructureOfShapes, IsConsistent) {
  for (const TetMesh& solid : {shapes::l_profile(), shapes::plate_with_hole()}) {
    const Result r = computed(solid, 12);
    expect_contacts_on_surface(r);
    expect_partition(r);
    expect_types_and_facts(r);
  }
  expect_partition(box());
  expect_types_and_facts(box());
}

}  // namespace
}  // namespace matstruct
