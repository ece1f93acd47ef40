// Spreads medial spheres evenly: particles that repel each other move within the freedom of their spheres.
//
// Energy (Zhong et al. 2013): E = sum over i, and over j near i, of exp(-|theta_j - theta_i|^2 / (2 sigma^2)). Its
// gradient is projected on each particle's freedom, and L-BFGS minimises it.
#pragma once

#include <span>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "optimise/projector.h"

namespace matstruct {

/// A line on which particles slide: points in order; a closed one repeats its first point at the end.
using Polyline = std::vector<Vec3>;

/// A particle moves in the directions of `free` (none: it stays), or along a line.
struct Particle {
  Vec3 center;
  Projector free = kNoDirection;
  Index line = kInvalid;     ///< slides along this line, `free` is not read; its centre is where `position` says
  double position = 0;       ///< on the line: k + t is at parameter t of its k-th segment
  Index stratum = kInvalid;  ///< sheet, seam or the like; read only if ParticleOptions::bounds is not empty
};

struct ParticleOptions {
  double sigma = 0;  ///< width of the kernel, > 0, see kernel_width()
  /// Each particle feels so many nearest ones, and those that feel it; 0: all within 6 sigma, a smooth energy. In an
  /// even spread 10 is the same; in a crowd it makes jumps at which the minimisation ends early.
  int neighbors = 0;
  double gradient = 5e-3;  ///< stop when the root mean square of a particle's gradient, by sigma, is below
  int max_iterations = 60;
  /// Strata that bound each stratum. If given, a particle feels its own stratum and those that bound it only, and
  /// curves settle before surfaces: particles on lines and those with one direction move first, the others after them,
  /// between curves that stay.
  std::vector<std::vector<Index>> bounds = {};
};

struct ParticleResult {
  std::vector<Vec3> centers;      ///< #particles
  std::vector<double> positions;  ///< #particles; on the line of those that have one
  double energy_before = 0, energy = 0;
  double gradient = 0;  ///< root mean square as in the options; the greater one if there are two passes
  int iterations = 0;
  bool converged = false;  ///< the gradient is below its limit; otherwise the cap or the line search ended it
};

/// sigma = 0.3 sqrt(area / n), where n particles are to spread over a medial mesh of the given area.
double kernel_width(double area, Index n);

/// Moves the particles; order and number stay. Never fails: what was reached is returned. The same for any number of
/// threads. Throws Cancelled when the context was asked to stop.
ParticleResult optimise_particles(std::span<const Particle> particles, std::span<const Polyline> lines,
                                  const ParticleOptions& options, Context& context);

}  // namespace matstruct
