// Restricted power diagrams of medial spheres, beside CGAL's regular triangulation of the same spheres: what any method
// with exact combinatorics has to pay first. bench/plot_rpd.py makes the tables and the plot of docs/performance.md.
#include <benchmark/benchmark.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

#include "../tests/shapes.h"
#include "base/index.h"
#include "base/random.h"
#include "rpd/rpd.h"
#include "spheres/initial_spheres.h"

namespace {

using namespace matstruct;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr int kThreads = 2;
constexpr Index kModelTets = 10000;
constexpr Index kModelSpheres = 6000;

struct Model {
  Domain domain;
  std::vector<WeightedPoint> spheres;
};

Context with_threads(int n) {
  Context context;
  context.threads = n;
  return context;
}

/// L profile of about `tets` tets: cubes of an m x m x 1.5 m grid without a quarter, 6 tets each.
TetMesh bracket(Index tets) {
  const int half = std::max(1, static_cast<int>(std::cbrt(tets / 6.0 / 9.0) + 0.5));
  return shapes::grid(shapes::planes(2, 2 * half), shapes::planes(2, 2 * half), shapes::planes(3, 3 * half),
                      [=](int i, int j, int) { return i < half || j < half; });
}

/// Plate 3 x 3 x 1 with a square hole, of about `tets` tets: 8 m^3 cubes, 6 tets each.
TetMesh plate(Index tets) {
  const int m = std::max(1, static_cast<int>(std::cbrt(tets / 48.0) + 0.5));
  return shapes::grid(shapes::planes(3, 3 * m), shapes::planes(3, 3 * m), shapes::planes(1, m),
                      [=](int i, int j, int) { return i / m != 1 || j / m != 1; });
}

Domain domain_of(const TetMesh& mesh) {
  Context context;
  return prepare_domain(mesh, {}, context);
}

/// Spheres of radius up to `largest` about random points of the solid, uniform by volume.
std::vector<WeightedPoint> random_spheres(const Domain& domain, Index n, double largest) {
  const auto corner = [&](Index t, std::size_t k) { return domain.solid.vertices[uz(domain.solid.tets[uz(t)][k])]; };
  std::vector<double> volume_up_to{0};
  for (Index t = 0; t < count(domain.solid.tets); ++t) {
    const Vec3 a = corner(t, 0);
    volume_up_to.push_back(volume_up_to.back() + dot(cross(corner(t, 1) - a, corner(t, 2) - a), corner(t, 3) - a));
  }
  std::vector<WeightedPoint> spheres;
  for (Index s = 0; s < n; ++s) {
    KeyedRandom random(1, 0, static_cast<std::uint64_t>(s));
    const double v = random.uniform() * volume_up_to.back();
    const auto above = std::upper_bound(volume_up_to.begin(), volume_up_to.end() - 1, v);
    const auto t = static_cast<Index>(above - volume_up_to.begin()) - 1;
    std::array<double, 4> weights{};
    double sum = 0;
    for (double& w : weights) sum += w = -std::log(1 - random.uniform());
    Vec3 center;
    for (std::size_t k = 0; k < 4; ++k) center += (weights[k] / sum) * corner(t, k);
    const double r = largest * random.uniform();
    spheres.push_back({center, r * r});
  }
  return spheres;
}

/// Radius such that n spheres of it would fill the solid once.
double crowding_radius(const Domain& domain, Index n) {
  return std::cbrt(domain.volume / (4.2 * n));
}

/// The pipeline's first spheres, as dense as gives about `n` of them.
std::vector<WeightedPoint> medial_spheres(const Domain& domain, Index n) {
  Options options;
  Spheres spheres;
  for (int round = 0; round < 6; ++round) {
    spheres = initial_spheres(domain, options, with_threads(kThreads));
    const double ratio = static_cast<double>(n) / count(spheres.seeds);
    if (std::abs(ratio - 1) < 0.05) break;
    options.gamma *= std::sqrt(ratio);
  }
  return weighted_points(spheres);
}

/// Made once: several benchmarks use each.
const Model& model(const std::string& name) {
  static std::map<std::string, Model> models;
  if (const auto found = models.find(name); found != models.end()) return found->second;
  Domain domain = domain_of(name.starts_with("plate") ? plate(kModelTets) : bracket(kModelTets));
  std::vector<WeightedPoint> spheres =
      name.ends_with("random") ? random_spheres(domain, kModelSpheres, crowding_radius(domain, kModelSpheres))
                               : medial_spheres(domain, kModelSpheres);
  return models.emplace(name, Model{std::move(domain), std::move(spheres)}).first->second;
}

void set_sizes(benchmark::State& state, const Domain& domain, const std::vector<WeightedPoint>& spheres) {
  state.counters["tets"] = static_cast<double>(domain.solid.tets.size());
  state.counters["spheres"] = static_cast<double>(spheres.size());
}

void set_counts(benchmark::State& state, const RpdEngine& engine) {
  state.counters["cells"] = static_cast<double>(engine.diagram().cells.size());
}

// ---------------------------------------------------------------- the diagram and the triangulation

void diagram(benchmark::State& state, const std::string& name, int threads) {
  const Model& m = model(name);
  RpdEngine engine(m.domain);
  for (auto _ : state) engine.compute(m.spheres, with_threads(threads));
  set_sizes(state, m.domain, m.spheres);
  set_counts(state, engine);
}

void triangulation_alone(benchmark::State& state, const std::string& name) {
  const Model& m = model(name);
  std::vector<Index> ids(m.spheres.size());
  std::iota(ids.begin(), ids.end(), 0);
  for (auto _ : state) {
    PowerTriangulation triangulation;
    triangulation.update(m.spheres, ids, {});
    benchmark::DoNotOptimize(triangulation.neighbors().list.data());
  }
  set_sizes(state, m.domain, m.spheres);
}

void insert_into_cgal(const std::vector<WeightedPoint>& spheres) {
  using Triangulation = CGAL::Regular_triangulation_3<Kernel>;
  std::vector<Triangulation::Weighted_point> points;
  points.reserve(spheres.size());
  for (const WeightedPoint& s : spheres)
    points.emplace_back(Kernel::Point_3(s.center.x, s.center.y, s.center.z), s.weight);
  const Triangulation triangulation(points.begin(), points.end());  // sorts the points along a space-filling curve
  benchmark::DoNotOptimize(triangulation.number_of_vertices());
}

void cgal_triangulation(benchmark::State& state, const std::string& name) {
  const Model& m = model(name);
  for (auto _ : state) insert_into_cgal(m.spheres);
  set_sizes(state, m.domain, m.spheres);
}

/// Number of side tests that plain arithmetic could not decide; on one thread, where they are counted.
void exact_predicates(benchmark::State& state, const std::string& name) {
  const Model& m = model(name);
  RpdEngine engine(m.domain);
  std::size_t exact = 0;
  for (auto _ : state) {
    const std::size_t before = exact_power_sides();
    engine.compute(m.spheres, with_threads(1));
    exact = exact_power_sides() - before;
  }
  set_sizes(state, m.domain, m.spheres);
  set_counts(state, engine);
  state.counters["exact"] = static_cast<double>(exact);
}

// ---------------------------------------------------------------- scaling

void scaling(benchmark::State& state, bool proportional) {
  const auto n = static_cast<Index>(state.range(0));
  const Domain domain = domain_of(bracket(proportional ? n * 5 / 3 : kModelTets));
  const auto spheres = random_spheres(domain, n, crowding_radius(domain, n));
  RpdEngine engine(domain);
  for (auto _ : state) engine.compute(spheres, with_threads(kThreads));
  set_sizes(state, domain, spheres);
  set_counts(state, engine);
}

void scaling_cgal(benchmark::State& state) {
  const auto n = static_cast<Index>(state.range(0));
  const Domain domain = domain_of(bracket(kModelTets));
  const auto spheres = random_spheres(domain, n, crowding_radius(domain, n));
  for (auto _ : state) insert_into_cgal(spheres);
  set_sizes(state, domain, spheres);
}

// ---------------------------------------------------------------- updates

/// Each iteration removes range(0) of the model's spheres and inserts them again under new ids.
void update(benchmark::State& state, const std::string& name) {
  const Model& m = model(name);
  const auto change = static_cast<Index>(state.range(0));
  RpdEngine engine(m.domain);
  std::vector<WeightedPoint> spheres = m.spheres;
  engine.compute(spheres, with_threads(kThreads));
  std::vector<Index> ids(spheres.size());  // present name of the model's spheres
  std::iota(ids.begin(), ids.end(), 0);
  KeyedRandom random(2, 0, 0);
  for (auto _ : state) {
    std::vector<Index> removed, inserted;
    for (Index k = 0; k < change; ++k) {
      Index& id = ids[random.next() % ids.size()];
      if (std::find(inserted.begin(), inserted.end(), id) != inserted.end()) continue;
      removed.push_back(id);
      spheres.push_back(spheres[uz(id)]);
      inserted.push_back(id = count(spheres) - 1);
    }
    engine.update(spheres, inserted, removed, with_threads(kThreads));
  }
  set_sizes(state, m.domain, m.spheres);
}

}  // namespace

