// The section of a face across one of its edges is followed from facet to facet. In a section of even curvature the
// facets' angles lie on a straight line over the places of their middles; its value at the edge is what is looked for.
// On a regular tessellation this adds half of the turn to the next strip of facets.
#include "query/face_angle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/index.h"
#include "geometry/exact.h"

namespace matstruct {

double dihedral_angle(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                      const std::vector<Vec3>& normals, Index triangle, std::size_t local) {
  const auto point = [&](Index v) -> const Vec3& { return surface.vertices[uz(v)]; };
  const Triangle& near = surface.triangles[uz(triangle)];
  const Index other = neighbors[uz(triangle)][local];
  const Index a = near[(local + 1) % 3], b = near[(local + 2) % 3];
  const Triangle& far = surface.triangles[uz(other)];
  const Index apex = far[0] + far[1] + far[2] - a - b;
  const int side = orientation(point(near[0]), point(near[1]), point(near[2]), point(apex));
  const double turn = angle_between(normals[uz(triangle)], normals[uz(other)]);
  constexpr double kLeast = std::numeric_limits<double>::epsilon();  // a fold so sharp that its angle rounds to zero
  if (side < 0) return std::max(std::numbers::pi - turn, kLeast);
  if (side > 0) return std::min(std::numbers::pi + turn, 2 * std::numbers::pi * (1 - kLeast));
  return std::numbers::pi;
}

namespace {

// How far facets are looked at, in heights of the first facet above the edge, and how far at least.
constexpr double kFarthest = 3.5, kNearest = 1.5;
constexpr std::size_t kMostFacets = 32;
// Facets turn evenly if their angles are off a straight line by no more than this share of their whole turn.
constexpr double kEven = 0.06;
// Accuracy of the estimate: a share of what it adds.
constexpr double kAccuracy = 0.05;
// Facets that turn by less than this share of the limit belong to one face: a sharp edge would have most of its turn
// between them and the facets behind.
constexpr double kFaint = 0.25;
// An edge stands out if the next ones turn by less than this share of it.
constexpr double kNextTurn = 0.5;
// A way through a facet that is this near to the direction of a side (sine) does not leave by it.
constexpr double kAlong = 1e-12;

/// Middle of a facet in the direction of the section, measured from the edge, the turn up to there, and where the way
/// leaves the facet.
struct Station {
  double place = 0, turn = 0, end = 0;
};

class Section {
 public:
  Section(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
          const std::vector<Vec3>& normals, double smooth)
      : surface_(surface), neighbors_(neighbors), normals_(normals), smooth_(smooth) {}

  // What a face turns from the middle of a facet on up to the facet's edge: positive in a hollow face, negative in one
  // that bulges.
  double turn_at_edge(Index triangle, std::size_t local) const {
    const double height = height_of(triangle, local);
    const std::vector<Station> stations = follow(triangle, local, kFarthest * height);
    if (!(stations.back().place - stations.front().place > kNearest * height)) return 0;
    Station mean;
    for (const Station& s : stations) {
      mean.place += s.place / static_cast<double>(stations.size());
      mean.turn += s.turn / static_cast<double>(stations.size());
    }
    double spread = 0, moment = 0;
    for (const Station& s : stations) {
      spread += (s.place - mean.place) * (s.place - mean.place);
      moment += (s.place - mean.place) * (s.turn - mean.turn);
    }
    const double curvature = moment / spread;
    const double whole = std::abs(curvature) * (stations.back().place - stations.front().place);
    for (const Station& s : stations)
      if (std::abs(s.turn - mean.turn - curvature * (s.place - mean.place)) > kEven * whole) return 0;
    return curvature * mean.place - mean.turn;
  }

  // The most that a face turns the way of `sign` (as dihedral_angle() less pi) within two heights of an edge's facet:
  // as far as the middle of the next facet.
  double turn_beside(Index triangle, std::size_t local, double sign) const {
    double most = 0;
    for (const Station& s : follow(triangle, local, 2 * height_of(triangle, local)))
      most = std::max(most, sign * s.turn);
    return most;
  }

  // How far the way from an edge goes until the face has turned by more than `most`, or ends.
  double way_to_turn(Index triangle, std::size_t local, double most) const {
    double way = 0;
    for (const Station& s : follow(triangle, local, std::numeric_limits<double>::infinity())) {
      if (std::abs(s.turn) > most) break;
      way = s.end;
    }
    return way;
  }

  // The local vertex of the neighbour across a side that is not on that side.
  std::size_t entry_of(Index next, Index t, std::size_t exit) const {
    const Triangle &to = surface_.triangles[uz(next)], &from = surface_.triangles[uz(t)];
    std::size_t k = 0;
    while (to[k] == from[(exit + 1) % 3] || to[k] == from[(exit + 2) % 3]) ++k;
    return k;
  }

