// Value and gradient of the particle energy over the coordinates of the particles that move. Internal to particles.h.
#pragma once

#include <span>
#include <vector>

#include <matstruct/context.h>

#include "optimise/particles.h"

namespace matstruct {

/// Coordinates are displacements in units of sigma: three of a free particle, of which only the part in its free
/// directions counts, and one, arc length, of a particle on a line.
class ParticleEnergy {
 public:
  /// `moves` tells the particles that move; energy between two that stay is left out. Keeps references to particles,
  /// lines and context, which are as for optimise_particles().
  ParticleEnergy(std::span<const Particle> particles, std::span<const Polyline> lines, const ParticleOptions& options,
                 const std::vector<bool>& moves, const Context& context);

  Index coordinates() const { return coordinates_; }
  Index movers() const { return movers_; }
  /// Energy and its gradient at coordinates x (both of length coordinates()). The neighbours of a particle are found
  /// anew when particles have moved so far that others may have come into reach.
  double evaluate(std::span<const double> x, std::span<double> gradient);
  /// Places of all particles, and their positions on lines, at the coordinates of the last evaluation.
  const std::vector<Vec3>& centers() const { return centers_; }
  const std::vector<double>& positions() const { return positions_; }

 private:
  struct Line {
    std::vector<double> arc;  // length up to each point
    bool closed = false;
  };
  struct Neighbor {
    Index particle = kInvalid;
    double factor = 0;  // 1 if one of the two feels the other, 2 if both do
  };
  void place(std::span<const double> x);
  void slide(Index particle, double step);
  void find_neighbors();
  bool neighbors_are_stale() const;
  bool feels(Index a, Index b) const;
  std::vector<Index> nearest_felt(Index a, const std::vector<Index>& near) const;

  std::span<const Particle> particles_;
  std::span<const Polyline> lines_;
  ParticleOptions options_;
  const Context& context_;
  std::vector<Line> arcs_;
  std::vector<bool> moves_;
  std::vector<Index> first_;  // coordinate of each particle that moves, else kInvalid
  Index coordinates_ = 0, movers_ = 0;
  std::vector<Vec3> centers_, tangents_;  // tangents of particles on lines, zero where they are stopped at an end
  std::vector<double> positions_;
  std::vector<Vec3> listed_;  // centers when neighbours were found
  std::vector<Index> start_;
  std::vector<Neighbor> list_;
  std::vector<double> energies_;  // per particle
};

}  // namespace matstruct
