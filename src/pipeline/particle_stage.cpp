// Z. Zhong et al., "Particle-Based Anisotropic Surface Meshing", 2013, in rounds as in section 8 of MATStruct 2025. The
// outer loop counts the spheres at seams and junctions by the contacts of their cells.
#include "pipeline/particle_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "base/tolerances.h"
#include "optimise/freedom.h"
#include "optimise/particles.h"
#include "pipeline/seam_stage.h"
#include "spheres/feature_spheres.h"
#include "spheres/guards.h"
#include "spheres/initial_spheres.h"
#include "spheres/power_owners.h"
#include "spheres/sheets.h"
#include "spheres/shrink.h"

namespace matstruct {

namespace {

constexpr Index kGrain = 32;
// Particles on one line may come as near to each other as this share of the spacing.
constexpr double kClosest = 0.1;
// Contacts of a sphere at a seam or junction.
constexpr Index kSeamOrder = 3;

/// What stays the same in all rounds, and the owners of the samples, which each
/// round starts from.
struct Field {
  VolumeSamples samples;
  std::vector<Vec3> points;  // of the samples
  std::vector<Index> owners;
  std::vector<Polyline> lines;  // feature lines, then curves of the network
  double area = 0;              // of the medial mesh, about
};

std::vector<Polyline> lines_of(const Domain& domain, const SeamNetwork& network) {
  std::vector<Polyline> lines;
  for (const FeatureLine& line : domain.features.lines) lines.push_back(points_of_line(domain, line));
  for (const SeamCurve& curve : network.curves) {
    Polyline& points = lines.emplace_back();
    for (const TangentSphere& s : curve.spheres) points.push_back(s.center);
    if (curve.closed) points.push_back(points.front());
  }
  return lines;
}

// On a sheet, seam or medial curve, where the axis is as wide as the ball is high.
bool has_column(const Spheres& spheres, Index s) {
  const SphereSeed& seed = spheres.seeds[uz(s)];
  return spheres.alive[uz(s)] && !seed.guard && seed.radius > 0;
}

// The cell of a medial sphere is a column about as high as the sphere.
double medial_area(const Spheres& spheres, const Rpd& rpd) {
  double area = 0;
  for (const RpdCell& cell : rpd.cells)
    if (has_column(spheres, cell.sphere)) area += cell.volume / (2 * spheres.seeds[uz(cell.sphere)].radius);
  return area;
}

Field field_of(const Domain& domain, const Options& options, const SeamNetwork& network, const Spheres& spheres,
               const RpdEngine& engine, const Context& context) {
  Field field;
  field.samples = volume_samples(domain, {target_spacing(domain, options), options.seed}, context);
  for (const VolumeSample& s : field.samples.samples) field.points.push_back(s.point);
  field.lines = lines_of(domain, network);
  field.area = medial_area(spheres, engine.diagram());
  return field;
}

CellContacts contacts_of(const Spheres& spheres, const RpdEngine& engine, Field& field, const Context& context) {
  const std::vector<WeightedPoint> weighted = weighted_points(spheres);
  update_owners(field.points, weighted, {engine.neighbors().start, engine.neighbors().list}, context, field.owners);
  return cell_contacts(field.samples, field.owners, count(weighted), {});
}

Index at_seams(const Spheres& spheres, const CellContacts& contacts) {
  Index n = 0;
  for (Index s = 0; s < count(spheres.seeds); ++s)
    if (has_column(spheres, s) && contact_order(contacts, s) >= kSeamOrder) ++n;
  return n;
}

bool on_curve(const SeamNetwork& network, const SphereSeed& seed) {
  return seed.type == SphereType::kSeam && seed.seam != kInvalid && network.curves[uz(seed.seam)].spheres.size() > 1;
}

// In Field::lines; kInvalid for spheres that are on none.
Index line_of(const Domain& domain, const SeamNetwork& network, const SphereSeed& seed) {
  if (seed.type == SphereType::kSharpEdge) return seed.line;
  return on_curve(network, seed) ? count(domain.features.lines) + seed.seam : kInvalid;
}

// Seam spheres between the last and the first sphere of a closed curve may have positions beyond its end.
double on_line(const Polyline& line, double position) {
  const double last = static_cast<double>(line.size() - 1);
  return position < last ? position : line.front() == line.back() ? position - last : last;
}

// Position of the point of a line that is nearest to `x`.
double position_on(const Polyline& line, const Vec3& x) {
  double best = 0, least = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const PrimitiveHit hit = closest_on_triangle(x, line[k], line[k + 1], line[k + 1]);
    if (hit.distance >= least) continue;
    least = hit.distance;
    best = static_cast<double>(k) + 1 - hit.weights[0];
  }
  return best;
}

// Strata of the particles: that of sheets, that of spheres that stay, and one for every line.
constexpr Index kSheets = 0, kPoints = 1, kLines = 2;

// Particles on a line feel only each other and spheres that stay: where two seams run side by side nearer than the
// spacing, those of one would settle between those of the other and part them. Sheets feel everything.
std::vector<std::vector<Index>> bounds_of(std::size_t lines) {
  std::vector<std::vector<Index>> bounds(lines + uz(kLines), {kPoints});
  for (Index stratum = kPoints; stratum < count(bounds); ++stratum) bounds[uz(kSheets)].push_back(stratum);
  return bounds;
}

struct Particles {
  std::vector<Particle> particles;
  std::vector<Index> spheres;  // of each particle
};

Particles particles_of(const Domain& domain, const Options& options, const SeamNetwork& network, const Spheres& spheres,
                       const CellContacts& contacts, const Field& field, const Context& context) {
  std::vector<Ball> balls;
  for (const SphereSeed& s : spheres.seeds) balls.push_back({s.center, s.radius});
  std::vector<SphereFreedom> freedom;
  if (options.gradient_projection) freedom = sphere_freedoms(field.samples, contacts, balls, {}, {}, context);
  Particles result;
  for (Index s = 0; s < count(spheres.seeds); ++s) {
    const SphereSeed& seed = spheres.seeds[uz(s)];
    if (!spheres.alive[uz(s)] || seed.guard) continue;
    Particle p{seed.center, kNoDirection, kInvalid, 0, kPoints};
    if (seed.type == SphereType::kSheet) {
      p.stratum = kSheets;
      p.free = options.gradient_projection ? freedom[uz(s)].free : kAllDirections;
    } else if (const Index line = line_of(domain, network, seed); line != kInvalid) {
      p.stratum = kLines + line;
      const bool slides = options.gradient_projection || seed.type == SphereType::kSharpEdge;
      p.line = slides ? line : kInvalid;
      p.position = on_line(field.lines[uz(line)], seed.position);
      if (!slides) p.free = kAllDirections;
    }
    result.particles.push_back(p);
    result.spheres.push_back(s);
  }
  return result;
}

struct Station {
  double before = 0, after = 0;  // positions
  Vec3 center;                   // afterwards
};

// Whether neighbours on a line have changed places or come nearer than `closest` to each other or to an end. `stations`
// are in order as they were.
bool jumbled(const Polyline& line, const std::vector<Station>& stations, double closest) {
  const bool closed = line.front() == line.back();
  const std::size_t n = stations.size();
  const auto near = [&](const Vec3& a, const Vec3& b) { return distance(a, b) < closest; };
  int descents = 0;
  for (std::size_t k = 0; k + 1 < n + (closed ? 1 : 0); ++k) {
    const Station &a = stations[k], &b = stations[(k + 1) % n];
    if (n > 1 && near(a.center, b.center)) return true;
    if (a.after >= b.after) ++descents;
  }
  if (closed) return descents > 1;
  // A seam that ends freely has a sphere of its own at its end.
  const Station &first = stations.front(), &last = stations.back();
  return descents > 0 || (first.before > 0 && near(line.front(), first.center)) ||
         (last.before < static_cast<double>(line.size() - 1) && near(line.back(), last.center));
}

// A long step of the minimisation may jump over a neighbour, or over the end of a line, where nothing pushes back: all
// particles of such a line go back to where they were.
void restore_jumbled(const Field& field, const Particles& particles, double closest, ParticleResult& moved) {
  std::vector<std::vector<Station>> stations(field.lines.size());
  for (std::size_t k = 0; k < particles.particles.size(); ++k)
    if (const Particle& p = particles.particles[k]; p.line != kInvalid)
      stations[uz(p.line)].push_back({p.position, moved.positions[k], moved.centers[k]});
  std::vector<bool> restore(field.lines.size(), false);
  for (std::size_t l = 0; l < stations.size(); ++l) {
    std::sort(stations[l].begin(), stations[l].end(),
              [](const Station& a, const Station& b) { return a.before < b.before; });
    restore[l] = !stations[l].empty() && jumbled(field.lines[l], stations[l], closest);
  }
  for (std::size_t k = 0; k < particles.particles.size(); ++k)
    if (const Particle& p = particles.particles[k]; p.line != kInvalid && restore[uz(p.line)]) {
      moved.centers[k] = p.center;
      moved.positions[k] = p.position;
    }
}

// The sphere of the seam next to `place`, tangent to all contacts of the seam; as it was if there is none.
void back_on_seam(ContactFinder& finder, const SeamCurve& curve, const Vec3& place, double position, double reach,
                  SphereSeed& seed) {
  if (place == seed.center) return;
  const double touch = tolerance::kSameDistance * finder.domain().diagonal;
  const Contacts contacts = inside_seam(finder, curve, static_cast<std::size_t>(position + 0.5)).contacts;
  if (contacts.size() < static_cast<std::size_t>(kSeamOrder)) return;
  const auto ball = tangent_sphere(finder, place, contacts, reach);
  if (!ball || !is_medial(finder, *ball, touch)) return;
  seed.center = ball->center;
  seed.radius = radius_to_surface(finder.domain(), *ball);
  seed.position = position;
}

// The sphere shrunk from the surface point nearest to `place`; as it was if there is none.
void back_on_sheet(const Domain& domain, const Vec3& place, double smooth_angle, double reach, SphereSeed& seed) {
  const SurfaceHit hit = domain.query.closest(place);
  if (hit.distance2 == 0 || !domain.query.inside(place)) return;
  const ShrunkSphere s = shrink_sphere(domain, {hit.point, normalized(hit.point - place), hit.triangle}, smooth_angle);
  if (!s.converged || distance(s.center, place) > reach) return;
  seed.center = s.center;
  seed.radius = s.radius;
}

void project(const Domain& domain, const Options& options, const SeamNetwork& network, const Field& field,
             const Particles& moved, const ParticleResult& places, FinderPool& finders, Spheres& spheres,
             const Context& context) {
  const double reach = target_spacing(domain, options), smooth = smooth_angle(options);
  const FeatureReach feature_reach(domain, spheres.seeds);
  finders.for_each(context, count(moved.spheres), kGrain, [&](ContactFinder& finder, Index k) {
    SphereSeed& seed = spheres.seeds[uz(moved.spheres[uz(k)])];
    const Particle& particle = moved.particles[uz(k)];
    const Vec3& place = places.centers[uz(k)];
    if (seed.type == SphereType::kSharpEdge) {
      seed.center = place;
      seed.position = places.positions[uz(k)];
      seed.reach = feature_reach.at(place);
    } else if (on_curve(network, seed)) {
      const Polyline& line = field.lines[uz(line_of(domain, network, seed))];
      const double position = particle.line != kInvalid ? places.positions[uz(k)] : position_on(line, place);
      back_on_seam(finder, network.curves[uz(seed.seam)], place, position, reach, seed);
    } else if (seed.type == SphereType::kSheet) {
      back_on_sheet(domain, place, smooth, reach, seed);
    }
  });
}

// Sheet spheres become tangent to their two nearest contacts where they nearly are, as in place_seams(); those that
// crowd a seam go back to where they were: some are there for the sake of topology and must not go.
void fit_to_seams(const Domain& domain, const Options& options, const SeamNetwork& network, const Spheres& before,
                  FinderPool& finders, Spheres& spheres, const Context& context) {
  const double spacing = target_spacing(domain, options);
  const std::vector<TangentSphere> medial = with_contacts(finders, spheres, spacing, context);
  for (Index s = 0; s < count(medial); ++s) {
    SphereSeed& seed = spheres.seeds[uz(s)];
    if (seed.guard || seed.type != SphereType::kSheet) continue;
    seed.center = medial[uz(s)].center;
    seed.radius = medial[uz(s)].radius;
  }
  for (const Index s : crowding_seams(finders, spheres, medial, network, 0, spacing))
    spheres.seeds[uz(s)] = before.seeds[uz(s)];
}

}  // namespace

