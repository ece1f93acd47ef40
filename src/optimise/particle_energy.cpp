// Z. Zhong et al., "Particle-Based Anisotropic Surface Meshing", 2013: Gaussian energy of particles.
//
// Neighbours are kept in a list with a margin (L. Verlet 1967) and found anew only when a particle has used up its half
// of it. Between two such moments the energy is a smooth function with the very gradient computed here, as L-BFGS
// needs: who feels whom is fixed, and both of a pair get the force.
#include "optimise/particle_energy.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/parallel.h"
#include "spheres/point_grid.h"

namespace matstruct {

namespace {

// Beyond this many sigmas the kernel is below 2e-8. An even spread has neighbours at 3.3 sigmas and the next at 5.7.
constexpr double kCutoff = 6;
// Margin of the neighbour list in sigmas.
constexpr double kMargin = 2;
constexpr Index kGrain = 128;

}  // namespace

ParticleEnergy::ParticleEnergy(std::span<const Particle> particles, std::span<const Polyline> lines,
                               const ParticleOptions& options, const std::vector<bool>& moves, const Context& context)
    : particles_(particles), lines_(lines), options_(options), context_(context), moves_(moves) {
  for (const Polyline& line : lines) {
    Line arcs{{0}, line.front() == line.back()};
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
      arcs.arc.push_back(arcs.arc.back() + distance(line[k], line[k + 1]));
    arcs_.push_back(std::move(arcs));
  }
  for (Index i = 0; i < count(particles); ++i) {
    const Particle& p = particles[uz(i)];
    first_.push_back(moves[uz(i)] ? coordinates_ : kInvalid);
    if (moves[uz(i)]) coordinates_ += p.line == kInvalid ? 3 : 1, ++movers_;
    centers_.push_back(p.center);
    positions_.push_back(p.position);
    tangents_.push_back({});
    if (p.line != kInvalid) slide(i, 0);
  }
  energies_.resize(particles.size());
  find_neighbors();
}

/// Puts a particle on its line, `step` (arc length) from where it began.
void ParticleEnergy::slide(Index particle, double step) {
  const Particle& p = particles_[uz(particle)];
  const Polyline& points = lines_[uz(p.line)];
  const auto& [arc, closed] = arcs_[uz(p.line)];
  const auto segment = std::min(static_cast<std::size_t>(p.position), arc.size() - 2);
  const double begin = arc[segment] + (p.position - static_cast<double>(segment)) * (arc[segment + 1] - arc[segment]);
  double s = begin + step;
  if (closed) s -= arc.back() * std::floor(s / arc.back());
  const bool stopped = !closed && (s < 0 || s > arc.back());
  s = std::clamp(s, 0.0, arc.back());
  const auto above = std::upper_bound(arc.begin() + 1, arc.end() - 1, s);
  const auto k = static_cast<std::size_t>(above - arc.begin()) - 1;
  const double length = arc[k + 1] - arc[k], t = length > 0 ? (s - arc[k]) / length : 0;
  centers_[uz(particle)] = lerp(points[k], points[k + 1], t);
  positions_[uz(particle)] = static_cast<double>(k) + t;
  tangents_[uz(particle)] = stopped ? Vec3{} : normalized(points[k + 1] - points[k]);
}

void ParticleEnergy::place(std::span<const double> x) {
  parallel_for(context_, count(particles_), kGrain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      if (first_[uz(i)] == kInvalid) continue;
      const Particle& p = particles_[uz(i)];
      const double* u = x.data() + first_[uz(i)];
      if (p.line != kInvalid)
        slide(i, options_.sigma * u[0]);
      else
        centers_[uz(i)] = p.center + options_.sigma * project(p.free, {u[0], u[1], u[2]});
    }
  });
}

bool ParticleEnergy::neighbors_are_stale() const {
  const double half = kMargin * options_.sigma / 2;
  for (std::size_t i = 0; i < centers_.size(); ++i)
    if (distance2(centers_[i], listed_[i]) > half * half) return true;
  return false;
}

