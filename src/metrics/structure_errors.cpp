// Medial structure error ratio (MSER) and spikes, after "MATStruct", SIGGRAPH Asia 2025. A sphere's first contact is
// the nearest surface point; the second is found by shifting the centre away from the first. Contacts are the same if
// the surface joins them within the ball, without a convex-sharp edge between (docs/design/metrics.md).
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <matstruct/error.h>
#include <matstruct/metrics.h>
#include <matstruct/strata.h>

#include "base/incidence.h"
#include "base/index.h"
#include "base/parallel.h"
#include "base/tolerances.h"
#include "geometry/primitives.h"
#include "metrics/sampling.h"
#include "metrics/surface_patches.h"
#include "query/surface_query.h"

namespace matstruct {

namespace {

constexpr Index kGrain = 64;

enum class Claim : std::uint8_t { kNothing, kSheet, kSeam, kJunction };

/// `smallest`: spheres not larger than this claim nothing.
std::vector<Claim> claims_of(const MedialMesh& mesh, const Incidence& around, bool by_types, double smallest) {
  std::vector<Claim> claims(mesh.centers.size(), Claim::kNothing);
  for (Index v = 0; v < count(mesh.centers); ++v)
    if (!around.of(v).empty()) claims[uz(v)] = Claim::kSheet;
  if (by_types) {
    for (Index v = 0; v < count(mesh.centers); ++v) {
      if (mesh.types[uz(v)] == SphereType::kSeam) claims[uz(v)] = Claim::kSeam;
      if (mesh.types[uz(v)] == SphereType::kJunction) claims[uz(v)] = Claim::kJunction;
    }
  } else {
    const Strata strata = trace_strata(mesh);
    for (const Curve& seam : strata.seams)
      for (const Index v : seam.vertices) claims[uz(v)] = Claim::kSeam;
    for (const Index v : strata.junctions) claims[uz(v)] = Claim::kJunction;
  }
  for (Index v = 0; v < count(mesh.centers); ++v)
    if (!(mesh.radii[uz(v)] > smallest)) claims[uz(v)] = Claim::kNothing;
  return claims;
}

struct Contact {
  Vec3 point;
  Index triangle = kInvalid;
};

struct Tangents {
  Contact first, second;  ///< the second's triangle is kInvalid if there is none
  bool turned = false;    ///< the nearest point turned by a wide angle, though the surface joins it to the first
  bool is_spike() const { return second.triangle == kInvalid && !turned; }
};

class ContactFinder {
 public:
  ContactFinder(const SurfaceQuery& query, const SurfacePatches& patches, double convex_angle)
      : query_(query), walk_(patches), growth_(1 / std::cos(convex_angle / 2 * std::numbers::pi / 180)) {}

  Tangents tangents(const Ball& ball) {
    Tangents result;
    const SurfaceHit nearest = query_.closest(ball.center);
    result.first = {nearest.point, nearest.triangle};
    const Vec3 away = normalized(ball.center - nearest.point) * (tolerance::kContactShift * ball.radius);
    for (int step = 1; step <= tolerance::kContactShifts; ++step) {
      const Contact contact = shifted_contact(ball.center, away * step, nearest.triangle);
      if (contact.triangle == nearest.triangle) continue;
      if (are_distinct(ball.center, result.first, contact)) {
        result.second = first_to_appear(ball.center, away, step, result.first, contact);
        return result;
      }
      const Vec3 shifted = ball.center + away * step;
      const double turn = angle_between(nearest.point - shifted, contact.point - shifted) * 180 / std::numbers::pi;
      result.turned = result.turned || turn >= tolerance::kContactTurn;
    }
    return result;
  }

  /// Number of contacts around `center` that balls nearby have together.
  Index distinct(const Vec3& center, const std::vector<Ball>& nearby) {
    std::vector<Index> triangles;
    double radius = 0;
    for (const Ball& ball : nearby) {
      const Tangents t = tangents(ball);
      for (const Contact& contact : {t.first, t.second}) {
        if (contact.triangle == kInvalid) continue;
        triangles.push_back(contact.triangle);
        radius = std::max(radius, reach(center, contact.point));
      }
    }
    return walk_.pieces(center, radius, triangles);
  }

