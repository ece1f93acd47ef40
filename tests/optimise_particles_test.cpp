// Particle energy and its minimisation.
#include "optimise/particles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "base/index.h"
#include "base/random.h"
#include "optimise/particle_energy.h"

namespace matstruct {
namespace {

const Context kContext;

Vec3 random_vector(KeyedRandom& random) {
  return {random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
}

/// n x n particles on the unit square in the plane z = 0, shaken by up to `shake` of their distance; those of the
/// border stay in place.
std::vector<Particle> square(int n, double shake, Projector inner = across({0, 0, 1})) {
  std::vector<Particle> particles;
  KeyedRandom random(1, 2, 3);
  const double step = 1.0 / (n - 1);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const bool border = i == 0 || j == 0 || i == n - 1 || j == n - 1;
      const Vec3 shift = border ? Vec3{} : 2 * shake * step * random_vector(random);
      particles.push_back({{i * step + shift.x, j * step + shift.y, 0}, border ? kNoDirection : inner});
    }
  return particles;
}

std::vector<Vec3> centers_of(const std::vector<Particle>& particles) {
  std::vector<Vec3> result;
  for (const Particle& p : particles) result.push_back(p.center);
  return result;
}

/// Standard deviation over mean of the distances to the nearest other particle.
double spread(const std::vector<Vec3>& centers) {
  double sum = 0, sum2 = 0;
  for (std::size_t i = 0; i < centers.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < centers.size(); ++j)
      if (i != j) least = std::min(least, distance(centers[i], centers[j]));
    sum += least, sum2 += least * least;
  }
  const double n = static_cast<double>(centers.size()), mean = sum / n;
  return std::sqrt(sum2 / n - mean * mean) / mean;
}

double greatest_height(const std::vector<Vec3>& centers) {
  double result = 0;
  for (const Vec3& c : centers) result = std::max(result, std::abs(c.z));
  return result;
}

/// Particles of all kinds: in space, in planes, along directions, on an open and a closed line, and at rest.
struct Mixed {
  std::vector<Particle> particles;
  std::vector<Polyline> lines{{{0, 0, 0}, {0.7, 0.1, 0}, {1, 0.5, 0.3}}, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 1}}};

  explicit Mixed(int n) {
    KeyedRandom random(7, 0, 0);
    for (int i = 0; i < n; ++i) {
      Particle p{random_vector(random) + Vec3{0.5, 0.5, 0.5}};
      const Vec3 d = normalized(random_vector(random));
      switch (i % 6) {
        case 0:
          p.free = kAllDirections;
          break;
        case 1:
          p.free = across(d);
          break;
        case 2:
          p.free = along(d);
          break;
        case 3:
          p.line = 0, p.position = 2 * random.uniform();
          break;
        case 4:
          p.line = 1, p.position = 3 * random.uniform();
          break;
        default:
          break;
      }
      p.stratum = i % 4;
      particles.push_back(p);
    }
  }
};

void expect_gradient_matches_differences(const ParticleOptions& options) {
  const Mixed mixed(60);
  std::vector<bool> moves;
  for (int i = 0; i < 60; ++i) moves.push_back(i % 6 != 5);
  ParticleEnergy energy(mixed.particles, mixed.lines, options, moves, kContext);
  std::vector<double> x(uz(energy.coordinates()), 0), gradient(x.size()), ignored(x.size());
  energy.evaluate(x, gradient);
  double greatest = 0;
  for (const double g : gradient) greatest = std::max(greatest, std::abs(g));
  ASSERT_GT(greatest, 0.1);
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double h = 1e-5;
    x[k] = h;
    const double above = energy.evaluate(x, ignored);
    x[k] = -h;
    const double below = energy.evaluate(x, ignored);
    x[k] = 0;
    ASSERT_NEAR(gradient[k], (above - below) / (2 * h), 1e-8) << "coordinate " << k;
  }
}

TEST(ParticleEnergy, GradientMatchesDifferences) {
  expect_gradient_matches_differences({.sigma = 0.1, .neighbors = 10});
  expect_gradient_matches_differences({.sigma = 0.1, .neighbors = 3});
  expect_gradient_matches_differences({.sigma = 0.1});
  expect_gradient_matches_differences({.sigma = 0.1, .bounds = {{1}, {}, {0, 3}, {1, 2}}});
}

