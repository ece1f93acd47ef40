// compute() against the exact medial axis of convex polyhedra: spheres on it to rounding, faces near it, all of it
// covered. Every edge of a convex polyhedron is made a feature, since every edge bounds a sheet of the axis.

#include <gtest/gtest.h>

#include <matstruct/compute.h>

#include "convex_oracle.h"
#include "query/surface_query.h"

namespace matstruct {
namespace {

constexpr Index kSamples = 4000;
// Error of a sphere, relative to the diagonal.
constexpr double kSphereError = 1e-6;
// Mean and greatest distance between the faces and the axis, in spacings (diagonal / gamma): 0.3 % and 2.5 % of the
// diagonal at the default density. Faces do not know seams yet: one that spans a seam leaves the axis by a part of the
// spacing.
constexpr double kMeanDistance = 0.12, kGreatestDistance = 1;

Options all_edges_sharp(double gamma) {
  return {.gamma = gamma, .convex_angle = 1, .samples = 1000, .threads = 2};
}

struct Deviation {
  double mean = 0, greatest = 0;
  void add(double d, Index samples) {
    mean += d / samples;
    greatest = std::max(greatest, d);
  }
};

double diagonal_of(const oracle::ConvexPolyhedron& solid) {
  Vec3 low = solid.vertices.front(), high = low;
  for (const Vec3& v : solid.vertices) low = min(low, v), high = max(high, v);
  return distance(low, high);
}

std::vector<double> face_distances(const oracle::ConvexPolyhedron& solid, const Vec3& x) {
  std::vector<double> distances;
  for (const oracle::HalfSpace& h : solid.half_spaces) distances.push_back(h.distance(x));
  std::sort(distances.begin(), distances.end());
  return distances;
}

// On the axis the two nearest faces are equally far, and the radius is that distance; 0 on the edges and corners.
void expect_spheres_on_axis(const oracle::ConvexPolyhedron& solid, const MedialMesh& mesh) {
  const double tolerance = kSphereError * diagonal_of(solid);
  for (std::size_t v = 0; v < mesh.centers.size(); ++v) {
    const std::vector<double> distances = face_distances(solid, mesh.centers[v]);
    EXPECT_NEAR(distances[0], mesh.radii[v], tolerance) << "sphere " << v;
    EXPECT_NEAR(distances[1], distances[0], tolerance) << "sphere " << v;
    const bool feature = mesh.types[v] == SphereType::kSharpEdge || mesh.types[v] == SphereType::kCorner;
    EXPECT_EQ(feature, mesh.radii[v] == 0) << "sphere " << v;
    if (mesh.types[v] == SphereType::kCorner) {
      EXPECT_NEAR(distances[2], 0, tolerance) << "sphere " << v;
    }
  }
}

std::vector<Vec3> sample_faces(const MedialMesh& mesh, Index n, std::uint64_t seed) {
  std::vector<double> area_up_to;
  double total = 0;
  const auto at = [&](Index v) { return mesh.centers[uz(v)]; };
  for (const auto& [a, b, c] : mesh.faces) area_up_to.push_back(total += triangle_area(at(a), at(b), at(c)));
  std::vector<Vec3> points;
  for (Index s = 0; s < n; ++s) {
    KeyedRandom random(seed, 1, static_cast<std::uint64_t>(s));
    const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, total * random.uniform());
    const auto& [a, b, c] = mesh.faces[static_cast<std::size_t>(found - area_up_to.begin())];
    const double root = std::sqrt(random.uniform());
    points.push_back(lerp(at(a), lerp(at(b), at(c), random.uniform()), root));
  }
  return points;
}

// Vertices, edges and faces; the former as degenerate triangles.
TriSurface simplices_of(const MedialMesh& mesh) {
  TriSurface surface{mesh.centers, mesh.faces};
  for (const auto& [i, j] : mesh.edges) surface.triangles.push_back({i, j, j});
  for (Index v = 0; v < count(mesh.centers); ++v) surface.triangles.push_back({v, v, v});
  return surface;
}

Deviation faces_to_axis(const MedialMesh& mesh, const oracle::ConvexAxis& axis) {
  Deviation deviation;
  for (const Vec3& x : sample_faces(mesh, kSamples, 1)) deviation.add(oracle::distance_to_axis(axis, x), kSamples);
  return deviation;
}

Deviation axis_to_faces(const oracle::ConvexAxis& axis, const MedialMesh& mesh) {
  const SurfaceQuery query(simplices_of(mesh));
  Deviation deviation;
  for (const Vec3& x : oracle::sample_axis(axis, kSamples, 2))
    deviation.add(std::sqrt(query.closest(x).distance2), kSamples);
  return deviation;
}

struct Deviations {
  Deviation faces_to_axis, axis_to_faces;
};

// In diagonals.
Deviations deviations_of(const oracle::ConvexPolyhedron& solid, const MedialMesh& mesh) {
  const oracle::ConvexAxis axis = oracle::medial_axis(solid);
  Deviations result{faces_to_axis(mesh, axis), axis_to_faces(axis, mesh)};
  for (Deviation* d : {&result.faces_to_axis, &result.axis_to_faces})
    d->mean /= diagonal_of(solid), d->greatest /= diagonal_of(solid);
  return result;
}

void expect_guarantees(const Report& report) {
  EXPECT_TRUE(report.topology.equal);
  EXPECT_TRUE(report.thin.holds);
  EXPECT_TRUE(report.tiling.holds);
  EXPECT_TRUE(report.features.holds);
  EXPECT_TRUE(report.guarantees_hold);
}

// Worst figures of a group of solids, in per cent of the diagonal, as properties of the test.
class Worst {
 public:
  ~Worst() {
    const auto record = [](const std::string& name, double value) {
      testing::Test::RecordProperty(name, std::to_string(100 * value));
    };
    record("faces_to_axis_mean", worst_.faces_to_axis.mean);
    record("faces_to_axis_greatest", worst_.faces_to_axis.greatest);
    record("axis_to_faces_mean", worst_.axis_to_faces.mean);
    record("axis_to_faces_greatest", worst_.axis_to_faces.greatest);
  }
  void add(const Deviations& d) {
    const auto update = [](Deviation& worst, const Deviation& value) {
      worst = {std::max(worst.mean, value.mean), std::max(worst.greatest, value.greatest)};
    };
    update(worst_.faces_to_axis, d.faces_to_axis);
    update(worst_.axis_to_faces, d.axis_to_faces);
  }

