#include "rpd/power_triangulation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <array>
#include <numeric>

#include "base/index.h"

namespace matstruct {

namespace {

struct SphereId {
  Index value = kInvalid;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase =
    CGAL::Triangulation_vertex_base_with_info_3<SphereId, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
// Hidden spheres are kept here by id, not by CGAL by position: a sphere that appears again must know who it is.
using CellBase = CGAL::Regular_triangulation_cell_base_3<Kernel, CGAL::Triangulation_cell_base_3<Kernel>,
                                                         CGAL::Discard_hidden_points>;
using Triangulation = CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using Handle = Triangulation::Vertex_handle;

Triangulation::Weighted_point to_cgal(const WeightedPoint& s) {
  return {Kernel::Point_3(s.center.x, s.center.y, s.center.z), s.weight};
}

// Ids in an order in which consecutive spheres are near each other.
std::vector<Index> spatial_order(const std::vector<WeightedPoint>& spheres, const std::vector<Index>& ids) {
  std::vector<Kernel::Point_3> points;
  points.reserve(ids.size());
  for (const Index s : ids)
    points.emplace_back(spheres[uz(s)].center.x, spheres[uz(s)].center.y, spheres[uz(s)].center.z);
  std::vector<std::size_t> order(ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto map = CGAL::make_property_map(points);
  CGAL::spatial_sort(order.begin(), order.end(), CGAL::Spatial_sort_traits_adapter_3<Kernel, decltype(map)>(map));
  std::vector<Index> sorted;
  sorted.reserve(ids.size());
  for (const std::size_t k : order) sorted.push_back(ids[k]);
  return sorted;
}

}  // namespace

struct PowerTriangulation::Impl {
  Triangulation triangulation;
  std::vector<Handle> handles;  // of visible spheres; stale for the others
  std::vector<bool> visible;
  std::vector<bool> alive;
  Neighbors neighbors;

  void insert(const std::vector<WeightedPoint>& spheres, const std::vector<Index>& ids) {
    Handle hint;
    for (const Index s : spatial_order(spheres, ids)) {
      const auto point = to_cgal(spheres[uz(s)]);
      const Handle v = hint == Handle() ? triangulation.insert(point) : triangulation.insert(point, hint->cell());
      if (v == Handle()) continue;
      if (v->info().value == kInvalid) v->info().value = s;
      hint = v;
    }
  }

  // Reads visible spheres and their neighbours off the triangulation.
  void refresh() {
    std::fill(visible.begin(), visible.end(), false);
    std::fill(handles.begin(), handles.end(), Handle());
    for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end(); ++v) {
      visible[uz(v->info().value)] = true;
      handles[uz(v->info().value)] = v;
    }
    link();
  }

  // Neighbours from the cells' edges: cells are listed per vertex by counting, then each vertex drops repetitions.
  void link() {
    const std::vector<std::array<Index, 4>> cells = finite_parts();
    std::vector<Index> first(visible.size() + 1, 0), of_vertex, last_seen(visible.size(), kInvalid);
    for (const auto& c : cells)
      for (const Index v : c)
        if (v != kInvalid) ++first[uz(v) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    of_vertex.resize(uz(first.back()));
    std::vector<Index> next(first.begin(), first.end() - 1);
    for (Index c = 0; c < count(cells); ++c)
      for (const Index v : cells[uz(c)])
        if (v != kInvalid) of_vertex[uz(next[uz(v)]++)] = c;

    neighbors.start.assign(1, 0);
    neighbors.list.clear();
    for (Index v = 0; v < count(visible); ++v) {
      last_seen[uz(v)] = v;
      for (Index n = first[uz(v)]; n < first[uz(v) + 1]; ++n)
        for (const Index w : cells[uz(of_vertex[uz(n)])])
          if (w != kInvalid && last_seen[uz(w)] != v) {
            last_seen[uz(w)] = v;
            neighbors.list.push_back(w);
          }
      std::sort(neighbors.list.begin() + neighbors.start.back(), neighbors.list.end());
      neighbors.start.push_back(count(neighbors.list));
    }
  }

  // The ids of every cell's vertices, kInvalid for the infinite vertex and where a flat triangulation has none.
  std::vector<std::array<Index, 4>> finite_parts() const {
    std::vector<std::array<Index, 4>> cells;
    const int dimension = triangulation.dimension();
    const auto& tds = triangulation.tds();
    cells.reserve(tds.cells().size());
    for (auto c = tds.cells().begin(); c != tds.cells().end(); ++c) {  // cells_begin() skips those of flat ones
      auto& cell = cells.emplace_back();
      cell.fill(kInvalid);
      for (int k = 0; k <= dimension; ++k) cell[uz(k)] = c->vertex(k)->info().value;
    }
    return cells;
  }
};

PowerTriangulation::PowerTriangulation() : impl_(std::make_unique<Impl>()) {}
PowerTriangulation::~PowerTriangulation() = default;
PowerTriangulation::PowerTriangulation(PowerTriangulation&&) noexcept = default;
PowerTriangulation& PowerTriangulation::operator=(PowerTriangulation&&) noexcept = default;

void PowerTriangulation::update(const std::vector<WeightedPoint>& spheres, const std::vector<Index>& inserted,
                                const std::vector<Index>& removed) {
  Impl& t = *impl_;
  t.visible.resize(spheres.size(), false);
  t.alive.resize(spheres.size(), false);
  t.handles.resize(spheres.size());
  bool uncovers = false;
  for (const Index s : removed) {
    if (t.visible[uz(s)]) {
      t.triangulation.remove(t.handles[uz(s)]);
      uncovers = true;
    }
    t.alive[uz(s)] = false;
  }
  std::vector<Index> candidates = inserted;
  if (uncovers)
    for (Index s = 0; s < count(t.alive); ++s)
      if (t.alive[uz(s)] && !t.visible[uz(s)]) candidates.push_back(s);
  for (const Index s : inserted) t.alive[uz(s)] = true;
  t.insert(spheres, candidates);
  t.refresh();
}

const PowerTriangulation::Neighbors& PowerTriangulation::neighbors() const {
  return impl_->neighbors;
}
const std::vector<bool>& PowerTriangulation::visible() const {
  return impl_->visible;
}

}  // namespace matstruct
