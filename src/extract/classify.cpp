#include "extract/classify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/index.h"
#include "base/parallel.h"
#include "base/tolerances.h"
#include "rpd/power_triangulation.h"
#include "spheres/cell_contacts.h"
#include "spheres/power_owners.h"

namespace matstruct {

namespace {

constexpr Index kGrain = 128;

std::size_t edge_id(const DualComplex& dual, const Edge& edge) {
  return static_cast<std::size_t>(std::lower_bound(dual.edges.begin(), dual.edges.end(), edge) - dual.edges.begin());
}

// Contacts of the cells of the complex's vertices, by what they hold of the surface.
CellContacts surface_contacts(const VolumeSamples& samples, const Spheres& spheres, const DualComplex& dual,
                              const Context& context) {
  const std::vector<WeightedPoint> weighted = weighted_points(spheres);
  PowerTriangulation triangulation;
  triangulation.update(weighted, dual.vertices, {});
  std::vector<Vec3> feet;
  for (const VolumeSample& s : samples.samples) feet.push_back(s.foot);
  std::vector<Index> owners;
  update_owners(feet, weighted, {triangulation.neighbors().start, triangulation.neighbors().list}, context, owners);
  return cell_contacts(samples, owners, count(weighted), {});
}

}  // namespace

SimplexClasses classify(FinderPool& finders, const std::vector<TangentSphere>& spheres, const DualComplex& dual,
                        const std::vector<Edge>& feature_edges, const Context& context) {
  SimplexClasses classes;
  classes.edge_contacts.assign(dual.edges.size(), 0);
  classes.face_valid.assign(dual.triangles.size(), 0);
  finders.for_each(context, count(dual.edges), kGrain, [&](ContactFinder& finder, Index e) {
    const Edge& edge = dual.edges[uz(e)];
    const std::array<const TangentSphere*, 2> ends{&spheres[uz(edge[0])], &spheres[uz(edge[1])]};
    const bool sharp = std::binary_search(feature_edges.begin(), feature_edges.end(), edge);
    const Index contacts =
        sharp ? 2 : common_stratum(finder, ends, tolerance::kInSheet * distance(ends[0]->center, ends[1]->center));
    classes.edge_contacts[uz(e)] = static_cast<std::uint8_t>(std::min<Index>(contacts, 255));
  });
  finders.for_each(context, count(dual.triangles), kGrain, [&](ContactFinder& finder, Index f) {
    const auto& [a, b, c] = dual.triangles[uz(f)];
    double longest = 0;
    for (const Edge& edge : {Edge{a, b}, Edge{a, c}, Edge{b, c}}) {
      if (classes.edge_contacts[edge_id(dual, edge)] == 0) return;
      longest = std::max(longest, distance(spheres[uz(edge[0])].center, spheres[uz(edge[1])].center));
    }
    const std::array<const TangentSphere*, 3> corners{&spheres[uz(a)], &spheres[uz(b)], &spheres[uz(c)]};
    classes.face_valid[uz(f)] = common_stratum(finder, corners, tolerance::kInSheet * longest) >= 2;
  });
  return classes;
}

SimplexClasses classify_smooth(FinderPool& finders, const std::vector<TangentSphere>& spheres, const DualComplex& dual,
                               double overshoot, const Context& context) {
  std::vector<std::uint8_t> round(spheres.size(), 0);
  for (const Index v : dual.vertices) round[uz(v)] = on_medial_curve(spheres[uz(v)]);
  const SurfaceQuery& query = finders.domain().query;
  const auto sticks_out = [&](std::span<const Index> corners) {
    Vec3 middle;
    double radius = 0;
    for (const Index s : corners) {
      middle += spheres[uz(s)].center / static_cast<double>(corners.size());
      radius += spheres[uz(s)].radius / static_cast<double>(corners.size());
    }
    return radius - std::sqrt(query.closest(middle).distance2) > overshoot;
  };
  SimplexClasses classes;
  classes.edge_contacts.assign(dual.edges.size(), 0);
  classes.face_valid.assign(dual.triangles.size(), 0);
  parallel_for(context, count(dual.edges), kGrain, [&](Index begin, Index end) {
    for (Index e = begin; e < end; ++e) classes.edge_contacts[uz(e)] = sticks_out(dual.edges[uz(e)]) ? 0 : 3;
  });
  parallel_for(context, count(dual.triangles), kGrain, [&](Index begin, Index end) {
    for (Index f = begin; f < end; ++f) {
      const auto& [a, b, c] = dual.triangles[uz(f)];
      const bool edges_valid = classes.edge_contacts[edge_id(dual, {a, b})] > 0 &&
                               classes.edge_contacts[edge_id(dual, {a, c})] > 0 &&
                               classes.edge_contacts[edge_id(dual, {b, c})] > 0;
      const bool flap = round[uz(a)] && round[uz(b)] && round[uz(c)];
      classes.face_valid[uz(f)] = edges_valid && !flap && !sticks_out(dual.triangles[uz(f)]);
    }
  });
  return classes;
}

SimplexClasses classify_by_surface(const VolumeSamples& samples, const Spheres& spheres, const DualComplex& dual,
                                   const std::vector<Edge>& feature_edges, const Context& context) {
  const CellContacts contacts = surface_contacts(samples, spheres, dual, context);
  const auto kept = [&](Index cell, Index other) {
    return goes_on(contacts, cell, other) ? contact_order(contacts, cell) : 0;
  };
  SimplexClasses classes;
  for (const Edge& edge : dual.edges) {
    const bool sharp = std::binary_search(feature_edges.begin(), feature_edges.end(), edge);
    const Index n = sharp ? 2 : std::max(kept(edge[0], edge[1]), kept(edge[1], edge[0]));
    classes.edge_contacts.push_back(static_cast<std::uint8_t>(std::min<Index>(n, 255)));
  }
  for (const auto& [a, b, c] : dual.triangles) {
    const std::array<Edge, 3> edges{{{a, b}, {a, c}, {b, c}}};
    classes.face_valid.push_back(std::all_of(
        edges.begin(), edges.end(), [&](const Edge& edge) { return classes.edge_contacts[edge_id(dual, edge)] >= 2; }));
  }
  return classes;
}

}  // namespace matstruct
