#include "extract/erosion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "base/incidence.h"
#include "base/index.h"
#include "extract/compact.h"
#include "metrics/medial_tree.h"

namespace matstruct {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// When a fire that moves along the segment from `a` to `b` as straight as its times there say comes to a point.
double arrival(const Vec3& point, const Vec3& a, double time_a, const Vec3& b, double time_b) {
  const double length = distance(a, b);
  const double slope = length > 0 ? (time_b - time_a) / length : 1;
  if (std::abs(slope) < 1) {
    const double along = dot(point - a, b - a) / length;
    const double height = std::sqrt(std::max(0.0, distance2(point, a) - along * along));
    const double steep = std::sqrt(1 - slope * slope);
    const double from = along - height * slope / steep;  // where it leaves the segment
    if (from > 0 && from < length) return time_a + slope * along + height * steep;
  }
  return std::min(time_a + distance(point, a), time_b + distance(point, b));
}

class Fire {
 public:
  Fire(const ThinMesh& thin, const std::vector<Edge>& fixed_edges, const ErosionOptions& options)
      : thin_(thin),
        mesh_(thin.mesh),
        options_(options),
        face_edges_(edges_of_faces(mesh_.edges, mesh_.faces)),
        edges_of_vertex_(mesh_.centers.size(), mesh_.edges),
        faces_of_edge_(mesh_.edges.size(), face_edges_),
        vertex_alive_(mesh_.centers.size(), 1),
        edge_alive_(mesh_.edges.size(), 1),
        face_alive_(mesh_.faces.size(), 1),
        came_(mesh_.centers.size(), kNever) {
    for (Index v = 0; v < count(mesh_.centers); ++v) vertex_degree_.push_back(count(edges_of_vertex_.of(v)));
    for (Index e = 0; e < count(mesh_.edges); ++e) {
      const auto& [a, b] = mesh_.edges[uz(e)];
      const Edge spheres{thin.spheres[uz(a)], thin.spheres[uz(b)]};
      fixed_.push_back(std::binary_search(fixed_edges.begin(), fixed_edges.end(), spheres));
      edge_degree_.push_back(count(faces_of_edge_.of(e)));
      came_to_ends_.push_back({mesh_.radii[uz(a)], mesh_.radii[uz(b)]});
      if (edge_degree_.back() > 1) continue;
      for (const Index v : {a, b})
        if (edge_degree_.back() == 1 || vertex_degree_[uz(v)] == 1) came_[uz(v)] = mesh_.radii[uz(v)];
    }
  }

  ThinMesh run() {
    for (Index e = 0; e < count(mesh_.edges); ++e) light(e);
    do {
      while (!queue_.empty()) {
        const Index edge = queue_.top().second;
        queue_.pop();
        if (!edge_alive_[uz(edge)]) continue;
        if (edge_degree_[uz(edge)] == 1) {
          if (!leaves_spike(face_at(edge), edge)) burn_face(edge);
        } else if (is_end(edge)) {
          burn_edge(edge);
        }
      }
    } while (shave());
    return rest();
  }

 private:
  using Item = std::pair<double, Index>;

  const Vec3& center(Index v) const { return mesh_.centers[uz(v)]; }
  double radius(Index v) const { return mesh_.radii[uz(v)]; }

  Index face_at(Index free_edge) const {
    const auto faces = faces_of_edge_.of(free_edge);
    return *std::find_if(faces.begin(), faces.end(), [&](Index f) { return face_alive_[uz(f)]; });
  }

  // Whether a face stands on an edge of three or more though no seam runs there.
  bool is_flap(Index face) const {
    const Triangle& edges = face_edges_[uz(face)];
    return std::any_of(edges.begin(), edges.end(),
                       [&](Index e) { return edge_degree_[uz(e)] > 2 && thin_.edge_contacts[uz(e)] < 3; });
  }

  // Whether an edge of no face stands for a low bump if the fire comes to its end at that time.
  bool is_low(Index edge, double time) const {
    const auto& [a, b] = mesh_.edges[uz(edge)];
    return time + distance(center(a), center(b)) / 2 - (radius(a) + radius(b)) / 2 < options_.height;
  }

  // Whether a face that burns at a free edge would leave a bare edge that ends freely and does not burn, too.
  bool leaves_spike(Index face, Index edge) const {
    for (const Index e : face_edges_[uz(face)]) {
      if (e == edge || edge_degree_[uz(e)] != 1) continue;
      const auto& [a, b] = mesh_.edges[uz(e)];
      const std::size_t k = mesh_.edges[uz(edge)][0] == a || mesh_.edges[uz(edge)][0] == b ? 0 : 1;
      const bool ends = vertex_degree_[uz(mesh_.edges[uz(edge)][k])] == 2;
      if (ends && (fixed_[uz(e)] || !is_low(e, came_to_ends_[uz(edge)][k]))) return true;
    }
    return false;
  }

  // The vertex of no other edge, or kInvalid.
  Index free_end(Index edge) const {
    const auto& [a, b] = mesh_.edges[uz(edge)];
    return vertex_degree_[uz(a)] == 1 ? a : (vertex_degree_[uz(b)] == 1 ? b : kInvalid);
  }

  // Whether an edge of no face ends freely.
  bool is_end(Index edge) const { return edge_degree_[uz(edge)] == 0 && free_end(edge) != kInvalid; }