Report::Particles spread_particles(const Domain& domain, const Options& options, const SeamNetwork& network,
                                   bool mechanical, FinderPool& finders, Spheres& spheres, RpdEngine& engine,
                                   PreserveResult& kept, StageClock& clock, Context& context) {
  Report::Particles result;
  if (options.particle_rounds == 0 || kept.ran_away) return result;
  clock.begin("spreading particles");
  Field field = field_of(domain, options, network, spheres, engine, context);
  if (field.area == 0) return result;
  double sigma = 0;
  for (Index before = 0;;) {
    const CellContacts contacts = contacts_of(spheres, engine, field, context);
    const Index now = at_seams(spheres, contacts);
    result.converged =
        result.rounds > 0 && std::abs(now - before) < options.particle_change * std::max<Index>(1, before);
    if (result.converged || result.rounds == options.particle_rounds) return result;
    before = now;
    const Particles particles = particles_of(domain, options, network, spheres, contacts, field, context);
    if (result.rounds == 0) sigma = kernel_width(field.area, count(particles.spheres));
    ParticleResult moved = optimise_particles(
        particles.particles, field.lines,
        {.sigma = sigma, .gradient = options.particle_gradient, .bounds = bounds_of(field.lines.size())}, context);
    restore_jumbled(field, particles, kClosest * target_spacing(domain, options), moved);
    Spheres last = spheres;
    project(domain, options, network, field, particles, moved, finders, spheres, context);
    if (mechanical) fit_to_seams(domain, options, network, last, finders, spheres, context);
    engine.compute(weighted_points(spheres), dead_ids(spheres), context);

    clock.begin("preserving topology and features");
    PreserveResult next = preserve(domain, options, network, finders, spheres, engine, context);
    clock.begin("spreading particles");
    if (worse(next, kept)) {
      spheres = std::move(last);
      engine.compute(weighted_points(spheres), dead_ids(spheres), context);
      return result;
    }
    next.inserted += kept.inserted;
    kept = next;
    ++result.rounds;
  }
}

}  // namespace matstruct