 private:
  Contact shifted_contact(const Vec3& center, const Vec3& shift, Index guess) const {
    const SurfaceHit hit = query_.closest_near(center + shift, guess);
    return {hit.point, hit.triangle};
  }
  bool are_distinct(const Vec3& center, const Contact& a, const Contact& b) {
    return a.triangle != b.triangle && !walk_.joined(center, reach(center, b.point), a.triangle, b.triangle);
  }
  /// Of the contacts that appear within the last of `steps` shifts the first: near a seam others follow at once.
  Contact first_to_appear(const Vec3& center, const Vec3& away, int steps, const Contact& first, Contact second) {
    double low = steps - 1, high = steps;
    for (int k = 0; k < tolerance::kContactHalvings; ++k) {
      const double middle = (low + high) / 2;
      const Contact contact = shifted_contact(center, away * middle, second.triangle);
      if (are_distinct(center, first, contact))
        high = middle, second = contact;
      else
        low = middle;
    }
    return second;
  }

  /// Radius of a ball that reaches a contact and, where it touches two facets of one smooth patch, their common edge:
  /// that is farther away by at most 1 / cos(half the angle between them).
  double reach(const Vec3& center, const Vec3& contact) const { return distance(center, contact) * growth_; }

  const SurfaceQuery& query_;
  PatchWalk walk_;
  double growth_;
};

/// The spheres of a mesh's sheets next to a vertex or to a place on an edge, after subdivision where it is coarse.
class Neighbourhood {
 public:
  Neighbourhood(const MedialMesh& mesh, const Incidence& around, const std::vector<Claim>& claims)
      : mesh_(mesh), around_(around), claims_(claims) {}

  /// In each face the sheet spheres among its other corners, else one added in its middle.
  std::vector<Ball> of_vertex(Index v) const {
    double reach = tolerance::kNeighbourReach * ball(v).radius;
    if (claims_[uz(v)] == Claim::kSeam)
      for (const Index w : seam_ends(v))
        reach = std::min(reach, reach_beside(v, distance(ball(v).center, ball(w).center)));
    std::vector<Ball> balls;
    for (const Index f : around_.of(v)) {
      const auto [w, x] = opposite(f, v);
      if (claims_[uz(w)] == Claim::kSheet) balls.push_back(towards(ball(v), ball(w), 1, reach));
      if (claims_[uz(x)] == Claim::kSheet) balls.push_back(towards(ball(v), ball(x), 1, reach));
      if (claims_[uz(w)] != Claim::kSheet && claims_[uz(x)] != Claim::kSheet)
        balls.push_back(towards(ball(v), between(ball(w), ball(x), 0.5), 0.5, reach));
    }
    return balls;
  }

  /// A sphere added on the edge from `v` to `w`, and those added in its faces.
  struct OnEdge {
    Ball place;
    std::vector<Ball> balls;
  };
  OnEdge of_edge(Index v, Index w) const {
    OnEdge result{towards(ball(v), ball(w), 0.5, tolerance::kNeighbourReach * ball(v).radius), {}};
    const double near = reach_beside(v, distance(ball(v).center, result.place.center));
    for (const Index f : around_.of(v)) {
      const auto [x, y] = opposite(f, v);
      if (x == w || y == w) result.balls.push_back(towards(result.place, ball(x == w ? y : x), 0.5, near));
    }
    return result;
  }

  /// The other ends of edges at `v` with at least three faces, ascending.
  std::vector<Index> seam_ends(Index v) const {
    std::vector<Index> ends;
    for (const Index f : around_.of(v))
      for (const Index w : opposite(f, v)) ends.push_back(w);
    std::sort(ends.begin(), ends.end());
    std::vector<Index> result;
    for (std::size_t k = 2; k < ends.size(); ++k)
      if (ends[k] == ends[k - 2] && (result.empty() || result.back() != ends[k])) result.push_back(ends[k]);
    return result;
  }

 private:
  Ball ball(Index v) const { return {mesh_.centers[uz(v)], mesh_.radii[uz(v)]}; }
  Edge opposite(Index f, Index v) const {
    const auto& [a, b, c] = mesh_.faces[uz(f)];
    return a == v ? Edge{b, c} : (b == v ? Edge{a, c} : Edge{a, b});
  }
  static Ball between(const Ball& a, const Ball& b, double t) {
    return {lerp(a.center, b.center, t), a.radius + (b.radius - a.radius) * t};
  }
  /// How far to look from a seam for contacts where it ends after a `length`: beyond are those of what it ends at.
  double reach_beside(Index v, double length) const {
    const double radius = ball(v).radius;
    return std::clamp(length, tolerance::kLeastReach * radius, tolerance::kNeighbourReach * radius);
  }
  /// The part `most` of the way from one ball to another, or less if that is farther than `reach`.
  static Ball towards(const Ball& from, const Ball& to, double most, double reach) {
    const double length = distance(from.center, to.center);
    return between(from, to, most * length > reach ? reach / length : most);
  }

