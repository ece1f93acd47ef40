#include "prepare/features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/index.h"
#include "base/tolerances.h"
#include "geometry/exact.h"
#include "geometry/primitives.h"
#include "prepare/edge_heights.h"
#include "prepare/line_gaps.h"
#include "prepare/noise_lines.h"
#include "prepare/point_index.h"
#include "prepare/sharp_graph.h"
#include "query/face_angle.h"

namespace matstruct {

namespace {

// A convex edge may belong to a line if it turns by this share of the limit.
constexpr double kNearlySharp = 0.9;

constexpr double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

bool is_corner(const TriSurface& surface, const std::vector<SharpEdge>& edges, const SharpGraph& graph, Index vertex) {
  const Index degree = graph.degree(vertex);
  if (degree != 2) return degree > 0;
  const SharpEdge &a = edges[uz(graph.edge(vertex, 0))], &b = edges[uz(graph.edge(vertex, 1))];
  if (a.kind != b.kind) return true;
  const Vec3& p = surface.vertices[uz(vertex)];
  const Vec3 in = p - surface.vertices[uz(other_end(a, vertex))], out = surface.vertices[uz(other_end(b, vertex))] - p;
  return angle_between(in, out) > radians(tolerance::kCornerTurn);
}

// Traces lines; every edge is taken once.
class LineTracer {
 public:
  LineTracer(Features& features, const SharpGraph& graph, const std::vector<char>& corner)
      : features_(features), graph_(graph), corner_(corner) {}

  void trace_all() {
    for (const Index corner : features_.corners)
      for (Index k = 0; k < graph_.degree(corner); ++k) trace(corner, graph_.edge(corner, k));
    for (Index e = 0; e < count(features_.edges); ++e) trace(features_.edges[uz(e)].vertices[0], e);
  }

 private:
  void trace(Index start, Index edge) {
    if (features_.edges[uz(edge)].line != kInvalid) return;
    FeatureLine line{.kind = features_.edges[uz(edge)].kind, .vertices = {start}, .edges = {}};
    Index vertex = start;
    while (true) {
      SharpEdge& step = features_.edges[uz(edge)];
      step.line = count(features_.lines);
      line.edges.push_back(edge);
      vertex = other_end(step, vertex);
      if (vertex == start && !corner_[uz(start)]) {
        line.closed = true;
        break;
      }
      line.vertices.push_back(vertex);
      if (corner_[uz(vertex)]) break;
      edge = graph_.edge(vertex, 0) == edge ? graph_.edge(vertex, 1) : graph_.edge(vertex, 0);
    }
    features_.lines.push_back(std::move(line));
  }

