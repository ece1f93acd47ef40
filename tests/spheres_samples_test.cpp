// Volume samples, their owners, and the contacts that they tell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "base/random.h"
#include "base/tolerances.h"
#include "sampled_model.h"
#include "shapes.h"

namespace matstruct {
namespace {

const Context kContext;

Domain prepare(const TetMesh& mesh) {
  Context context;
  return prepare_domain(mesh, {}, context);
}

VolumeSamples samples_of(const Domain& domain, double gamma = 40) {
  return volume_samples(domain, {domain.diagonal / gamma}, kContext);
}

// ---------------------------------------------------------------- samples

TEST(VolumeSamples, FeetAreNearestSurfacePoints) {
  for (const shapes::Shape& shape : shapes::all()) {
    SCOPED_TRACE(shape.name);
    const Domain domain = prepare(shape.mesh);
    const VolumeSamples samples = samples_of(domain, 15);
    ASSERT_GT(samples.samples.size(), 500u);
    for (const VolumeSample& s : samples.samples) {
      ASSERT_TRUE(domain.query.inside(s.point));
      const double depth = distance(s.point, s.foot);
      ASSERT_NEAR(std::sqrt(domain.query.closest(s.point).distance2), depth, 1e-12);
      ASSERT_NEAR(norm(s.normal), 1, 1e-12);
      ASSERT_GT(s.weight, 0);
      if (depth > tolerance::kSampleDepth) {
        ASSERT_LE(distance(s.point + depth * s.normal, s.foot), 1e-12);
      }
    }
  }
}

TEST(VolumeSamples, WeightsAddUpToTheVolumeOfABox) {
  // A prism below each point of a face, as deep as its ball: the volume between the surface and the medial axis.
  const Domain domain = prepare(shapes::box({1, 2, 3}));
  double volume = 0;
  for (const VolumeSample& s : samples_of(domain).samples) volume += s.weight;
  EXPECT_NEAR(volume / domain.volume, 1, 0.02);
}

TEST(VolumeSamples, ConcaveLinesHaveFans) {
  const Domain domain = prepare(shapes::l_profile());
  int on_line = 0;
  double low = 10, high = -10;  // angles of the fan
  for (const VolumeSample& s : samples_of(domain).samples) {
    if (s.line == kInvalid) continue;
    ASSERT_EQ(domain.features.lines[uz(s.line)].kind, EdgeKind::kConcave);
    ++on_line;
    const Vec3 normal = domain.frame.turned_back(s.normal);
    const double angle = std::atan2(normal.y, normal.x);
    low = std::min(low, angle), high = std::max(high, angle);
  }
  EXPECT_GT(on_line, 50);
  EXPECT_NEAR(low, 0, 0.05);
  EXPECT_NEAR(high, std::numbers::pi / 2, 0.05);
}

TEST(VolumeSamples, VerticesOfACavityHaveFans) {
  const Domain domain = prepare(shapes::hollow_box());
  std::set<std::array<double, 3>> seen;
  int at_vertices = 0;
  for (const VolumeSample& s : samples_of(domain).samples)
    for (const Index v : domain.surface.triangles[uz(s.triangle)])
      if (distance(domain.surface.vertices[uz(v)], s.foot) < 1e-12) {
        ++at_vertices;
        seen.insert({s.foot.x, s.foot.y, s.foot.z});
      }
  EXPECT_GE(seen.size(), 8u);
  EXPECT_GT(at_vertices, 8 * 10);
}

TEST(VolumeSamples, LinksDoNotCrossConvexEdges) {
  const Domain domain = prepare(shapes::l_profile());
  const VolumeSamples samples = samples_of(domain);
  int across_concave = 0;
  for (Index s = 0; s < count(samples.samples); ++s) {
    const VolumeSample& a = samples.samples[uz(s)];
    for (Index k = samples.start[uz(s)]; k < samples.start[uz(s) + 1]; ++k) {
      const Index other = samples.list[uz(k)];
      const VolumeSample& b = samples.samples[uz(other)];
      ASSERT_EQ(a.patch, b.patch);
      ASSERT_LE(distance(a.foot, b.foot), link_reach(domain.diagonal / 40) * (1 + 1e-12));
      ASSERT_TRUE(std::binary_search(samples.list.begin() + samples.start[uz(other)],
                                     samples.list.begin() + samples.start[uz(other) + 1], s));
      across_concave += distance(domain.triangle_normals[uz(a.triangle)], domain.triangle_normals[uz(b.triangle)]) > 1;
    }
  }
  EXPECT_GT(across_concave, 0);
}

TEST(VolumeSamples, SameForAnyNumberOfThreads) {
  const Domain domain = prepare(shapes::l_profile());
  VolumeSamples results[2];
  for (int k = 0; k < 2; ++k) {
    Context context;
    context.threads = k + 1;
    results[k] = volume_samples(domain, {domain.diagonal / 30}, context);
  }
  ASSERT_EQ(results[0].samples.size(), results[1].samples.size());
  for (std::size_t s = 0; s < results[0].samples.size(); ++s) {
    EXPECT_EQ(results[0].samples[s].point, results[1].samples[s].point);
    EXPECT_EQ(results[0].samples[s].foot, results[1].samples[s].foot);
  }
  EXPECT_EQ(results[0].list, results[1].list);
}

// ---------------------------------------------------------------- owners

/// Greatest excess of the owners' power distances over the least ones, by brute force.
double greatest_excess(const std::vector<Vec3>& points, const std::vector<WeightedPoint>& spheres,
                       const std::vector<Index>& owners) {
  double excess = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto power = [&](Index s) { return distance2(points[k], spheres[uz(s)].center) - spheres[uz(s)].weight; };
    double least = std::numeric_limits<double>::infinity();
    for (Index s = 0; s < count(spheres); ++s) least = std::min(least, power(s));
    excess = std::max(excess, power(owners[k]) - least);
  }
  return excess;
}

TEST(PowerOwners, AreNearestByBruteForce) {
  KeyedRandom random(1, 0, 0);
  const auto point = [&] { return Vec3{random.uniform(), random.uniform(), random.uniform()}; };
  std::vector<WeightedPoint> spheres;
  std::vector<Index> ids;
  for (Index s = 0; s < 400; ++s) {
    spheres.push_back({point(), 0.02 * random.uniform()});  // many are hidden
    ids.push_back(s);
  }
  std::vector<Vec3> points;
  for (int k = 0; k < 5000; ++k) points.push_back(1.4 * point() - Vec3{0.2, 0.2, 0.2});
  PowerTriangulation triangulation;
  triangulation.update(spheres, ids, {});
  const auto& [start, list] = triangulation.neighbors();
  std::vector<Index> owners;
  update_owners(points, spheres, {start, list}, kContext, owners);
  EXPECT_LE(greatest_excess(points, spheres, owners), 1e-14);

  // From wrong and invalid owners, with two threads: the same.
  std::vector<Index> again(points.size(), 399);
  again[0] = 1000, again[1] = -7;
  Context two;
  two.threads = 2;
  update_owners(points, spheres, {start, list}, two, again);
  EXPECT_EQ(again, owners);
}

TEST(PowerOwners, OneSphereOwnsAll) {
  const std::vector<WeightedPoint> spheres{{{0, 0, 0}, 1}};
  const std::vector<Index> start{0, 0};
  std::vector<Index> owners;
  update_owners(std::vector<Vec3>{{1, 2, 3}, {0, 0, 0}}, spheres, {start, {}}, kContext, owners);
  EXPECT_EQ(owners, (std::vector<Index>{0, 0}));
}

TEST(CellSampling, FillsPoorCellsWithSamplesOfTheirOwn) {
  Context context;
  const Domain domain = prepare(shapes::l_profile());
  SampledModel model(domain, {.gamma = 25}, context);
  const Index before = count(model.samples.samples),
              added = model.add_to_poor_cells(model.sheet_spheres(), 48, context);
  ASSERT_GT(added, 1000);
  ASSERT_EQ(count(model.samples.samples), before + added);
  std::vector<int> held(model.spheres.seeds.size(), 0);
  std::vector<Vec3> points;
  for (Index k = 0; k < before + added; ++k) {
    const VolumeSample& s = model.samples.samples[uz(k)];
    ++held[uz(model.owners[uz(k)])];
    points.push_back(s.point);
    if (k < before) continue;
    ASSERT_TRUE(model.domain.query.inside(s.point));
    ASSERT_NEAR(std::sqrt(model.domain.query.closest(s.point).distance2), distance(s.point, s.foot), 1e-12);
  }
  EXPECT_LE(greatest_excess(points, model.engine.spheres(), model.owners), 1e-12);
  int poor = 0;
  for (std::size_t s = 0; s < held.size(); ++s)
    poor += model.spheres.seeds[s].type == SphereType::kSheet && !model.spheres.seeds[s].guard &&
            model.engine.visible()[s] && held[s] < 48;
  EXPECT_LE(poor, 2);
}

// ---------------------------------------------------------------- contacts

/// Number of face planes of a convex solid whose distance from x exceeds the least by at most `margin`.
int planes_near(const Domain& domain, const Vec3& x, double margin) {
  std::vector<std::pair<Vec3, double>> planes;
  for (Index t = 0; t < count(domain.surface.triangles); ++t) {
    const Vec3& n = domain.triangle_normals[uz(t)];
    if (std::none_of(planes.begin(), planes.end(), [&](const auto& p) { return distance(p.first, n) < 1e-9; }))
      planes.emplace_back(n, dot(domain.surface.vertices[uz(domain.surface.triangles[uz(t)][0])] - x, n));
  }
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [n, d] : planes) least = std::min(least, d);
  return static_cast<int>(
      std::count_if(planes.begin(), planes.end(), [&](const auto& p) { return p.second <= least + margin; }));
}