  const MedialMesh& mesh_;
  const Incidence& around_;
  const std::vector<Claim>& claims_;
};

/// Contacts of the seam half-way from `v` to its next sphere.
Index contacts_on_edge(Index v, Index next, const Neighbourhood& neighbourhood, ContactFinder& finder) {
  const auto [place, balls] = neighbourhood.of_edge(v, next);
  return finder.distinct(place.center, balls);
}

/// Contacts of a seam sphere. Where the seam ends freely, two contacts run together (a fin point, A1A3 of Giblin and
/// Kimia 2004): the seam is judged half-way to its next sphere.
Index contacts_of_seam(const MedialMesh& mesh, Index v, const Neighbourhood& neighbourhood, ContactFinder& finder) {
  const std::vector<Index> ends = neighbourhood.seam_ends(v);
  if (ends.size() != 1) return finder.distinct(mesh.centers[uz(v)], neighbourhood.of_vertex(v));
  return contacts_on_edge(v, ends[0], neighbourhood, finder);
}

/// The greatest number of contacts of the seams that end at a junction: of the next sphere of each, or of a place near.
Index contacts_of_seams(Index junction, const std::vector<Claim>& claims, const std::vector<Index>& contacts,
                        const Neighbourhood& neighbourhood, ContactFinder& finder) {
  Index most = 0;
  for (const Index w : neighbourhood.seam_ends(junction))
    most = std::max(
        most, claims[uz(w)] == Claim::kSeam ? contacts[uz(w)] : contacts_on_edge(junction, w, neighbourhood, finder));
  return most;
}

double share(Index part, Index all) {
  return all > 0 ? static_cast<double>(part) / all : 0;
}

}  // namespace

double StructureErrors::mser() const {
  return share(seam_spheres_wrong + junction_spheres_wrong, seam_spheres + junction_spheres);
}

double StructureErrors::spike_share() const {
  return share(spikes, sheet_spheres);
}

StructureErrors structure_errors(const MedialMesh& mesh, const TriSurface& surface, double convex_angle,
                                 Context& context) {
  if (surface.triangles.empty()) throw Error("the surface has no triangles: there are no contacts to find.");
  StructureErrors result;
  result.told_by_types = std::any_of(mesh.types.begin(), mesh.types.end(), [](SphereType type) {
    return type == SphereType::kSeam || type == SphereType::kJunction;
  });
  const Incidence around(mesh.centers.size(), mesh.faces);
  const std::vector<Claim> claims =
      claims_of(mesh, around, result.told_by_types, tolerance::kSmallestRadius * diagonal_of(surface));

  const SurfaceQuery query(surface);
  const SurfacePatches patches(surface, convex_angle);
  const Neighbourhood neighbourhood(mesh, around, claims);
  const auto for_claims = [&](const std::function<void(Index, ContactFinder&)>& check) {
    parallel_for(context, count(claims), kGrain, [&](Index begin, Index end) {
      ContactFinder finder(query, patches, convex_angle);
      for (Index v = begin; v < end; ++v) check(v, finder);
    });
  };
  std::vector<Index> contacts(claims.size(), 0);
  std::vector<char> wrong(claims.size(), 0);
  for_claims([&](Index v, ContactFinder& finder) {
    if (claims[uz(v)] == Claim::kSheet)
      wrong[uz(v)] = finder.tangents({mesh.centers[uz(v)], mesh.radii[uz(v)]}).is_spike();
    if (claims[uz(v)] == Claim::kJunction)
      contacts[uz(v)] = finder.distinct(mesh.centers[uz(v)], neighbourhood.of_vertex(v));
    if (claims[uz(v)] == Claim::kSeam) {
      contacts[uz(v)] = contacts_of_seam(mesh, v, neighbourhood, finder);
      wrong[uz(v)] = contacts[uz(v)] < 3;
    }
  });
  for_claims([&](Index v, ContactFinder& finder) {
    if (claims[uz(v)] == Claim::kJunction)
      wrong[uz(v)] =
          contacts[uz(v)] < 4 || contacts_of_seams(v, claims, contacts, neighbourhood, finder) >= contacts[uz(v)];
  });
  for (std::size_t v = 0; v < claims.size(); ++v) {
    if (claims[v] == Claim::kSheet) ++result.sheet_spheres, result.spikes += wrong[v];
    if (claims[v] == Claim::kSeam) ++result.seam_spheres, result.seam_spheres_wrong += wrong[v];
    if (claims[v] == Claim::kJunction) ++result.junction_spheres, result.junction_spheres_wrong += wrong[v];
    if (wrong[v]) result.wrong.push_back(static_cast<Index>(v));
  }
  return result;
}

}  // namespace matstruct