TEST(ParticleEnergy, WithoutCapEqualsTheDoubleSum) {
  const Mixed mixed(60);
  ParticleEnergy energy(mixed.particles, {mixed.lines}, {.sigma = 0.1}, std::vector<bool>(60, true), kContext);
  std::vector<double> x(uz(energy.coordinates()), 0), gradient(x.size());
  const double value = energy.evaluate(x, gradient);
  double expected = 0;
  for (std::size_t i = 0; i < 60; ++i)
    for (std::size_t j = 0; j < 60; ++j)
      if (i != j) expected += std::exp(-distance2(energy.centers()[i], energy.centers()[j]) / (2 * 0.01));
  EXPECT_NEAR(value, expected, 1e-6 * expected);
}

TEST(Particles, ShakenGridBecomesEven) {
  const std::vector<Particle> particles = square(21, 0.8);
  Context context;
  const ParticleResult result = optimise_particles(
      particles, {}, {.sigma = kernel_width(1, 21 * 21), .gradient = 1e-4, .max_iterations = 300}, context);
  const double before = spread(centers_of(particles)), after = spread(result.centers);
  RecordProperty("before", std::to_string(before));
  RecordProperty("after", std::to_string(after));
  EXPECT_LT(result.energy, result.energy_before);
  EXPECT_GT(before, 0.3);
  EXPECT_LT(after, 0.15);
}

TEST(Particles, ProjectionKeepsThemInTheirPlane) {
  // A little off the plane to begin with, as rounding would have it.
  std::vector<Particle> particles = square(15, 0.8);
  for (std::size_t i = 0; i < particles.size(); ++i) particles[i].center.z = i % 2 == 0 ? 1e-6 : -1e-6;
  Context context;
  const ParticleOptions options{.sigma = kernel_width(1, 150), .gradient = 1e-4, .max_iterations = 200};
  EXPECT_LE(greatest_height(optimise_particles(particles, {}, options, context).centers), 1e-6);

  for (Particle& p : particles)  // negative control
    if (p.free != kNoDirection) p.free = kAllDirections;
  EXPECT_GT(greatest_height(optimise_particles(particles, {}, options, context).centers), 0.05);
}

TEST(Particles, SlideAlongTheirLine) {
  const int n = 24;
  Polyline circle;
  for (int k = 0; k <= 48; ++k) {
    const double angle = 2 * std::numbers::pi * (k % 48) / 48;
    circle.push_back({std::cos(angle), std::sin(angle), 0});
  }
  const std::vector<Polyline> lines{circle, {{3, 0, 0}, {4, 0, 0}, {4, 1, 0}}};
  std::vector<Particle> particles;
  KeyedRandom random(5, 0, 0);
  for (int k = 0; k < n; ++k)
    particles.push_back({.center = {}, .line = 0, .position = 2 * (k + 0.9 * random.uniform())});
  particles.push_back({.center = {3, 0, 0}});
  for (int k = 1; k < 8; ++k) particles.push_back({.center = {}, .line = 1, .position = 0.1 * k});
  particles.push_back({.center = {4, 1, 0}});
  Context context;
  const double step = 2 * std::numbers::pi / n;  // of a curve, sigma is 0.3 steps
  const ParticleResult result =
      optimise_particles(particles, lines, {.sigma = 0.3 * step, .gradient = 1e-6, .max_iterations = 500}, context);
  for (int k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k), next = static_cast<std::size_t>((k + 1) % n);
    const double position = result.positions[i], rest = position - std::floor(position);
    const auto edge = static_cast<std::size_t>(position);
    EXPECT_NEAR(distance(result.centers[i], lerp(circle[edge], circle[edge + 1], rest)), 0, 1e-14);
    EXPECT_NEAR(distance(result.centers[i], result.centers[next]), step, 0.02 * step);
  }
  for (std::size_t i = n; i < n + 9; ++i) {  // even along the bent line, ends in place
    EXPECT_NEAR(std::min(std::abs(result.centers[i].y), std::abs(result.centers[i].x - 4)), 0, 1e-14);
    if (i > n) {
      EXPECT_NEAR(distance(result.centers[i], result.centers[i - 1]), 0.25, 0.02);
    }
  }
  EXPECT_EQ(result.centers[n], (Vec3{3, 0, 0}));
  EXPECT_EQ(result.centers[n + 8], (Vec3{4, 1, 0}));
}