 private:
  const Vec3& corner(Index t, std::size_t k) const { return surface_.vertices[uz(surface_.triangles[uz(t)][k % 3])]; }

  // Direction of the side opposite local vertex k.
  Vec3 side(Index t, std::size_t k) const { return normalized(corner(t, k + 2) - corner(t, k + 1)); }

  // Into the facet from that side, square to it.
  Vec3 inward(Index t, std::size_t k) const { return cross(normals_[uz(t)], side(t, k)); }

  double height_of(Index t, std::size_t k) const { return dot(corner(t, k) - corner(t, k + 1), inward(t, k)); }

  // The side by which a way leaves a facet that it entered by another side, and the length of the way in the facet.
  std::pair<std::size_t, double> exit_of(Index t, std::size_t entry, const Vec3& at, const Vec3& going) const {
    std::pair<std::size_t, double> best{entry, std::numeric_limits<double>::infinity()};
    for (const std::size_t k : {(entry + 1) % 3, (entry + 2) % 3}) {
      const Vec3 in = inward(t, k);
      const double speed = -dot(going, in);
      if (speed <= kAlong) continue;
      const double length = std::max(0.0, dot(at - corner(t, k + 1), in) / speed);
      if (length < best.second) best = {k, length};
    }
    return best;
  }

  // The facets behind an edge, first its own, as far as their middles are near enough and the face goes.
  std::vector<Station> follow(Index t, std::size_t entry, double farthest) const {
    std::vector<Station> stations;
    Vec3 at = lerp(corner(t, entry + 1), corner(t, entry + 2), 0.5), going = inward(t, entry);
    double walked = 0, turn = 0;
    while (stations.size() < kMostFacets) {
      const auto [low, high] =
          std::minmax({dot(corner(t, 0) - at, going), dot(corner(t, 1) - at, going), dot(corner(t, 2) - at, going)});
      const double middle = walked + (low + high) / 2;
      if (!stations.empty() && middle > farthest) break;
      const auto [exit, length] = exit_of(t, entry, at, going);
      stations.push_back({middle, turn, walked + (exit == entry ? 0 : length)});
      const Index next = neighbors_[uz(t)][exit];
      if (exit == entry || next == kInvalid) break;
      const double angle = dihedral_angle(surface_, neighbors_, normals_, t, exit) - std::numbers::pi;
      if (std::abs(angle) >= smooth_) break;
      const Vec3 axis = side(t, exit);
      const double along = dot(axis, going), across = -dot(inward(t, exit), going);
      turn += angle * across;
      at += going * length;
      walked += length;
      entry = entry_of(next, t, exit);
      going = axis * along + inward(next, entry) * across;
      t = next;
    }
    return stations;
  }

  const TriSurface& surface_;
  const std::vector<std::array<Index, 3>>& neighbors_;
  const std::vector<Vec3>& normals_;
  double smooth_;
};

}  // namespace

double face_turn(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                 const std::vector<Vec3>& normals, Index triangle, std::size_t local, double smooth) {
  const Section section(surface, neighbors, normals, smooth);
  const Index other = neighbors[uz(triangle)][local];
  const double facets = std::numbers::pi - dihedral_angle(surface, neighbors, normals, triangle, local);
  const double added =
      section.turn_at_edge(triangle, local) + section.turn_at_edge(other, section.entry_of(other, triangle, local));
  return facets + added + kAccuracy * std::abs(added);
}

bool is_sharp_convex(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                     const std::vector<Vec3>& normals, Index triangle, std::size_t local, double dihedral,
                     double limit) {
  return std::numbers::pi - dihedral >= kFaint * limit &&
         face_turn(surface, neighbors, normals, triangle, local, limit) > limit;
}

bool stands_out(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                const std::vector<Vec3>& normals, Index triangle, std::size_t local, double smooth) {
  const Section section(surface, neighbors, normals, smooth);
  const Index other = neighbors[uz(triangle)][local];
  const double turn = dihedral_angle(surface, neighbors, normals, triangle, local) - std::numbers::pi;
  const double most = kNextTurn * std::abs(turn), sign = std::copysign(1.0, turn);
  return section.turn_beside(triangle, local, sign) < most &&
         section.turn_beside(other, section.entry_of(other, triangle, local), sign) < most;
}

double edge_height(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                   const std::vector<Vec3>& normals, Index triangle, std::size_t local, double smooth) {
  const Section section(surface, neighbors, normals, smooth);
  const Index other = neighbors[uz(triangle)][local];
  const double turn = angle_between(normals[uz(triangle)], normals[uz(other)]);
  const double a = section.way_to_turn(triangle, local, turn / 2);
  const double b = section.way_to_turn(other, section.entry_of(other, triangle, local), turn / 2);
  const double chord2 = a * a + b * b + 2 * a * b * std::cos(turn);
  return chord2 > 0 ? a * b * std::sin(turn) / std::sqrt(chord2) : 0;
}

}  // namespace matstruct
