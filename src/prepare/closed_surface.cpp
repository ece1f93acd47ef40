#include "prepare/closed_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <matstruct/error.h>

#include "base/index.h"
#include "base/tolerances.h"
#include "base/union_find.h"
#include "geometry/exact.h"
#include "prepare/caps.h"
#include "prepare/messages.h"
#include "prepare/radial_pairs.h"
#include "prepare/weld.h"

namespace matstruct {

void check_elements(const TriSurface& input) {
  if (input.triangles.empty()) throw Error("the surface has no triangles.");
  for (std::size_t t = 0; t < input.triangles.size(); ++t)
    for (const Index v : input.triangles[t]) {
      if (v < 0 || v >= count(input.vertices))
        throw Error(fmt::format("triangle {} refers to vertex {}, but the vertices are 0 to {}.", t, v,
                                count(input.vertices) - 1));
      const Vec3& p = input.vertices[uz(v)];
      if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
        throw Error(fmt::format("vertex {} has a coordinate that is not a finite number: {}.", v, place(p)));
    }
}

namespace {

// Drops unused vertices and those with a lesser equal in `first`, and renames the others in the triangles.
void compact(ClosedSurface& closed, const std::vector<Index>& first) {
  TriSurface& surface = closed.surface;
  std::vector<Index> id(surface.vertices.size(), kInvalid);
  for (Triangle& t : surface.triangles)
    for (Index& v : t) id[uz(v = first[uz(v)])] = 0;
  Index next = 0;
  for (Index v = 0; v < count(id); ++v) {
    if (id[uz(v)] == kInvalid) continue;
    id[uz(v)] = next;
    surface.vertices[uz(next)] = surface.vertices[uz(v)];
    closed.input_vertex[uz(next)] = closed.input_vertex[uz(v)];
    ++next;
  }
  surface.vertices.resize(uz(next));
  closed.input_vertex.resize(uz(next));
  for (Triangle& t : surface.triangles)
    for (Index& v : t) v = id[uz(v)];
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

// Keeps the first of the triangles with equal vertices and none that repeats a vertex. Returns the number dropped.
std::size_t drop_useless_triangles(std::vector<Triangle>& triangles) {
  std::vector<std::pair<Triangle, std::size_t>> order;
  for (std::size_t t = 0; t < triangles.size(); ++t) order.emplace_back(sorted(triangles[t]), t);
  std::sort(order.begin(), order.end());
  std::vector<char> keep(triangles.size(), 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Triangle& v = order[i].first;
    const bool repeated = i > 0 && order[i - 1].first == v;
    keep[order[i].second] = v[0] != v[1] && v[1] != v[2] && !repeated;
  }
  const std::size_t before = triangles.size();
  std::size_t next = 0;
  for (std::size_t t = 0; t < before; ++t)
    if (keep[t]) triangles[next++] = triangles[t];
  triangles.resize(next);
  return before - next;
}

// Edges with their triangles, sorted by edge.
struct EdgeUse {
  Edge edge;
  Index triangle = 0;
  bool forward = true;  // the triangle runs from the lower to the upper vertex
};

std::vector<EdgeUse> edge_uses(const std::vector<Triangle>& triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (Index t = 0; t < count(triangles); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[uz(t)][k], b = triangles[uz(t)][(k + 1) % 3];
      uses.push_back({.edge = ordered_edge(a, b), .triangle = t, .forward = a < b});
    }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.triangle < b.triangle;
  });
  return uses;
}

// Calls visit(first, number) for each edge with the uses of it.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit visit) {
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].edge == uses[begin].edge) ++end;
    visit(&uses[begin], end - begin);
  }
}

std::vector<Edge> edges_with(const std::vector<Triangle>& triangles, const std::function<bool(std::size_t)>& number) {
  std::vector<Edge> edges;
  for_each_edge(edge_uses(triangles), [&](const EdgeUse* use, std::size_t n) {
    if (number(n)) edges.push_back(use->edge);
  });
  return edges;
}

std::vector<Edge> border_edges(const std::vector<Triangle>& triangles) {
  return edges_with(triangles, [](std::size_t n) { return n == 1; });
}

// Representatives of the vertices of border edges that lie within `distance` of each other.
std::vector<Index> weld_near(const TriSurface& surface, const std::vector<Edge>& border, double distance) {
  std::vector<Index> order;
  for (const Edge& edge : border) order.insert(order.end(), edge.begin(), edge.end());
  const auto x = [&](Index v) { return surface.vertices[uz(v)].x; };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return x(a) != x(b) ? x(a) < x(b) : a < b; });
  order.erase(std::unique(order.begin(), order.end()), order.end());
  UnionFind sets(count(surface.vertices));
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size() && x(order[j]) - x(order[i]) <= distance; ++j)
      if (distance2(surface.vertices[uz(order[i])], surface.vertices[uz(order[j])]) <= distance * distance)
        sets.unite(order[i], order[j]);
  std::vector<Index> first(surface.vertices.size());
  for (Index v = 0; v < count(first); ++v) first[uz(v)] = sets.find(v);
  return first;
}

