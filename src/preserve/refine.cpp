#include "preserve/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "base/incidence.h"
#include "base/index.h"
#include "base/parallel.h"
#include "base/tolerances.h"
#include "metrics/medial_tree.h"
#include "prepare/edge_heights.h"
#include "preserve/seams.h"
#include "spheres/sheets.h"
#include "spheres/shrink.h"

namespace matstruct {

namespace {

constexpr Index kGrain = 128;
// Spheres of one call keep this share of the spacing from each other, and from the corners of their own simplex.
constexpr double kApart = 0.4;
// A sphere covers its pin if it misses it by less than this share of the allowed deviation.
constexpr double kCovers = 0.5;
// A sheet is missing at a seam if no face there is nearer to its direction than this, radians; its ball stands up to
// so many steps of so many spacings from the seam, and sticks out of it by this share of the allowed deviation: what
// sticks out less burns.
constexpr double kOfSheet = std::numbers::pi / 4;
constexpr int kStepsFromSeam = 4;
constexpr double kStepFromSeam = 0.125;
constexpr double kSticksOut = 0.75;

struct Proposal {
  double deviation = 0;
  TangentSphere sphere;
};

// How far the envelope of the ball at the middle is from the surface there.
double deviation_at(ContactFinder& finder, const Vec3& middle, double radius, const TangentSphere& sphere) {
  double deviation = radius - std::sqrt(finder.domain().query.closest(middle).distance2);
  for (const Contact& c : sphere.contacts)
    deviation = std::max(deviation, std::abs(distance(c.point, middle) - radius));
  return deviation;
}

std::optional<Proposal> propose(ContactFinder& finder, std::span<const TangentSphere* const> corners,
                                const RefineOptions& options) {
  Vec3 middle;
  double radius = 0;
  for (const TangentSphere* c : corners) {
    middle += c->center / static_cast<double>(corners.size());
    radius += c->radius / static_cast<double>(corners.size());
  }
  for (const TangentSphere* c : corners)
    if (distance(c->center, middle) < kApart * options.spacing) return {};
  auto sphere = common_ball(finder, corners, tolerance::kInSheet * options.spacing);
  if (!sphere || !inside(finder, *sphere)) return {};
  const double deviation = deviation_at(finder, middle, radius, *sphere);
  if (deviation <= options.deviation) return {};
  return Proposal{deviation, *std::move(sphere)};
}

// The direction in which the sheet of contacts i and j leaves the seam of three contacts, with their directions given.
Vec3 sheet_direction(const std::array<Vec3, 3>& to_contact, std::size_t i, std::size_t j) {
  const Vec3 &a = to_contact[i], &b = to_contact[j], &other = to_contact[3 - i - j];
  const Vec3 along = cross(a - b, a - other);
  const Vec3 u = normalized(cross(a - b, along));
  return dot(a - other, u) > 0 ? u : -u;
}

double angle_at_seam(const Vec3& place, const TangentSphere& seam, const Vec3& along, const Vec3& way) {
  const Vec3 to = place - seam.center;
  return angle_between(to - along * dot(to, along), way);
}

// The ball of two of the seam's contacts that sticks farthest out of the seam's ball on the way in a direction, or that
// at the end of their sheet, where the two run together.
std::optional<Proposal> beside_seam(ContactFinder& finder, const TangentSphere& seam, const Contacts& two,
                                    const Vec3& way, double smooth_angle, double step) {
  const Domain& domain = finder.domain();
  const double touch = tolerance::kSameDistance * domain.diagonal;
  std::optional<Proposal> farthest;
  bool ended = false;
  for (int k = 1; k <= kStepsFromSeam; ++k) {
    const Vec3 place = seam.center + way * (k * step);
    auto ball = ended ? std::nullopt : tangent_sphere(finder, place, two, step);
    ended = !ball || !is_medial(finder, *ball, touch);
    if (ended) {
      if (!domain.query.inside(place)) break;
      const SurfaceHit hit = domain.query.closest(place);
      const ShrunkSphere end =
          shrink_sphere(domain, {hit.point, normalized(hit.point - place), hit.triangle}, smooth_angle);
      if (!end.converged || distance(end.center, seam.center) > kStepsFromSeam * step) break;
      ball = TangentSphere{end.center, end.radius, {}};
    }
    const double out = distance(ball->center, seam.center) + ball->radius - seam.radius;
    if (!farthest || out > farthest->deviation) farthest = {out, *std::move(ball)};
  }
  return farthest;
}

// Of the sheets at an edge on a seam those without a face there; `apexes`: of the faces.
void propose_beside(ContactFinder& finder, const std::array<const TangentSphere*, 2>& ends,
                    const std::vector<Vec3>& apexes, double smooth_angle, const RefineOptions& options,
                    std::vector<Proposal>& proposals) {
  const auto seam = common_ball(finder, ends, tolerance::kInSheet * options.spacing);
  if (!seam || seam->contacts.size() != 3) return;
  std::array<Vec3, 3> to_contact;
  for (std::size_t k = 0; k < 3; ++k) to_contact[k] = direction(finder.domain(), seam->center, seam->contacts[k]);
  const Vec3 along = normalized(ends[1]->center - ends[0]->center);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const Vec3 way = sheet_direction(to_contact, i, j);
    if (std::any_of(apexes.begin(), apexes.end(),
                    [&](const Vec3& apex) { return angle_at_seam(apex, *seam, along, way) < kOfSheet; }))
      continue;
    auto found = beside_seam(finder, *seam, {seam->contacts[i], seam->contacts[j]}, way, smooth_angle,
                             kStepFromSeam * options.spacing);
    if (found && found->deviation >= kSticksOut * options.deviation &&
        angle_at_seam(found->sphere.center, *seam, along, way) < kOfSheet)
      proposals.push_back(*std::move(found));
  }
}

void sort_worst_first(std::vector<Proposal>& proposals) {
  std::stable_sort(proposals.begin(), proposals.end(),
                   [](const Proposal& a, const Proposal& b) { return a.deviation > b.deviation; });
}

}  // namespace