int main(int argc, char** argv) {
  const auto in_ms = [](benchmark::internal::Benchmark* b) {
    return b->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
  };
  for (const std::string name : {"bracket", "plate", "bracket random", "plate random"}) {
    in_ms(benchmark::RegisterBenchmark(("cgal/" + name).c_str(), cgal_triangulation, name));
    in_ms(benchmark::RegisterBenchmark(("triangulation/" + name).c_str(), triangulation_alone, name));
    for (const int threads : {1, kThreads})
      in_ms(benchmark::RegisterBenchmark(("rpd/" + name + "/threads:" + std::to_string(threads)).c_str(), diagram, name,
                                         threads));
    in_ms(benchmark::RegisterBenchmark(("exact/" + name).c_str(), exact_predicates, name))->Iterations(1);
  }
  for (const std::string name : {"bracket", "plate"})
    in_ms(benchmark::RegisterBenchmark(("update/" + name).c_str(), update, name))->RangeMultiplier(10)->Range(1, 100);
  for (const Index n : {1000, 3000, 10000, 30000, 100000}) {
    const Index iterations = std::max(1, 10000 / n);
    in_ms(benchmark::RegisterBenchmark("scaling_cgal", scaling_cgal))->Arg(n)->Iterations(iterations);
    in_ms(benchmark::RegisterBenchmark("scaling_fixed", scaling, false))->Arg(n)->Iterations(iterations);
    in_ms(benchmark::RegisterBenchmark("scaling_proportional", scaling, true))->Arg(n)->Iterations(iterations);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
