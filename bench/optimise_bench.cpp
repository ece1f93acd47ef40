// Particles on the spheres of real models: how even the spheres become, what each way of projecting them back on the
// medial axis costs, and how much of the evenness it keeps. Each iteration is one round: owners of the samples,
// contacts, freedom, minimisation, projection.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <variant>

#include <matstruct/io.h>

#include "base/index.h"
#include "base/parallel.h"
#include "optimise/freedom.h"
#include "optimise/particles.h"
#include "rpd/rpd.h"
#include "spheres/feature_spheres.h"
#include "spheres/initial_spheres.h"
#include "spheres/power_owners.h"
#include "spheres/shrink.h"

namespace {

using namespace matstruct;

constexpr int kThreads = 2;
constexpr int kRounds = 3;

/// How a moved sphere gets back on the axis.
enum Projection { kNone, kShrink, kQuadricThenShrink, kQuadric };

struct Model {
  Domain domain;
  Options options;
  Spheres spheres;
  VolumeSamples samples;
  std::vector<Vec3> points;
  std::vector<Polyline> lines;
  double area = 0;  // of the sheets, about
};

/// The cell of a sheet sphere is a column about as high as the sphere.
double sheet_area(const Spheres& spheres, const Rpd& rpd) {
  double area = 0;
  for (const RpdCell& cell : rpd.cells)
    if (const SphereSeed& s = spheres.seeds[uz(cell.sphere)]; s.type == SphereType::kSheet && !s.guard)
      area += cell.volume / (2 * s.radius);
  return area;
}

const Model& model(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Model>> models;
  if (const auto found = models.find(name); found != models.end()) return *found->second;
  Context context;
  context.threads = kThreads;
  const auto file = std::filesystem::path(MATSTRUCT_SHARED_DATA) / "tet" / name;
  Options options;
  auto m = std::make_unique<Model>(
      Model{prepare_domain(std::get<TetMesh>(read_model(file)), options, context), options, {}, {}, {}, {}});
  m->spheres = initial_spheres(m->domain, options, context);
  m->samples = volume_samples(m->domain, {target_spacing(m->domain, options)}, context);
  for (const VolumeSample& s : m->samples.samples) m->points.push_back(s.point);
  for (const FeatureLine& line : m->domain.features.lines) m->lines.push_back(points_of_line(m->domain, line));
  RpdEngine engine(m->domain);
  engine.compute(weighted_points(m->spheres), context);
  m->area = sheet_area(m->spheres, engine.diagram());
  return *models.emplace(name, std::move(m)).first->second;
}

/// Standard deviation over mean of the distance of sheet spheres to the nearest other sphere.
double spread(const Spheres& spheres) {
  double n = 0, sum = 0, sum2 = 0;
  for (const SphereSeed& a : spheres.seeds) {
    if (a.type != SphereType::kSheet || a.guard) continue;
    double least2 = 1e300;
    for (const SphereSeed& b : spheres.seeds)
      if (&a != &b && !b.guard) least2 = std::min(least2, distance2(a.center, b.center));
    n += 1, sum += std::sqrt(least2), sum2 += least2;
  }
  return std::sqrt(n * sum2 - sum * sum) / sum;
}

/// The medial sphere that touches where `x` is nearest to the surface; false if shrinking fails.
bool shrink_from(const Domain& domain, const Vec3& x, double smooth, Ball& ball) {
  const SurfaceHit hit = domain.query.closest(x);
  if (!domain.query.inside(x) || hit.distance2 == 0) return false;
  const ShrunkSphere s = shrink_sphere(domain, {hit.point, normalized(hit.point - x), hit.triangle}, smooth);
  if (s.converged) ball = {s.center, s.radius};
  return s.converged;
}

/// One round; adds the distance between particles and projected spheres to `moved`.
struct Round {
  const Model& m;
  Context& context;
  RpdEngine engine;
  std::vector<Index> owners;
  double moved = 0, lost = 0;
  int iterations = 0;

  std::vector<SphereFreedom> freedoms(const Spheres& spheres) {
    const auto weighted = weighted_points(spheres);
    engine.compute(weighted, context);
    update_owners(m.points, weighted, {engine.neighbors().start, engine.neighbors().list}, context, owners);
    const CellContacts contacts = cell_contacts(m.samples, owners, count(weighted), {});
    std::vector<Ball> balls;
    for (const SphereSeed& s : spheres.seeds) balls.push_back({s.center, s.radius});
    return sphere_freedoms(m.samples, contacts, balls, {}, {}, context);
  }

  void particles(Spheres& spheres) {
    const std::vector<SphereFreedom> freedom = freedoms(spheres);
    std::vector<Particle> particles;
    std::vector<Index> ids;
    for (Index s = 0; s < count(spheres.seeds); ++s) {
      const SphereSeed& seed = spheres.seeds[uz(s)];
      if (seed.guard) continue;
      ids.push_back(s);
      Particle p{seed.center};
      if (seed.type == SphereType::kSharpEdge) p.line = seed.line, p.position = seed.position;
      if (seed.type == SphereType::kSheet) p.free = freedom[uz(s)].free, lost += freedom[uz(s)].kind == Freedom::kLost;
      particles.push_back(p);
    }
    const ParticleResult result =
        optimise_particles(particles, m.lines, {.sigma = kernel_width(m.area, count(ids))}, context);
    iterations += result.iterations;
    for (std::size_t k = 0; k < ids.size(); ++k) {
      spheres.seeds[uz(ids[k])].center = result.centers[k];
      spheres.seeds[uz(ids[k])].position = result.positions[k];
    }
  }

