// The graph of the sharp edges of a surface.
#pragma once

#include <vector>

#include "base/index.h"
#include "prepare/domain.h"

namespace matstruct {

/// Sharp edges at each vertex, in ascending order, as compressed rows.
struct SharpGraph {
  std::vector<Index> begin;
  std::vector<Index> edges;
  Index degree(Index vertex) const { return begin[uz(vertex) + 1] - begin[uz(vertex)]; }
  Index edge(Index vertex, Index k) const { return edges[uz(begin[uz(vertex)] + k)]; }
};

inline SharpGraph sharp_graph(const std::vector<SharpEdge>& edges, Index vertices) {
  SharpGraph graph;
  graph.begin.assign(uz(vertices) + 1, 0);
  for (const SharpEdge& edge : edges)
    for (const Index v : edge.vertices) ++graph.begin[uz(v) + 1];
  for (std::size_t v = 0; v < uz(vertices); ++v) graph.begin[v + 1] += graph.begin[v];
  std::vector<Index> next(graph.begin.begin(), graph.begin.end() - 1);
  graph.edges.resize(2 * edges.size());
  for (Index e = 0; e < count(edges); ++e)
    for (const Index v : edges[uz(e)].vertices) graph.edges[uz(next[uz(v)]++)] = e;
  return graph;
}

inline Index other_end(const SharpEdge& edge, Index vertex) {
  return edge.vertices[0] == vertex ? edge.vertices[1] : edge.vertices[0];
}

}  // namespace matstruct