bool ParticleEnergy::feels(Index a, Index b) const {
  if (options_.bounds.empty()) return true;
  const Index from = particles_[uz(a)].stratum, to = particles_[uz(b)].stratum;
  if (from == kInvalid || to == kInvalid) return false;
  const std::vector<Index>& bounds = options_.bounds[uz(from)];
  return from == to || std::find(bounds.begin(), bounds.end(), to) != bounds.end();
}

/// Of the particles `near` a those that it feels, sorted; the nearest ones if there are too many.
std::vector<Index> ParticleEnergy::nearest_felt(Index a, const std::vector<Index>& near) const {
  std::vector<std::pair<double, Index>> found;
  for (const Index b : near)
    if (b != a && feels(a, b)) found.emplace_back(distance2(centers_[uz(a)], centers_[uz(b)]), b);
  std::sort(found.begin(), found.end());
  if (options_.neighbors > 0 && count(found) > options_.neighbors)
    found.resize(static_cast<std::size_t>(options_.neighbors));
  std::vector<Index> result;
  for (const auto& [d2, b] : found) result.push_back(b);
  std::sort(result.begin(), result.end());
  return result;
}

void ParticleEnergy::find_neighbors() {
  listed_ = centers_;
  const double reach = (kCutoff + kMargin) * options_.sigma;
  const PointGrid grid(listed_, reach);
  const Index n = count(particles_);
  std::vector<std::vector<Index>> felt(uz(n));
  parallel_for(context_, n, kGrain, [&](Index begin, Index end) {
    std::vector<Index> near;
    for (Index a = begin; a < end; ++a) {
      near.clear();
      grid.for_each_near(listed_[uz(a)], reach, [&](Index b) { near.push_back(b); });
      felt[uz(a)] = nearest_felt(a, near);
    }
  });
  std::vector<std::vector<Neighbor>> rows(uz(n));
  for (Index a = 0; a < n; ++a)
    for (const Index b : felt[uz(a)]) {
      const bool both = std::binary_search(felt[uz(b)].begin(), felt[uz(b)].end(), a);
      if (both && a > b) continue;
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
        if (moves_[uz(to)] || feels(from, to)) rows[uz(from)].push_back({to, both ? 2.0 : 1.0});
    }
  start_.assign(1, 0);
  list_.clear();
  for (const auto& row : rows) {
    list_.insert(list_.end(), row.begin(), row.end());
    start_.push_back(count(list_));
  }
}

double ParticleEnergy::evaluate(std::span<const double> x, std::span<double> gradient) {
  place(x);
  if (neighbors_are_stale()) find_neighbors();
  const double per_sigma2 = 1 / (options_.sigma * options_.sigma), cutoff2 = kCutoff * kCutoff;
  parallel_for(context_, count(particles_), kGrain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Index first = first_[uz(i)];
      energies_[uz(i)] = 0;
      if (first == kInvalid) continue;
      Vec3 slope;
      for (Index k = start_[uz(i)]; k < start_[uz(i) + 1]; ++k) {
        const auto& [j, factor] = list_[uz(k)];
        const Vec3 apart = centers_[uz(i)] - centers_[uz(j)];
        const double d2 = norm2(apart) * per_sigma2;
        if (d2 > cutoff2) continue;
        const double e = factor * std::exp(-0.5 * d2);
        energies_[uz(i)] += first_[uz(j)] == kInvalid ? e : e / 2;  // a pair of two that move has a half with each
        slope -= apart * (e / options_.sigma);
      }
      double* g = gradient.data() + first;
      if (particles_[uz(i)].line != kInvalid) {
        g[0] = dot(slope, tangents_[uz(i)]);
      } else {
        const Vec3 free = project(particles_[uz(i)].free, slope);
        g[0] = free.x, g[1] = free.y, g[2] = free.z;
      }
    }
  });
  double energy = 0;
  for (const double e : energies_) energy += e;
  return energy;
}

}  // namespace matstruct