void weld(ClosedSurface& closed, Context& context) {
  TriSurface& surface = closed.surface;
  compact(closed, weld_equal(surface.vertices));
  std::size_t dropped = drop_useless_triangles(surface.triangles);
  const std::vector<Edge> border = border_edges(surface.triangles);
  if (!border.empty()) {
    const std::size_t before = surface.vertices.size();
    compact(closed, weld_near(surface, border, tolerance::kWeld));
    dropped += drop_useless_triangles(surface.triangles);
    if (surface.vertices.size() < before)
      context.warnings.push_back(fmt::format("{} within rounding of another welded to close the surface.",
                                             counted(before - surface.vertices.size(), "vertex", "vertices")));
  }
  dropped += uz(remove_caps(surface, tolerance::kCap));
  if (dropped > 0)
    context.warnings.push_back(fmt::format("{} of zero area or given twice {} dropped.",
                                           counted(dropped, "triangle", "triangles"), dropped == 1 ? "was" : "were"));
  if (surface.triangles.empty()) throw Error("all triangles of the surface have zero area.");
}

void check_edges(const ClosedSurface& closed, const VertexName& name) {
  const auto refuse = [&](const std::vector<Edge>& edges, SurfaceDefect defect, const char* what, const char* advice) {
    if (edges.empty()) return;
    throw SurfaceError(
        defect, fmt::format("the surface {}: {}, the first from {} to {}; {}.", what,
                            counted(edges.size(), "edge", "edges"), name(edges[0][0]), name(edges[0][1]), advice));
  };
  refuse(border_edges(closed.surface.triangles), SurfaceDefect::kOpen, "is open (has edges with only one triangle)",
         "fill the holes, or weld the vertices that should be one");
  refuse(edges_with(closed.surface.triangles, [](std::size_t n) { return n > 2; }), SurfaceDefect::kCrowdedEdge,
         "has edges with more than two triangles", "remove inner walls, or separate bodies that touch along an edge");
}

// Makes the triangles of each shell run along shared edges in opposite directions.
void orient_consistently(std::vector<Triangle>& triangles, const VertexName& name) {
  std::vector<std::array<std::pair<Index, bool>, 3>> across(triangles.size());  // neighbour, and whether it agrees
  std::vector<std::size_t> used(triangles.size(), 0);
  for_each_edge(edge_uses(triangles), [&](const EdgeUse* use, std::size_t) {
    const bool agree = use[0].forward != use[1].forward;
    for (std::size_t side = 0; side < 2; ++side) {
      const Index t = use[side].triangle;
      across[uz(t)][used[uz(t)]++] = {use[1 - side].triangle, agree};
    }
  });
  enum : char { kUnseen, kKeep, kFlip };
  std::vector<char> state(triangles.size(), kUnseen);
  std::vector<Index> front;
  for (Index seed = 0; seed < count(triangles); ++seed) {
    if (state[uz(seed)] != kUnseen) continue;
    state[uz(seed)] = kKeep;
    front.push_back(seed);
    while (!front.empty()) {
      const Index t = front.back();
      front.pop_back();
      for (const auto& [other, agree] : across[uz(t)]) {
        const char wanted = (state[uz(t)] == kKeep) == agree ? kKeep : kFlip;
        if (state[uz(other)] == kUnseen) {
          state[uz(other)] = wanted;
          front.push_back(other);
        } else if (state[uz(other)] != wanted) {
          throw SurfaceError(SurfaceDefect::kOneSided,
                             fmt::format("the surface cannot be oriented (it is one-sided), as seen at {}.",
                                         name(triangles[uz(other)][0])));
        }
      }
    }
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (state[t] == kFlip) std::swap(triangles[t][1], triangles[t][2]);
}

void flip_shell(ClosedSurface& closed, Index shell) {
  for (std::size_t t = 0; t < closed.surface.triangles.size(); ++t)
    if (closed.triangle_shell[t] == shell) std::swap(closed.surface.triangles[t][1], closed.surface.triangles[t][2]);
}

// Splits into shells, each with outward normals.
void find_shells(ClosedSurface& closed, const std::vector<std::array<Index, 3>>& neighbors) {
  TriSurface& surface = closed.surface;
  closed.triangle_shell = triangle_components(neighbors);
  std::vector<double> six_volumes;
  for (Index t = 0; t < count(surface.triangles); ++t) {  // a component's name is its least triangle
    Index& shell = closed.triangle_shell[uz(t)];
    if (shell == t) {
      shell = closed.shells++;
      six_volumes.push_back(0);
    } else {
      shell = closed.triangle_shell[uz(shell)];
    }
    const Triangle& v = surface.triangles[uz(t)];
    six_volumes[uz(shell)] +=
        dot(surface.vertices[uz(v[0])], cross(surface.vertices[uz(v[1])], surface.vertices[uz(v[2])]));
  }
  for (Index shell = 0; shell < closed.shells; ++shell)
    if (six_volumes[uz(shell)] < 0) flip_shell(closed, shell);
}

// A vertex of a shell that another does not have, as shells may touch in vertices; any if there is none.
Index own_vertex(const TriSurface& shell, const TriSurface& other) {
  std::vector<char> taken(other.vertices.size(), 0);
  for (const Triangle& t : other.triangles)
    for (const Index v : t) taken[uz(v)] = 1;
  for (const Triangle& t : shell.triangles)
    for (const Index v : t)
      if (!taken[uz(v)]) return v;
  return shell.triangles.front()[0];
}

// For each shell the shells that contain it.
std::vector<std::vector<Index>> containers(const ClosedSurface& closed) {
  std::vector<TriSurface> parts(uz(closed.shells), TriSurface{.vertices = closed.surface.vertices, .triangles = {}});
  for (std::size_t t = 0; t < closed.surface.triangles.size(); ++t)
    parts[uz(closed.triangle_shell[t])].triangles.push_back(closed.surface.triangles[t]);
  std::vector<std::vector<Index>> result(uz(closed.shells));
  for (Index outer = 0; outer < closed.shells; ++outer) {
    const SurfaceQuery query(parts[uz(outer)]);
    for (Index inner = 0; inner < closed.shells; ++inner) {
      if (inner == outer) continue;
      const Index vertex = own_vertex(parts[uz(inner)], parts[uz(outer)]);
      if (query.inside(closed.surface.vertices[uz(vertex)])) result[uz(inner)].push_back(outer);
    }
  }
  return result;
}

// Shells at even depth bound a solid from outside, those at odd depth are cavities of the solid around them.
void nest(ClosedSurface& closed) {
  std::vector<std::vector<Index>> around(uz(closed.shells));
  if (closed.shells > 1) around = containers(closed);
  std::vector<Index> solid_of(uz(closed.shells), kInvalid);
  for (Index s = 0; s < closed.shells; ++s)
    if (around[uz(s)].size() % 2 == 0) {
      solid_of[uz(s)] = count(closed.solids);
      closed.solids.push_back({s});
    }
  for (Index s = 0; s < closed.shells; ++s) {
    if (solid_of[uz(s)] != kInvalid) continue;
    const Index parent = *std::max_element(around[uz(s)].begin(), around[uz(s)].end(), [&](Index a, Index b) {
      return around[uz(a)].size() < around[uz(b)].size();
    });
    closed.solids[uz(solid_of[uz(parent)])].push_back(s);
    flip_shell(closed, s);
  }
}

}  // namespace