  void project(Spheres& spheres, Projection projection) {
    for (SphereSeed& s : spheres.seeds)
      if (s.type == SphereType::kSheet && !s.guard) s.radius = std::max(0.0, -m.domain.query.signed_distance(s.center));
    const bool quadric = projection == kQuadricThenShrink || projection == kQuadric;
    const std::vector<SphereFreedom> freedom = quadric ? freedoms(spheres) : std::vector<SphereFreedom>();
    const double smooth = smooth_angle(m.options);
    std::vector<double> moves(spheres.seeds.size(), 0);
    parallel_for(context, count(spheres.seeds), 32, [&](Index begin, Index end) {
      for (Index k = begin; k < end; ++k) {
        SphereSeed& s = spheres.seeds[uz(k)];
        if (s.type != SphereType::kSheet || s.guard) continue;
        Ball ball{s.center, s.radius};
        if (quadric && m.domain.query.inside(freedom[uz(k)].solution.center)) ball = freedom[uz(k)].solution;
        if (projection == kShrink || projection == kQuadricThenShrink) shrink_from(m.domain, ball.center, smooth, ball);
        moves[uz(k)] = distance(s.center, ball.center);
        s.center = ball.center, s.radius = ball.radius;
      }
    });
    for (const double d : moves) moved += d;
  }
};

/// Mean gap between radius and distance to the second contact of the sheet spheres, in % of the diagonal: 0 on the
/// axis.
double off_axis(const Model& m, const Spheres& spheres) {
  double sum = 0, n = 0;
  for (const SphereSeed& s : spheres.seeds) {
    Ball ball;
    if (s.type != SphereType::kSheet || s.guard || !shrink_from(m.domain, s.center, smooth_angle(m.options), ball))
      continue;
    sum += distance(ball.center, s.center), n += 1;
  }
  return 100 * sum / n / m.domain.diagonal;
}

void rounds(benchmark::State& state, const std::string& name, Projection projection) {
  if (!std::filesystem::exists(std::filesystem::path(MATSTRUCT_SHARED_DATA) / "tet" / name)) {
    state.SkipWithError("no shared models");
    return;
  }
  const Model& m = model(name);
  Context context;
  context.threads = kThreads;
  for (auto _ : state) {
    Spheres spheres = m.spheres;
    Round round{m, context, RpdEngine(m.domain), {}, 0, 0, 0};
    for (int k = 0; k < kRounds; ++k) {
      round.particles(spheres);
      state.PauseTiming();
      if (k + 1 == kRounds) state.counters["cv_particles"] = spread(spheres);
      state.ResumeTiming();
      if (projection != kNone) round.project(spheres, projection);
    }
    state.PauseTiming();
    state.counters["spheres"] = static_cast<double>(m.spheres.seeds.size());
    state.counters["cv_before"] = spread(m.spheres);
    state.counters["cv_after"] = spread(spheres);
    state.counters["off_axis"] = off_axis(m, spheres);
    state.counters["moved"] =
        round.moved / static_cast<double>(m.spheres.seeds.size()) / kRounds / target_spacing(m.domain, m.options);
    state.counters["lost"] = round.lost / kRounds;
    state.counters["iterations"] = static_cast<double>(round.iterations) / kRounds;
    state.ResumeTiming();
  }
}

void sampling(benchmark::State& state, const std::string& name) {
  const Model& m = model(name);
  Context context;
  context.threads = kThreads;
  for (auto _ : state)
    benchmark::DoNotOptimize(volume_samples(m.domain, {target_spacing(m.domain, m.options)}, context));
  state.counters["samples"] = static_cast<double>(m.samples.samples.size());
}

void owners_and_contacts(benchmark::State& state, const std::string& name, bool incremental) {
  const Model& m = model(name);
  Context context;
  context.threads = kThreads;
  const auto weighted = weighted_points(m.spheres);
  RpdEngine engine(m.domain);
  engine.compute(weighted, context);
  std::vector<Index> owners;
  for (auto _ : state) {
    if (!incremental) owners.clear();
    update_owners(m.points, weighted, {engine.neighbors().start, engine.neighbors().list}, context, owners);
    benchmark::DoNotOptimize(cell_contacts(m.samples, owners, count(weighted), {}));
  }
}

const bool registered = [] {
  for (const std::string name : {"angle_block.msh", "plate_holes.msh", "bunny.msh", "fertility.msh"}) {
    const auto add = [&](const std::string& what, auto... function) {
      benchmark::RegisterBenchmark((name + "/" + what).c_str(), function...)
          ->Unit(benchmark::kMillisecond)
          ->Iterations(1);
    };
    add("sampling", sampling, name);
    add("owners", owners_and_contacts, name, false);
    add("rounds/none", rounds, name, kNone);
    add("rounds/shrink", rounds, name, kShrink);
    add("rounds/quadric", rounds, name, kQuadric);
    add("rounds/quadric+shrink", rounds, name, kQuadricThenShrink);
  }
  return true;
}();

}  // namespace