TEST(CellContacts, OfABoxLieBetweenThoseOfTheSphereAndThoseInReach) {
  Context context;
  const Domain domain = prepare(shapes::box({1, 2, 3}, 2, 3, 4));
  const SampledModel model(domain, {}, context);
  const CellContacts contacts = model.contacts({.least_share = 0});
  const double spacing = target_spacing(model.domain, {});
  int sheets = 0, two = 0, corners = 0;
  for (Index s = 0; s < count(model.spheres.seeds); ++s) {
    const SphereSeed& seed = model.spheres.seeds[uz(s)];
    const Index order = contact_order(contacts, s);
    if (seed.type == SphereType::kCorner) {
      EXPECT_LE(order, 3) << s;
      corners += order == 3;  // the cell of a corner is small: by chance a face may have no sample in it
    } else if (seed.type == SphereType::kSharpEdge) {
      EXPECT_GE(order, 2) << s;
    } else if (order > 0) {
      ++sheets, two += order == 2;
      EXPECT_LE(order, planes_near(model.domain, seed.center, 3 * spacing)) << s;
      // Far from seams, so that the cell does not reach one.
      if (planes_near(model.domain, seed.center, 3 * spacing) == 2) {
        EXPECT_EQ(order, 2) << s;
      }
    }
  }
  EXPECT_GE(corners, 6);
  EXPECT_GT(sheets, 500);
  EXPECT_GT(two, sheets / 2);
}

