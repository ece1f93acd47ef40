// Closest points on a surface of 50k triangles: SurfaceQuery beside CGAL's AABB tree.
#include <benchmark/benchmark.h>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <numbers>

#include "base/index.h"
#include "base/random.h"
#include "query/surface_query.h"

namespace {

using namespace matstruct;
using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using AabbTree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr Index kQueries = 4096;

/// Closed torus with bumps: 2 n^2 triangles.
TriSurface bumpy_torus(Index n) {
  TriSurface s;
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      const double u = kTurn * i / n, v = kTurn * j / n;
      const double r = 0.3 + 0.04 * std::sin(7 * u) * std::sin(5 * v);
      s.vertices.push_back({(1 + r * std::cos(v)) * std::cos(u), (1 + r * std::cos(v)) * std::sin(u), r * std::sin(v)});
      const Index a = i * n + j, b = (i + 1) % n * n + j, c = (i + 1) % n * n + (j + 1) % n, d = i * n + (j + 1) % n;
      s.triangles.push_back({a, b, c});
      s.triangles.push_back({a, c, d});
    }
  }
  return s;
}

const TriSurface& surface() {
  static const TriSurface s = bumpy_torus(158);
  return s;
}

/// Random points of the solid torus' core.
std::vector<Vec3> inner_points() {
  std::vector<Vec3> points;
  KeyedRandom random(1, 0, 0);
  for (Index i = 0; i < kQueries; ++i) {
    const double u = kTurn * random.uniform(), v = kTurn * random.uniform(), r = 0.25 * std::sqrt(random.uniform());
    points.push_back({(1 + r * std::cos(v)) * std::cos(u), (1 + r * std::cos(v)) * std::sin(u), r * std::sin(v)});
  }
  return points;
}

/// A walk in small steps: what sphere shrinking and projection ask for.
std::vector<Vec3> clustered_points() {
  std::vector<Vec3> points;
  KeyedRandom random(2, 0, 0);
  double u = 0, v = 0;
  for (Index i = 0; i < kQueries; ++i) {
    u += 0.02 * random.uniform(), v += 0.05 * random.uniform();
    points.push_back({(1 + 0.2 * std::cos(v)) * std::cos(u), (1 + 0.2 * std::cos(v)) * std::sin(u), 0.2 * std::sin(v)});
  }
  return points;
}

void closest_random(benchmark::State& state) {
  const SurfaceQuery query(surface());
  const std::vector<Vec3> points = inner_points();
  for (auto _ : state) {
    for (const Vec3& p : points) benchmark::DoNotOptimize(query.closest(p).distance2);
  }
  state.SetItemsProcessed(state.iterations() * kQueries);
}
BENCHMARK(closest_random)->Unit(benchmark::kMillisecond);

void closest_near_clustered(benchmark::State& state) {
  const SurfaceQuery query(surface());
  const std::vector<Vec3> points = clustered_points();
  Index guess = kInvalid;
  for (auto _ : state) {
    for (const Vec3& p : points) benchmark::DoNotOptimize(guess = query.closest_near(p, guess).triangle);
  }
  state.SetItemsProcessed(state.iterations() * kQueries);
}
BENCHMARK(closest_near_clustered)->Unit(benchmark::kMillisecond);

void inside_random(benchmark::State& state) {
  const SurfaceQuery query(surface());
  const std::vector<Vec3> points = inner_points();
  for (auto _ : state) {
    for (const Vec3& p : points) benchmark::DoNotOptimize(query.inside(p));
  }
  state.SetItemsProcessed(state.iterations() * kQueries);
}
BENCHMARK(inside_random)->Unit(benchmark::kMillisecond);

void build(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(SurfaceQuery(surface()).closest({}).triangle);
}
BENCHMARK(build)->Unit(benchmark::kMillisecond);

void closest_random_cgal(benchmark::State& state) {
  const auto point = [](const Vec3& p) { return Kernel::Point_3(p.x, p.y, p.z); };
  Triangles triangles;
  for (const Triangle& t : surface().triangles) {
    const auto corner = [&](std::size_t k) { return point(surface().vertices[uz(t[k])]); };
    triangles.emplace_back(corner(0), corner(1), corner(2));
  }
  AabbTree tree(triangles.begin(), triangles.end());
  tree.build();
  tree.accelerate_distance_queries();
  const std::vector<Vec3> points = inner_points();
  for (auto _ : state) {
    for (const Vec3& p : points) benchmark::DoNotOptimize(tree.closest_point(point(p)));
  }
  state.SetItemsProcessed(state.iterations() * kQueries);
}
BENCHMARK(closest_random_cgal)->Unit(benchmark::kMillisecond);

}  // namespace