 private:
  Deviations worst_;
};

void expect_exact_axis(const oracle::ConvexPolyhedron& solid, Worst& worst, double gamma = Options{}.gamma) {
  Context context;
  const Result result = compute(oracle::tet_mesh_of(solid), all_edges_sharp(gamma), context);
  expect_guarantees(result.report);
  EXPECT_EQ(result.report.features.lines, count(oracle::edges_of(solid)));
  EXPECT_EQ(result.report.features.corners, count(solid.vertices));
  expect_spheres_on_axis(solid, result.mesh);
  const Deviations d = deviations_of(solid, result.mesh);
  for (const Deviation& side : {d.faces_to_axis, d.axis_to_faces}) {
    EXPECT_LE(side.mean, kMeanDistance / gamma);
    EXPECT_LE(side.greatest, kGreatestDistance / gamma);
  }
  worst.add(d);
}

TEST(ExactAxis, CoarseTetrahedron) {
  Worst worst;
  expect_exact_axis(oracle::tetrahedron(), worst, 12);
}

TEST(ModelsExactAxis, Boxes) {
  Worst worst;
  for (const Vec3& size :
       {Vec3{1, 1, 1}, {1, 1, 2}, {1, 2, 2}, {1, 2, 3}, {1, 1, 10}, {1, 5, 5}, {0.1, 1, 2}, {1, 1.01, 1.02}}) {
    SCOPED_TRACE(testing::Message() << "box " << size.x << " x " << size.y << " x " << size.z);
    expect_exact_axis(oracle::box(size.x, size.y, size.z), worst);
  }
}

TEST(ModelsExactAxis, Prisms) {
  Worst worst;
  for (const int sides : {3, 5, 6, 8, 12})
    for (const double height : {0.5, 2.0, 6.0}) {
      SCOPED_TRACE(testing::Message() << sides << " sides, height " << height);
      expect_exact_axis(oracle::prism(sides, 1, height), worst);
    }
}

TEST(ModelsExactAxis, Pyramids) {
  Worst worst;
  for (const int sides : {3, 4, 5, 8})
    for (const double height : {0.7, 2.0, 4.0}) {
      SCOPED_TRACE(testing::Message() << sides << " sides, height " << height);
      expect_exact_axis(oracle::pyramid(sides, 1, height), worst);
    }
}

TEST(ModelsExactAxis, RegularTetrahedron) {
  Worst worst;
  expect_exact_axis(oracle::tetrahedron(), worst);
}

TEST(ModelsExactAxis, RandomPolyhedra) {
  constexpr int kSolids = 50, kFewestFaces = 5, kCounts = 14;
  Worst worst;
  for (int k = 0; k < kSolids; ++k) {
    const int faces = kFewestFaces + k % kCounts;
    SCOPED_TRACE(testing::Message() << "solid " << k << " with " << faces << " faces");
    expect_exact_axis(oracle::random_convex_polyhedron(static_cast<std::uint64_t>(k), faces), worst);
  }
}

}  // namespace
}  // namespace matstruct
