// The minimisation: liblbfgs (N. Okazaki's C port of J. Nocedal's L-BFGS).
#include "optimise/particles.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>

#include <lbfgs.h>

#include "base/index.h"
#include "optimise/particle_energy.h"

namespace matstruct {

namespace {

// Memory of L-BFGS, and evaluations that a line search may take.
constexpr int kMemory = 8, kLineSearch = 20;

bool is_curve(const Particle& p) {
  return p.line != kInvalid || p.free[0] + p.free[4] + p.free[8] < 1.5;  // trace: number of free directions
}

bool can_move(const Particle& p) {
  return p.line != kInvalid || p.free != kNoDirection;
}

/// What the callbacks of liblbfgs, which are C, need; exceptions must not pass through it.
struct Run {
  ParticleEnergy& energy;
  const ParticleOptions& options;
  Context& context;
  double gradient = 0;
  bool converged = false;
  int iterations = 0;
  std::exception_ptr error = nullptr;
};

lbfgsfloatval_t on_evaluate(void* instance, const lbfgsfloatval_t* x, lbfgsfloatval_t* g, const int n,
                            const lbfgsfloatval_t /*step*/) {
  Run& run = *static_cast<Run*>(instance);
  const auto size = static_cast<std::size_t>(n);
  std::fill(g, g + n, 0.0);
  if (run.error) return 0;
  try {
    return run.energy.evaluate({x, size}, {g, size});
  } catch (...) {
    run.error = std::current_exception();
    return 0;
  }
}

double mean_gradient(double norm, const ParticleEnergy& energy) {
  return norm / std::sqrt(static_cast<double>(energy.movers()));
}

int on_progress(void* instance, const lbfgsfloatval_t* /*x*/, const lbfgsfloatval_t* /*g*/,
                const lbfgsfloatval_t /*fx*/, const lbfgsfloatval_t /*xnorm*/, const lbfgsfloatval_t gnorm,
                const lbfgsfloatval_t /*step*/, int /*n*/, int iteration, int /*evaluations*/) {
  Run& run = *static_cast<Run*>(instance);
  run.gradient = mean_gradient(gnorm, run.energy);
  run.converged = run.gradient < run.options.gradient;
  run.iterations = iteration;
  return run.converged || run.error ? 1 : 0;
}

struct Free {
  void operator()(lbfgsfloatval_t* x) const { lbfgs_free(x); }
};

/// Moves those that `moves` says and puts them where they end.
void minimise(std::vector<Particle>& particles, std::span<const Polyline> lines, const ParticleOptions& options,
              const std::vector<bool>& moves, Context& context, ParticleResult& result) {
  ParticleEnergy energy(particles, lines, options, moves, context);
  if (energy.movers() == 0) return;
  const auto size = static_cast<std::size_t>(energy.coordinates());
  const std::unique_ptr<lbfgsfloatval_t, Free> x(lbfgs_malloc(energy.coordinates()));
  std::fill_n(x.get(), size, 0.0);
  std::vector<double> gradient(size);
  const double before = energy.evaluate({x.get(), size}, gradient);
  double norm2 = 0;
  for (const double g : gradient) norm2 += g * g;

  Run run{energy, options, context, mean_gradient(std::sqrt(norm2), energy)};
  run.converged = run.gradient < options.gradient;
  if (!run.converged && options.max_iterations > 0) {
    lbfgs_parameter_t parameters;
    lbfgs_parameter_init(&parameters);
    parameters.m = kMemory;
    parameters.epsilon = 0;  // on_progress() decides
    parameters.max_iterations = options.max_iterations;
    parameters.max_linesearch = kLineSearch;
    lbfgs(energy.coordinates(), x.get(), nullptr, on_evaluate, on_progress, &run, &parameters);
    if (run.error) std::rethrow_exception(run.error);
  }
  // The line search may have ended on a trial; x is the best point.
  result.energy_before += before;
  result.energy += energy.evaluate({x.get(), size}, gradient);
  result.gradient = std::max(result.gradient, run.gradient);
  result.iterations += run.iterations;
  result.converged = result.converged && run.converged;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles[i].center = energy.centers()[i];
    particles[i].position = energy.positions()[i];
  }
}

}  // namespace

double kernel_width(double area, Index n) {
  return 0.3 * std::sqrt(area / n);
}

ParticleResult optimise_particles(std::span<const Particle> particles, std::span<const Polyline> lines,
                                  const ParticleOptions& options, Context& context) {
  std::vector<Particle> moved(particles.begin(), particles.end());
  ParticleResult result;
  result.converged = true;
  const bool in_order = !options.bounds.empty();
  for (int pass = 0; pass < (in_order ? 2 : 1); ++pass) {
    std::vector<bool> moves;
    for (const Particle& p : moved) moves.push_back(can_move(p) && (!in_order || is_curve(p) == (pass == 0)));
    minimise(moved, lines, options, moves, context, result);
  }
  for (const Particle& p : moved) {
    result.centers.push_back(p.center);
    result.positions.push_back(p.position);
  }
  return result;
}

}  // namespace matstruct