VertexName ClosedSurface::name(const TriSurface& input) const {
  return [this, &input](Index v) {
    const Index id = input_vertex[uz(v)];
    return fmt::format("vertex {} {}", id, place(input.vertices[uz(id)]));
  };
}

namespace {

// The input in the internal frame, without unused vertices.
ClosedSurface in_frame(const TriSurface& input) {
  check_elements(input);
  ClosedSurface closed;
  closed.surface = input;
  closed.input_vertex.resize(input.vertices.size());
  std::iota(closed.input_vertex.begin(), closed.input_vertex.end(), 0);
  const std::vector<Index> identity = closed.input_vertex;
  compact(closed, identity);
  closed.frame = fit_frame(closed.surface.vertices, closed.surface.triangles, Coordinates::kRounded);
  for (Vec3& p : closed.surface.vertices) p = closed.frame.to_internal(p);
  return closed;
}

}  // namespace

TriSurface weld_surface(const TriSurface& input) {
  ClosedSurface closed = in_frame(input);
  TriSurface& surface = closed.surface;
  const auto drop_repeated = [&] {
    std::erase_if(surface.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  };
  compact(closed, weld_equal(surface.vertices));
  drop_repeated();
  compact(closed, weld_near(surface, border_edges(surface.triangles), tolerance::kWeld));
  drop_repeated();
  for (std::size_t v = 0; v < surface.vertices.size(); ++v)
    surface.vertices[v] = input.vertices[uz(closed.input_vertex[v])];
  return std::move(surface);
}

ClosedSurface close_surface(const TriSurface& input, Context& context,
                            const std::function<void(const ClosedSurface&)>& check) {
  ClosedSurface closed = in_frame(input);
  weld(closed, context);
  const VertexName name = closed.name(input);
  check_edges(closed, name);
  orient_consistently(closed.surface.triangles, name);
  find_shells(closed, pair_triangles(closed.surface.triangles, name));
  check(closed);
  nest(closed);
  return closed;
}

ClosedSurface close_resolved_surface(const TriSurface& input, Context& context) {
  ClosedSurface closed = in_frame(input);
  weld(closed, context);
  const VertexName name = closed.name(input);
  find_shells(closed, pair_across_material(closed.surface, name));
  nest(closed);
  return closed;
}

}  // namespace matstruct
