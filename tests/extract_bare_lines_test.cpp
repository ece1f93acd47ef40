// Sharp lines without a sheet, and seams without one of theirs: the exact axis of a box from which a sheet is taken.
#include "extract/bare_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include <matstruct/metrics.h>
#include <matstruct/strata.h>

#include "base/index.h"
#include "preserve/refine.h"
#include "refined.h"
#include "solid_domain.h"

namespace matstruct {
namespace {

/// The axis of a box of sides 1, 2, 3, internal units, without the sheet of the edge at x = 1/2, y = 1.
struct BoxWithoutASheet {
  BoxWithoutASheet() : box(1, 2, 3), finders(box.domain, kSmoothAngle) {
    mesh = refined(oracle::medial_mesh_of(oracle::medial_axis(oracle::box(1, 2, 3))), 2);
    for (Vec3& c : mesh.centers) {
      medial.push_back(box.sphere_at(c));
      on_edge.push_back(std::abs(c.x - 0.5) < 1e-9 && std::abs(c.y - 1) < 1e-9);
      c = medial.back().center;
    }
    for (double& r : mesh.radii) r = box.to_internal(r);
    spheres.resize(mesh.centers.size());
    std::iota(spheres.begin(), spheres.end(), 0);
    whole = mesh;
    const Strata strata = trace_strata(mesh);
    const auto at_edge = [&](const Triangle& t) {
      return std::count_if(t.begin(), t.end(), [&](Index v) { return on_edge[uz(v)]; }) == 2;
    };
    const auto face = std::find_if(mesh.faces.begin(), mesh.faces.end(), at_edge);
    const Index sheet = strata.sheet_of_face[static_cast<std::size_t>(face - mesh.faces.begin())];
    std::set<Edge> edges;
    for (const Edge& e : mesh.edges)
      if (on_edge[uz(e[0])] && on_edge[uz(e[1])]) line.push_back(e);
    edges.insert(line.begin(), line.end());
    mesh.faces.clear();
    for (std::size_t f = 0; f < whole.faces.size(); ++f) {
      const auto& [a, b, c] = whole.faces[f];
      if (strata.sheet_of_face[f] == sheet) continue;
      mesh.faces.push_back({a, b, c});
      edges.insert({{a, b}, {a, c}, {b, c}});
    }
    mesh.edges.assign(edges.begin(), edges.end());
  }

  ThinMesh thin(const MedialMesh& of) {
    ThinMesh result{of, spheres, {}, std::vector<std::uint8_t>(of.faces.size(), 0)};
    for (const auto& [a, b] : of.edges) {
      const std::array<const TangentSphere*, 2> ends{&medial[uz(a)], &medial[uz(b)]};
      result.edge_contacts.push_back(static_cast<std::uint8_t>(common_stratum(box.finder, ends, 0)));
    }
    return result;
  }
  Edits missing(const MedialMesh& of, double deviation) {
    return propose_missing_sheets(finders, thin(of), medial, kSmoothAngle,
                                  {.deviation = box.to_internal(deviation), .spacing = box.to_internal(0.25)},
                                  box.context);
  }

  Box box;
  FinderPool finders;
  MedialMesh mesh, whole;
  std::vector<TangentSphere> medial;
  std::vector<Index> spheres;
  std::vector<bool> on_edge;  // per vertex
  std::vector<Edge> line;     // edges of the mesh along the edge
};

TEST(BareLines, GetASphereOfTheirSheet) {
  BoxWithoutASheet exact;
  const Betti topology = betti_numbers(exact.mesh);
  const MedialMesh before = exact.mesh;
  ASSERT_EQ(trace_strata(before).curves.size(), 1u);
  EXPECT_EQ(cover_bare_lines(exact.finders, exact.box.to_internal(2.9), exact.medial, exact.spheres, exact.mesh), 0)
      << "the line is longer";
  EXPECT_EQ(exact.mesh.faces, before.faces);
  EXPECT_EQ(cover_bare_lines(exact.finders, exact.box.to_internal(3.1), exact.medial, exact.spheres, exact.mesh), 1);
  ASSERT_EQ(exact.mesh.centers.size(), before.centers.size() + 1);
  EXPECT_TRUE(std::is_sorted(exact.mesh.edges.begin(), exact.mesh.edges.end()));
  EXPECT_TRUE(std::is_sorted(exact.mesh.faces.begin(), exact.mesh.faces.end()));
  EXPECT_EQ(exact.mesh.faces.size(), before.faces.size() + exact.line.size());
  EXPECT_EQ(betti_numbers(exact.mesh), topology);
  const Strata strata = trace_strata(exact.mesh);
  EXPECT_TRUE(strata.curves.empty());
  EXPECT_EQ(strata.sheets, trace_strata(before).sheets + 1);
  // Tangent to the sides x = 1/2 and y = 1, half-way along the line.
  const TangentSphere& added = exact.medial[uz(exact.spheres.back())];
  const Vec3 center = exact.box.domain.frame.to_input(added.center);
  const double radius = exact.box.to_input(added.radius);
  EXPECT_GT(radius, 0.05);
  EXPECT_NEAR(center.x, 0.5 - radius, 1e-6);
  EXPECT_NEAR(center.y, 1 - radius, 1e-6);
  EXPECT_NEAR(center.z, 0, 1e-6);
}

TEST(BareLines, NoneOnTheExactAxis) {
  BoxWithoutASheet exact;
  EXPECT_EQ(cover_bare_lines(exact.finders, 1, exact.medial, exact.spheres, exact.whole), 0);
}

TEST(MissingSheets, GetSpheresBesideTheirSeam) {
  BoxWithoutASheet exact;
  EXPECT_TRUE(exact.missing(exact.whole, 0.02).insert.empty());
  const Edits edits = exact.missing(exact.mesh, 0.02);
  EXPECT_GE(count(edits.insert), 4);
  for (const SphereSeed& seed : edits.insert) {
    const Vec3 center = exact.box.domain.frame.to_input(seed.center);
    const double radius = exact.box.to_input(seed.radius);
    EXPECT_LT(radius, 0.5 - 0.01) << "it stands beside the seams";
    EXPECT_NEAR(center.x, 0.5 - radius, 1e-6);
    EXPECT_NEAR(center.y, 1 - radius, 1e-6);
  }
  EXPECT_TRUE(exact.missing(exact.mesh, 2).insert.empty()) << "so much may be missing";
}

}  // namespace
}  // namespace matstruct