TEST(CellContacts, ConcaveLineIsOneContact) {
  // Spheres on the sheets that end at the concave edge of an L touch it and one face.
  Context context;
  const Domain domain = prepare(shapes::l_profile(6));
  const SampledModel model(domain, {}, context);
  const CellContacts contacts = model.contacts();
  int checked = 0;
  for (Index s = 0; s < count(model.spheres.seeds); ++s) {
    const SphereSeed& seed = model.spheres.seeds[uz(s)];
    const Frame& frame = model.domain.frame;
    const Vec3 center = frame.to_input(seed.center);
    const double z = center.z, off = std::hypot(center.x - 1, center.y - 1) * frame.scale - seed.radius;
    if (seed.type != SphereType::kSheet || seed.guard || z < 1.5 || z > 4.5 || off > 1e-9) continue;
    const Index begin = contacts.start[uz(s)], end = contacts.start[uz(s) + 1];
    const auto on_lines = std::count_if(contacts.clusters.begin() + begin, contacts.clusters.begin() + end,
                                        [](const ContactCluster& c) { return c.line != kInvalid; });
    EXPECT_LE(on_lines, 1);
    checked += on_lines == 1;
  }
  EXPECT_GT(checked, 20);
}

TEST(CellContacts, EdgesInsideASheetAreValidAndAcrossASeamNot) {
  // Three samples each under faces A, B, C of a prism; cell 0 meets A and B, cell 1 A and B, cell 2 B and C, cell 3
  // all.
  VolumeSamples samples;
  std::vector<Index> owners;
  std::vector<Edge> links;
  const std::vector<std::vector<int>> faces{{0, 1}, {0, 1}, {1, 2}, {0, 1, 2}};
  for (Index cell = 0; cell < 4; ++cell)
    for (const int face : faces[uz(cell)]) {
      const double angle = 2 * std::numbers::pi * face / 3;
      VolumeSample s;
      s.normal = {std::cos(angle), std::sin(angle), 0};
      s.patch = face, s.weight = 1;
      for (Index other = 0; other < count(samples.samples); ++other)
        if (samples.samples[uz(other)].patch == face) links.push_back({count(samples.samples), other});
      samples.samples.push_back(s);
      owners.push_back(cell);
    }
  for (std::size_t k = links.size(); k-- > 0;) links.push_back({links[k][1], links[k][0]});
  std::sort(links.begin(), links.end());
  for (Index s = 0; s <= count(samples.samples); ++s)
    samples.start.push_back(
        static_cast<Index>(std::lower_bound(links.begin(), links.end(), Edge{s, -1}) - links.begin()));
  for (const Edge& link : links) samples.list.push_back(link[1]);

  const CellContacts contacts = cell_contacts(samples, owners, 5, {});
  EXPECT_EQ(contact_order(contacts, 0), 2);
  EXPECT_EQ(contact_order(contacts, 3), 3);
  EXPECT_EQ(contact_order(contacts, 4), 0);
  EXPECT_TRUE(is_valid_edge(contacts, {0, 1}));   // one sheet
  EXPECT_FALSE(is_valid_edge(contacts, {0, 2}));  // cuts across the seam
  EXPECT_TRUE(is_valid_edge(contacts, {0, 3}));   // from a sheet to the seam
  EXPECT_TRUE(is_valid_edge(contacts, {2, 3}));
  EXPECT_TRUE(is_valid_edge(contacts, {0, 4}));  // nothing is known of a cell without samples
  EXPECT_TRUE(is_valid_face(contacts, {0, 1, 3}));
  EXPECT_FALSE(is_valid_face(contacts, {0, 2, 3}));
}