Edits propose_refinement(FinderPool& finders, const ThinMesh& thin, const std::vector<TangentSphere>& medial,
                         const SeamNetwork& network, const RefineOptions& options, const Context& context) {
  const MedialMesh& mesh = thin.mesh;
  const Index edges = count(mesh.edges), faces = count(mesh.faces);
  std::vector<std::optional<Proposal>> found(uz(edges + faces));
  const auto sphere_of = [&](Index vertex) { return &medial[uz(thin.spheres[uz(vertex)])]; };
  finders.for_each(context, edges + faces, kGrain, [&](ContactFinder& finder, Index k) {
    if (k < edges) {
      const Edge& e = mesh.edges[uz(k)];
      const std::array<const TangentSphere*, 2> ends{sphere_of(e[0]), sphere_of(e[1])};
      if (ends[0]->radius > 0 || ends[1]->radius > 0) found[uz(k)] = propose(finder, ends, options);
    } else {
      const Triangle& f = mesh.faces[uz(k - edges)];
      const std::array<const TangentSphere*, 3> corners{sphere_of(f[0]), sphere_of(f[1]), sphere_of(f[2])};
      found[uz(k)] = propose(finder, corners, options);
    }
  });
  std::vector<Proposal> proposals;
  for (auto& p : found)
    if (p) proposals.push_back(*std::move(p));
  sort_worst_first(proposals);
  Edits edits;
  finders.with_one([&](ContactFinder& finder) {
    for (const Proposal& p : proposals) {
      SphereSeed& seed = edits.insert.emplace_back(SphereSeed{p.sphere.center, p.sphere.radius, SphereType::kSheet});
      if (p.sphere.contacts.size() < 3) continue;
      seed.type = SphereType::kSeam;
      place_on_seam(finder, network, p.sphere, options.spacing, seed);
    }
  });
  return edits;
}

Edits propose_missing_sheets(FinderPool& finders, const ThinMesh& thin, const std::vector<TangentSphere>& medial,
                             double smooth_angle, const RefineOptions& options, const Context& context) {
  const MedialMesh& mesh = thin.mesh;
  const Incidence faces(mesh.edges.size(), edges_of_faces(mesh.edges, mesh.faces));
  std::vector<std::vector<Proposal>> found(mesh.edges.size());
  finders.for_each(context, count(mesh.edges), kGrain, [&](ContactFinder& finder, Index e) {
    if (thin.edge_contacts[uz(e)] != 3 || faces.of(e).size() > 2) return;
    const auto& [a, b] = mesh.edges[uz(e)];
    std::vector<Vec3> apexes;
    for (const Index f : faces.of(e)) {
      const auto& [p, q, r] = mesh.faces[uz(f)];
      apexes.push_back(mesh.centers[uz(p + q + r - a - b)]);
    }
    const std::array<const TangentSphere*, 2> ends{&medial[uz(thin.spheres[uz(a)])], &medial[uz(thin.spheres[uz(b)])]};
    if (ends[0]->radius > 0 && ends[1]->radius > 0)
      propose_beside(finder, ends, apexes, smooth_angle, options, found[uz(e)]);
  });
  std::vector<Proposal> proposals;
  for (auto& at_edge : found)
    for (Proposal& p : at_edge) proposals.push_back(std::move(p));
  sort_worst_first(proposals);
  Edits edits;
  for (const Proposal& p : proposals) edits.insert.push_back({p.sphere.center, p.sphere.radius, SphereType::kSheet});
  return edits;
}

Edits propose_coverage(const Domain& domain, const MedialMesh& mesh, const std::vector<Pin>& pins, double smooth_angle,
                       const RefineOptions& options, const Context& context) {
  const MedialTree tree(mesh.centers, mesh.radii, maximal_primitives(mesh));
  std::vector<std::pair<double, SphereSeed>> found(pins.size());
  parallel_for(context, count(pins), kGrain, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      const double missed = tree.closest(pins[uz(k)].point).distance;
      if (missed <= options.deviation) continue;
      // Spheres between coarse facets of a curved wall would be of none of its sheets.
      if (options.spare_facets && missed <= height_of_facet(domain, pins[uz(k)].triangle, smooth_angle)) continue;
      // A ball that climbs off its pin on a curved wall may miss it as well: then one that stays.
      for (const double angle : {smooth_angle, smooth_angle / 4, 0.0}) {
        const ShrunkSphere s = shrink_sphere(domain, pins[uz(k)], angle);
        if (!s.converged || distance(s.center, pins[uz(k)].point) - s.radius > kCovers * options.deviation) continue;
        found[uz(k)] = {missed, {s.center, s.radius, SphereType::kSheet}};
        break;
      }
    }
  });
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  Edits edits;
  for (const auto& [missed, seed] : found)
    if (missed > 0) edits.insert.push_back(seed);
  return edits;
}

}  // namespace matstruct