  Features& features_;
  const SharpGraph& graph_;
  const std::vector<char>& corner_;
};

struct Limits {
  double convex, concave;  // interior dihedral angles
  explicit Limits(const Options& options)
      : convex(std::numbers::pi - radians(options.convex_angle)),
        concave(std::numbers::pi + radians(options.concave_angle)) {}
  bool sharp(double angle) const { return angle < convex || angle > concave; }
};

enum class Turn : std::uint8_t { kSmooth, kNearly, kSharp };

struct TurningEdges {
  std::vector<SharpEdge> sharp, nearly;
};

// Edges by what turn_of(triangle, local vertex, dihedral angle) says of them.
template <class TurnOf>
TurningEdges find_edges(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                        const std::vector<Vec3>& normals, const TurnOf& turn_of) {
  TurningEdges edges;
  for (Index t = 0; t < count(surface.triangles); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = surface.triangles[uz(t)][(k + 1) % 3], b = surface.triangles[uz(t)][(k + 2) % 3];
      if (a > b) continue;  // the other triangle runs from the lower to the upper vertex
      const double angle = dihedral_angle(surface, neighbors, normals, t, k);
      const Turn turn = turn_of(t, k, angle);
      if (turn == Turn::kSmooth) continue;
      (turn == Turn::kSharp ? edges.sharp : edges.nearly)
          .push_back({.vertices = {a, b},
                      .kind = angle < std::numbers::pi ? EdgeKind::kConvex : EdgeKind::kConcave,
                      .dihedral = angle,
                      .triangles = {t, neighbors[uz(t)][k]}});
    }
  for (std::vector<SharpEdge>* found : {&edges.sharp, &edges.nearly})
    std::sort(found->begin(), found->end(),
              [](const SharpEdge& a, const SharpEdge& b) { return a.vertices < b.vertices; });
  return edges;
}

// Sorted; of edges that coincide the first convex one, else the first.
std::vector<SharpEdge> without_copies(std::vector<SharpEdge> edges) {
  std::stable_sort(edges.begin(), edges.end(), [](const SharpEdge& a, const SharpEdge& b) {
    return std::pair(a.vertices, a.kind) < std::pair(b.vertices, b.kind);
  });
  edges.erase(std::unique(edges.begin(), edges.end(),
                          [](const SharpEdge& a, const SharpEdge& b) { return a.vertices == b.vertices; }),
              edges.end());
  return edges;
}

// Edges between points instead of vertices.
std::vector<SharpEdge> between_points(std::vector<SharpEdge> edges, const std::vector<Index>& points) {
  for (SharpEdge& e : edges) {
    e.vertices = {points[uz(e.vertices[0])], points[uz(e.vertices[1])]};
    std::sort(e.vertices.begin(), e.vertices.end());
  }
  return without_copies(std::move(edges));
}

// The sharp edges and those of the others that close gaps between them.
std::vector<SharpEdge> with_gaps_closed(const TriSurface& surface, std::vector<SharpEdge> sharp,
                                        const std::vector<SharpEdge>& nearly, double shortest, double strong) {
  std::vector<char> taken(sharp.size(), 1);
  taken.resize(sharp.size() + nearly.size(), 0);
  sharp.insert(sharp.end(), nearly.begin(), nearly.end());
  close_line_gaps(surface, sharp, shortest, strong, taken);
  std::vector<SharpEdge> edges;
  for (std::size_t e = 0; e < sharp.size(); ++e)
    if (taken[e]) edges.push_back(sharp[e]);
  return without_copies(std::move(edges));
}

void drop_noise(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                const std::vector<Vec3>& normals, double diagonal, const Options& options, Features& features) {
  const NoiseLines found = find_noise_lines(surface, features.edges, diagonal, options);
  std::vector<SharpEdge> kept, noise;
  for (std::size_t e = 0; e < features.edges.size(); ++e) (found.noise[e] ? noise : kept).push_back(features.edges[e]);
  features.noise_edges = count(features.edges) - count(kept);
  features.mostly_noise = found.mostly;
  if (found.mostly)
    features.noise_height =
        std::min(height_of_edges(surface, neighbors, normals, noise, std::numbers::pi - Limits(options).convex),
                 tolerance::kNoise * diagonal / options.gamma);
  features.edges = std::move(kept);
}

std::vector<std::array<Index, 3>> edges_of_triangles(const TriSurface& surface, const std::vector<Index>& points,
                                                     const std::vector<SharpEdge>& edges) {
  std::vector<std::array<Index, 3>> result(surface.triangles.size(), {kInvalid, kInvalid, kInvalid});
  for (Index e = 0; e < count(edges); ++e)
    for (const Index t : edges[uz(e)].triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Index opposite = points[uz(surface.triangles[uz(t)][k])];
        if (opposite != edges[uz(e)].vertices[0] && opposite != edges[uz(e)].vertices[1]) result[uz(t)][k] = e;
      }
  return result;
}

// From the sharp edges to all the rest.
Features trace_features(const TriSurface& surface, const std::vector<Index>& points, Features features) {
  features.triangle_edges = edges_of_triangles(surface, points, features.edges);
  const SharpGraph graph = sharp_graph(features.edges, count(surface.vertices));
  std::vector<char> corner(surface.vertices.size(), 0);
  for (Index v = 0; v < count(surface.vertices); ++v)
    if (is_corner(surface, features.edges, graph, v)) {
      corner[uz(v)] = 1;
      features.corners.push_back(v);
    }
  LineTracer(features, graph, corner).trace_all();
  return features;
}

// Given edges between points of the surface, with the place in `given` of each, sorted; without those it does not have.
std::vector<std::pair<Edge, std::size_t>> locate(const TriSurface& surface, const std::vector<Index>& points,
                                                 double diagonal, const std::vector<SharpSegment>& given) {
  const PointIndex index(surface.vertices, tolerance::kWeld * diagonal);
  std::vector<std::pair<Edge, std::size_t>> located;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const Index a = index.find(given[i].a), b = index.find(given[i].b);
    if (a == kInvalid || b == kInvalid) continue;
    const Index p = points[uz(a)], q = points[uz(b)];
    if (p != q) located.push_back({ordered_edge(p, q), i});
  }
  std::sort(located.begin(), located.end());
  return located;
}

}  // namespace

Features detect_features(const TriSurface& surface, const std::vector<Index>& points,
                         const std::vector<std::array<Index, 3>>& neighbors, const std::vector<Vec3>& normals,
                         double diagonal, const Options& options) {
  const Limits limits(options);
  const double limit = std::numbers::pi - limits.convex;
  const auto turn_of = [&](Index t, std::size_t k, double angle) {
    if (angle > limits.concave || is_sharp_convex(surface, neighbors, normals, t, k, angle, limit)) return Turn::kSharp;
    const bool nearly =
        std::numbers::pi - angle > kNearlySharp * limit && stands_out(surface, neighbors, normals, t, k, limit);
    return nearly ? Turn::kNearly : Turn::kSmooth;
  };
  TurningEdges found = find_edges(surface, neighbors, normals, turn_of);
  Features features;
  features.edges = with_gaps_closed(surface, between_points(std::move(found.sharp), points),
                                    between_points(std::move(found.nearly), points), diagonal / options.gamma,
                                    tolerance::kStrongTurn * limit);
  drop_noise(surface, neighbors, normals, diagonal, options, features);
  return trace_features(surface, points, std::move(features));
}

Features given_features(const TriSurface& surface, const std::vector<Index>& points,
                        const std::vector<std::array<Index, 3>>& neighbors, const std::vector<Vec3>& normals,
                        double diagonal, const Options& options, const std::vector<SharpSegment>& given) {
  const Limits limits(options);
  const auto located = locate(surface, points, diagonal, given);
  std::vector<char> found(given.size(), 0);
  const auto turn_of = [&](Index t, std::size_t k, double angle) {
    const Triangle& triangle = surface.triangles[uz(t)];
    const Index p = points[uz(triangle[(k + 1) % 3])], q = points[uz(triangle[(k + 2) % 3])];
    const auto place = std::lower_bound(located.begin(), located.end(), std::pair{ordered_edge(p, q), std::size_t{0}});
    if (place == located.end() || place->first != ordered_edge(p, q)) return Turn::kSmooth;
    const std::optional<double>& known = given[place->second].dihedral;
    const bool sharp = (!known || limits.sharp(*known)) && angle != std::numbers::pi;
    found[place->second] = sharp || known;
    return sharp ? Turn::kSharp : Turn::kSmooth;
  };
  Features features;
  features.edges = between_points(find_edges(surface, neighbors, normals, turn_of).sharp, points);
  features.given_lost = static_cast<Index>(std::count(found.begin(), found.end(), 0));
  return trace_features(surface, points, std::move(features));
}

}  // namespace matstruct