TEST(CellContacts, SmallClustersAreLeftOut) {
  VolumeSamples samples;
  for (int k = 0; k < 2; ++k) {
    VolumeSample s;
    s.normal = {k == 0 ? 1.0 : -1.0, 0, 0};
    s.patch = 0, s.weight = k == 0 ? 1 : 0.01;
    samples.samples.push_back(s);
  }
  samples.start = {0, 0, 0};
  const std::vector<Index> owners{0, 0};
  EXPECT_EQ(contact_order(cell_contacts(samples, owners, 1, {.least_share = 0}), 0), 2);
  EXPECT_EQ(contact_order(cell_contacts(samples, owners, 1, {.least_share = 0.02}), 0), 1);
}

TEST(JoinDirections, UnitesAsComparingAllPairsDoes) {
  for (std::uint64_t round = 0; round < 20; ++round) {
    KeyedRandom random(1, 0, round);
    const auto below = [&](Index n) { return static_cast<Index>(random.uniform() * n); };
    std::vector<VolumeSample> samples(60);
    std::vector<Index> ids;
    for (VolumeSample& s : samples) {
      const double z = 2 * random.uniform() - 1, turn = 2 * std::numbers::pi * random.uniform();
      s.normal = {std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z};
      s.patch = below(2);
      if (below(20) == 0) s.line = below(3);
      if (below(5) > 0) ids.push_back(static_cast<Index>(&s - samples.data()));
    }
    for (const double angle : {0.05, 0.3, 0.52, 1.5, 3.2}) {
      UnionFind fast(count(samples)), slow = fast;
      join_directions(samples, ids, angle, fast);
      for (const Index i : ids)
        for (const Index j : ids) {
          const VolumeSample &a = samples[uz(i)], &b = samples[uz(j)];
          const bool same_way =
              a.patch == b.patch && dot(a.normal, b.normal) >= std::cos(std::min(angle, std::numbers::pi));
          if (same_way || (a.line != kInvalid && a.line == b.line)) slow.unite(i, j);
        }
      for (Index k = 0; k < count(samples); ++k) EXPECT_EQ(fast.find(k), slow.find(k));
    }
  }
}

}  // namespace
}  // namespace matstruct