TEST(ParticleEnergy, ParallelSheetsDoNotPushEachOther) {
  // Two copies of a shaken square, nearer to each other than sigma, the upper one shaken differently.
  const std::vector<Particle> lower = square(11, 0.8);
  std::vector<Particle> both = lower;
  for (const Particle& p : square(11, 0.5)) both.push_back({p.center + Vec3{0, 0, 0.005}, p.free});
  for (std::size_t i = 0; i < both.size(); ++i) both[i].stratum = i < lower.size() ? 0 : 1;
  const auto gradient_of = [](const std::vector<Particle>& particles, const ParticleOptions& options) {
    ParticleEnergy energy(particles, {}, options, std::vector<bool>(particles.size(), true), kContext);
    std::vector<double> x(uz(energy.coordinates()), 0), gradient(x.size());
    energy.evaluate(x, gradient);
    return gradient;
  };
  const ParticleOptions together{.sigma = kernel_width(1, 121)}, apart{.sigma = together.sigma, .bounds = {{}, {}}};
  const std::vector<double> alone = gradient_of(lower, together), with_strata = gradient_of(both, apart);
  const std::vector<double> without = gradient_of(both, together);
  double pushed = 0;  // negative control
  for (std::size_t k = 0; k < alone.size(); ++k) {
    EXPECT_EQ(with_strata[k], alone[k]);
    pushed = std::max(pushed, std::abs(without[k] - alone[k]));
  }
  EXPECT_GT(pushed, 0.1);
}

TEST(Particles, CurvesDoNotFeelTheSurfacesBetweenThem) {
  // A seam y = 0.5 across a crowded sheet: its particles must end where they would without the sheet.
  std::vector<Particle> particles;
  KeyedRandom random(9, 0, 0);
  particles.push_back({.center = {0, 0.5, 0}, .stratum = 1});
  for (int k = 1; k < 10; ++k)
    particles.push_back({{0.1 * k + 0.06 * (random.uniform() - 0.5), 0.5, 0}, along({1, 0, 0}), kInvalid, 0, 1});
  particles.push_back({.center = {1, 0.5, 0}, .stratum = 1});
  std::vector<Particle> seam = particles;
  for (Particle p : square(15, 0.8)) particles.push_back({p.center, p.free, kInvalid, 0, 0});
  Context context;
  ParticleOptions options{.sigma = 0.03, .gradient = 1e-4, .max_iterations = 200, .bounds = {{1}, {}}};
  const ParticleResult result = optimise_particles(particles, {}, options, context);
  const ParticleResult expected = optimise_particles(seam, {}, options, context);
  for (std::size_t i = 0; i < seam.size(); ++i) EXPECT_EQ(result.centers[i], expected.centers[i]);
}

TEST(Particles, SameBitsForAnyNumberOfThreads) {
  const Mixed mixed(3000);
  ParticleResult results[2];
  for (int k = 0; k < 2; ++k) {
    Context context;
    context.threads = k + 1;
    results[k] = optimise_particles(mixed.particles, mixed.lines, {.sigma = 0.03, .max_iterations = 15}, context);
  }
  EXPECT_EQ(results[0].centers, results[1].centers);
  EXPECT_EQ(results[0].positions, results[1].positions);
  EXPECT_EQ(results[0].energy, results[1].energy);
  EXPECT_GT(results[0].iterations, 5);
}

TEST(Particles, NothingToMoveIsNoError) {
  Context context;
  const ParticleResult none = optimise_particles({}, {}, {.sigma = 1}, context);
  EXPECT_TRUE(none.centers.empty());
  EXPECT_TRUE(none.converged);
  const std::vector<Particle> at_rest{{.center = {1, 2, 3}}, {.center = {1, 2, 4}}};
  EXPECT_EQ(optimise_particles(at_rest, {}, {.sigma = 1}, context).centers, centers_of(at_rest));
}

TEST(Particles, CanBeCancelled) {
  const std::vector<Particle> particles = square(15, 0.8);
  std::atomic<bool> stop = true;
  Context context;
  context.stop = &stop;
  EXPECT_ANY_THROW(optimise_particles(particles, {}, {.sigma = kernel_width(1, 225)}, context));
}

}  // namespace
}  // namespace matstruct
