#include "prepare/line_gaps.h"

#include <cmath>
#include <numbers>

#include "base/index.h"
#include "base/tolerances.h"
#include "prepare/sharp_graph.h"

namespace matstruct {

namespace {

// A line is continued by so many times its length at most.
constexpr double kContinued = 2;

class GapCloser {
 public:
  GapCloser(const TriSurface& surface, const std::vector<SharpEdge>& edges, double shortest, double strong,
            const std::vector<char>& sharp)
      : surface_(surface),
        edges_(edges),
        shortest_(shortest),
        strong_(strong),
        sharp_(sharp),
        graph_(sharp_graph(edges, count(surface.vertices))) {}

  // The edges of all ways across gaps.
  std::vector<Index> run() const {
    std::vector<Index> found;
    for (Index v = 0; v < count(surface_.vertices); ++v) {
      if (sharp_degree(v) != 1) continue;
      const std::vector<Index> way = way_from(v, sharp_edge_at(v, kInvalid));
      found.insert(found.end(), way.begin(), way.end());
    }
    return found;
  }

 private:
  Index sharp_degree(Index vertex) const {
    Index number = 0;
    for (Index k = 0; k < graph_.degree(vertex); ++k) number += sharp_[uz(graph_.edge(vertex, k))] != 0;
    return number;
  }

  // A sharp edge at the vertex other than `edge`; there is one.
  Index sharp_edge_at(Index vertex, Index edge) const {
    Index k = 0;
    while (graph_.edge(vertex, k) == edge || !sharp_[uz(graph_.edge(vertex, k))]) ++k;
    return graph_.edge(vertex, k);
  }

  bool is_strong_at(Index vertex) const {
    for (Index k = 0; k < graph_.degree(vertex); ++k)
      if (std::abs(edges_[uz(graph_.edge(vertex, k))].dihedral - std::numbers::pi) > strong_) return true;
    return false;
  }

  Vec3 leaving(Index vertex, Index edge) const {
    return surface_.vertices[uz(other_end(edges_[uz(edge)], vertex))] - surface_.vertices[uz(vertex)];
  }

  // Goes on from the edge by which the vertex was reached; kInvalid if no edge does.
  Index next(Index vertex, Index edge) const {
    Index best = kInvalid;
    double least = tolerance::kCornerTurn * std::numbers::pi / 180;
    for (Index k = 0; k < graph_.degree(vertex); ++k) {
      const Index other = graph_.edge(vertex, k);
      if (other == edge || sharp_[uz(other)] || edges_[uz(other)].kind != edges_[uz(edge)].kind) continue;
      const double turn = angle_between(leaving(vertex, edge) * -1, leaving(vertex, other));
      if (turn < least) least = turn, best = other;
    }
    return best;
  }

  // Length of the sharp line that ends with `edge` in `vertex`, up to a vertex of other than two sharp edges.
  double length_from(Index vertex, Index edge) const {
    double length = 0;
    const Index start = vertex;
    while (true) {
      length += norm(leaving(vertex, edge));
      vertex = other_end(edges_[uz(edge)], vertex);
      if (vertex == start || sharp_degree(vertex) != 2) return length;
      edge = sharp_edge_at(vertex, edge);
    }
  }

  // Empty if it does not lead to another sharp edge.
  std::vector<Index> way_from(Index vertex, Index edge) const {
    const double known = length_from(vertex, edge);
    if (known < shortest_) return {};
    std::vector<Index> way;
    const Index start = vertex;
    double length = 0;
    while (true) {
      edge = next(vertex, edge);
      if (edge == kInvalid) return {};
      length += norm(leaving(vertex, edge));
      if (length > kContinued * known) return {};
      way.push_back(edge);
      vertex = other_end(edges_[uz(edge)], vertex);
      if (vertex == start) return {};
      if (sharp_degree(vertex) > 0) return is_strong_at(vertex) ? way : std::vector<Index>{};
    }
  }

  const TriSurface& surface_;
  const std::vector<SharpEdge>& edges_;
  double shortest_, strong_;
  const std::vector<char>& sharp_;
  SharpGraph graph_;
};

}  // namespace

void close_line_gaps(const TriSurface& surface, const std::vector<SharpEdge>& edges, double shortest, double strong,
                     std::vector<char>& sharp) {
  for (const Index e : GapCloser(surface, edges, shortest, strong, sharp).run()) sharp[uz(e)] = 1;
}

}  // namespace matstruct