  // Removes the ends of curves that the rest covers; returns whether there were any.
  bool shave() {
    std::vector<Index> ends;
    std::vector<MedialPrimitive> rest;
    for (Index e = 0; e < count(mesh_.edges); ++e) {
      if (!edge_alive_[uz(e)] || edge_degree_[uz(e)] > 0) continue;
      const auto& [a, b] = mesh_.edges[uz(e)];
      if (is_end(e) && !fixed_[uz(e)])
        ends.push_back(e);
      else
        rest.push_back({a, b, b});
    }
    if (ends.empty()) return false;
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f)
      if (face_alive_[f]) rest.push_back(mesh_.faces[f]);
    const MedialTree tree(mesh_.centers, mesh_.radii, std::move(rest));
    std::erase_if(ends, [&](Index e) {
      const Index v = free_end(e);
      return !tree.covers(center(v), radius(v) - options_.cover);
    });
    for (const Index e : ends)
      if (is_end(e)) burn_edge(e);
    return !ends.empty();
  }

  // Puts an edge into the queue if a collapse is possible there and what would go is lower than the limit.
  void light(Index edge) {
    if (!edge_alive_[uz(edge)] || fixed_[uz(edge)] || edge_degree_[uz(edge)] > 1) return;
    const auto& [a, b] = mesh_.edges[uz(edge)];
    if (edge_degree_[uz(edge)] == 1) {
      Vec3 middle;
      double r = 0;
      for (const Index v : mesh_.faces[uz(face_at(edge))]) middle += center(v) / 3, r += radius(v) / 3;
      const auto& [at_a, at_b] = came_to_ends_[uz(edge)];
      const double time = arrival(middle, center(a), at_a, center(b), at_b);
      if (time - r < options_.height || is_flap(face_at(edge))) queue_.push({time, edge});
    } else if (const Index end = free_end(edge); end != kInvalid && is_low(edge, came_[uz(end)])) {
      queue_.push({came_[uz(end)] + distance(center(a), center(b)) / 2, edge});
    }
  }

  void burn_face(Index edge) {
    const Index face = face_at(edge);
    const auto& [a, b] = mesh_.edges[uz(edge)];
    const auto& [at_a, at_b] = came_to_ends_[uz(edge)];
    const Triangle& corners = mesh_.faces[uz(face)];
    const Index c = corners[0] + corners[1] + corners[2] - a - b;
    const double at_c = arrival(center(c), center(a), at_a, center(b), at_b);
    face_alive_[uz(face)] = 0;
    for (const Index e : face_edges_[uz(face)]) {
      if (--edge_degree_[uz(e)] > 1 || e == edge) continue;
      const bool seam = faces_of_edge_.of(e).size() > 2;
      for (std::size_t k = 0; k < 2; ++k) {
        const Index v = mesh_.edges[uz(e)][k];
        came_to_ends_[uz(e)][k] = come(v, v == a ? at_a : (v == b ? at_b : at_c), seam);
      }
      light(e);
    }
    remove(edge);
  }

  // The fire comes to a vertex: within a sheet the first time counts, at a seam the last.
  double come(Index v, double time, bool seam) {
    double& came = came_[uz(v)];
    came = came == kNever ? time : (seam ? std::max(came, time) : std::min(came, time));
    return came;
  }

  void burn_edge(Index edge) {
    const Index end = free_end(edge);
    const auto& [a, b] = mesh_.edges[uz(edge)];
    come(a + b - end, came_[uz(end)] + distance(center(a), center(b)), true);
    vertex_alive_[uz(end)] = 0;
    remove(edge);
  }

  void remove(Index edge) {
    edge_alive_[uz(edge)] = 0;
    for (const Index v : mesh_.edges[uz(edge)])
      if (--vertex_degree_[uz(v)] == 1)
        for (const Index e : edges_of_vertex_.of(v)) light(e);
  }

  ThinMesh rest() const {
    ThinMesh result;
    result.mesh = {mesh_.centers, mesh_.radii, mesh_.types, {}, {}};
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e) {
      if (!edge_alive_[e]) continue;
      result.mesh.edges.push_back(mesh_.edges[e]);
      result.edge_contacts.push_back(thin_.edge_contacts[e]);
    }
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      if (!face_alive_[f]) continue;
      result.mesh.faces.push_back(mesh_.faces[f]);
      result.face_invalid.push_back(thin_.face_invalid[f]);
    }
    for (const Index v : compact(result.mesh, vertex_alive_)) result.spheres.push_back(thin_.spheres[uz(v)]);
    return result;
  }

  const ThinMesh& thin_;
  const MedialMesh& mesh_;
  ErosionOptions options_;
  std::vector<Triangle> face_edges_;
  Incidence edges_of_vertex_, faces_of_edge_;
  std::vector<std::uint8_t> vertex_alive_, edge_alive_, face_alive_, fixed_;
  std::vector<Index> vertex_degree_, edge_degree_;   // number of edges and faces left on them
  std::vector<double> came_;                         // when the fire came to a vertex
  std::vector<std::array<double, 2>> came_to_ends_;  // when it did to the ends of an edge, once that is free
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue_;
};

}  // namespace

ThinMesh eroded(const ThinMesh& thin, const std::vector<Edge>& fixed_edges, const ErosionOptions& options) {
  return Fire(thin, fixed_edges, options).run();
}

}  // namespace matstruct
