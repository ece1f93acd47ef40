#include "structure/contractibility.h"

#include <numeric>

#include "base/index.h"
#include "base/union_find.h"

namespace matstruct {

namespace {

// What the three kinds of sets have in common: records with a tet, spheres and the tet facets they reach.
struct CellKind {
  using Record = RpdCell;
  static constexpr std::size_t kStart = 0;
  static constexpr ViolationKind kDisconnected = ViolationKind::kCellDisconnected;
  static const std::vector<Record>& records(const Rpd& r) { return r.cells; }
  static Triangle spheres(const Record& c) { return {c.sphere, kInvalid, kInvalid}; }
  static double measure(const Record& c) { return c.volume; }
};
struct FacetKind {
  using Record = RpdFacet;
  static constexpr std::size_t kStart = 1;
  static constexpr ViolationKind kDisconnected = ViolationKind::kFacetDisconnected;
  static const std::vector<Record>& records(const Rpd& r) { return r.facets; }
  static Triangle spheres(const Record& f) { return {f.spheres[0], f.spheres[1], kInvalid}; }
  static double measure(const Record& f) { return f.area; }
};
struct RidgeKind {
  using Record = RpdEdge;
  static constexpr std::size_t kStart = 2;
  static constexpr ViolationKind kDisconnected = ViolationKind::kEdgeDisconnected;
  static const std::vector<Record>& records(const Rpd& r) { return r.edges; }
  static Triangle spheres(const Record& e) { return e.spheres; }
  static double measure(const Record& e) { return e.length; }
};

int local_facet(const Domain& domain, Index tet, Index neighbor) {
  const auto& n = domain.tet_neighbors[uz(tet)];
  return static_cast<int>(std::find(n.begin(), n.end(), neighbor) - n.begin());
}

// Joins the records of two tets that reach their common facet; both lists are sorted by spheres.
template <class Kind>
Index join_across(const Domain& domain, const Rpd& rpd, Index tet, int facet, UnionFind& sets) {
  const Index other = domain.tet_neighbors[uz(tet)][uz(facet)];
  const int back = local_facet(domain, other, tet);
  const auto& records = Kind::records(rpd);
  Index a = rpd.start[uz(tet)][Kind::kStart], b = rpd.start[uz(other)][Kind::kStart];
  const Index a_end = rpd.start[uz(tet) + 1][Kind::kStart], b_end = rpd.start[uz(other) + 1][Kind::kStart];
  Index mismatches = 0;
  const auto skip = [&](Index& k, Index end, int bit) {
    while (k < end && !(records[uz(k)].facets >> bit & 1)) ++k;
  };
  while (true) {
    skip(a, a_end, facet);
    skip(b, b_end, back);
    if (a == a_end && b == b_end) return mismatches;
    const bool first = a < a_end && (b == b_end || Kind::spheres(records[uz(a)]) <= Kind::spheres(records[uz(b)]));
    const bool second = b < b_end && (a == a_end || Kind::spheres(records[uz(b)]) <= Kind::spheres(records[uz(a)]));
    if (first && second)
      sets.unite(a, b);
    else
      ++mismatches;
    a += first;
    b += second;
  }
}

// The record of the given spheres in a tet, or kInvalid.
template <class Kind>
Index record_in(const Rpd& rpd, Index tet, const Triangle& spheres) {
  for (Index r = rpd.start[uz(tet)][Kind::kStart]; r < rpd.start[uz(tet) + 1][Kind::kStart]; ++r)
    if (Kind::spheres(Kind::records(rpd)[uz(r)]) == spheres) return r;
  return kInvalid;
}

// Joins the records of tets that share a name on an edge or vertex where the solid touches itself; contacts are sorted.
template <class Kind>
void join_contacts(const Rpd& rpd, const std::vector<PinchContact>& contacts, UnionFind& sets) {
  for (std::size_t c = 1; c < contacts.size(); ++c) {
    const PinchContact &a = contacts[c - 1], &b = contacts[c];
    if (a.simplex != b.simplex || a.spheres != b.spheres) continue;
    const Triangle spheres{a.spheres[0], a.spheres[1], kInvalid};
    const Index r = record_in<Kind>(rpd, a.tet, spheres), s = record_in<Kind>(rpd, b.tet, spheres);
    if (r != kInvalid && s != kInvalid) sets.unite(r, s);
  }
}

// Connected components of all sets of one kind, as the least record of each.
template <class Kind>
std::vector<Index> components(const Domain& domain, const Rpd& rpd, const std::vector<PinchContact>& contacts,
                              Index& mismatches) {
  UnionFind sets(count(Kind::records(rpd)));
  for (Index t = 0; t < count(domain.solid.tets); ++t)
    for (int f = 0; f < 4; ++f)
      if (const Index other = domain.tet_neighbors[uz(t)][uz(f)]; other != kInvalid && t < other)
        mismatches += join_across<Kind>(domain, rpd, t, f, sets);
  join_contacts<Kind>(rpd, contacts, sets);
  std::vector<Index> roots(Kind::records(rpd).size());
  for (Index r = 0; r < count(roots); ++r) roots[uz(r)] = sets.find(r);
  return roots;
}

// Calls visit(spheres, records of the set, grouped by component) for every set.
template <class Kind, class Visit>
void for_each_set(const Rpd& rpd, const std::vector<Index>& roots, Visit visit) {
  const auto& records = Kind::records(rpd);
  std::vector<Index> order(records.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const Triangle sa = Kind::spheres(records[uz(a)]), sb = Kind::spheres(records[uz(b)]);
    if (sa != sb) return sa < sb;
    return std::pair(roots[uz(a)], a) < std::pair(roots[uz(b)], b);
  });
  for (std::size_t begin = 0; begin < order.size();) {
    const Triangle spheres = Kind::spheres(records[uz(order[begin])]);
    std::size_t end = begin;
    while (end < order.size() && Kind::spheres(records[uz(order[end])]) == spheres) ++end;
    visit(spheres, std::vector<Index>(order.begin() + static_cast<std::ptrdiff_t>(begin),
                                      order.begin() + static_cast<std::ptrdiff_t>(end)));
    begin = end;
  }
}

// All components of a set but the one of greatest measure.
template <class Kind>
void report_disconnected(const Rpd& rpd, const std::vector<Index>& roots, const Triangle& spheres,
                         const std::vector<Index>& set, std::vector<Violation>& out) {
  std::vector<std::pair<double, std::vector<Index>>> parts;
  for (const Index r : set) {
    if (parts.empty() || roots[uz(parts.back().second.front())] != roots[uz(r)]) parts.push_back({0, {}});
    parts.back().first += Kind::measure(Kind::records(rpd)[uz(r)]);
    parts.back().second.push_back(r);
  }
  const auto greatest =
      std::max_element(parts.begin(), parts.end(), [](auto& a, auto& b) { return a.first < b.first; });
  for (auto p = parts.begin(); p != parts.end(); ++p)
    if (p != greatest) out.push_back({Kind::kDisconnected, spheres, std::move(p->second)});
}

template <class Kind>
void check_sets(const Rpd& rpd, const std::vector<Index>& roots, ViolationKind euler_kind,
                std::vector<Violation>& out) {
  for_each_set<Kind>(rpd, roots, [&](const Triangle& spheres, const std::vector<Index>& set) {
    if (roots[uz(set.front())] != roots[uz(set.back())]) {
      report_disconnected<Kind>(rpd, roots, spheres, set, out);
      return;
    }
    if constexpr (!std::is_same_v<Kind, RidgeKind>) {
      Index euler = 0;
      for (const Index r : set) euler += Kind::records(rpd)[uz(r)].euler;
      if (euler != 1) out.push_back({euler_kind, spheres, set});
    }
  });
}

// All records of the given sets.
template <class Kind>
std::vector<Violation> whole_sets(const Rpd& rpd, std::vector<Triangle> sets, ViolationKind kind) {
  std::sort(sets.begin(), sets.end());
  sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
  std::vector<Violation> result;
  for (const Triangle& s : sets) result.push_back({kind, s, {}});
  if (result.empty()) return result;
  for (Index r = 0; r < count(Kind::records(rpd)); ++r) {
    const auto found = std::lower_bound(sets.begin(), sets.end(), Kind::spheres(Kind::records(rpd)[uz(r)]));
    if (found != sets.end() && *found == Kind::spheres(Kind::records(rpd)[uz(r)]))
      result[static_cast<std::size_t>(found - sets.begin())].records.push_back(r);
  }
  return result;
}

// Cells that alone touch a whole shell of the boundary enclose it if it bounds a cavity; the outer shell of a
// component is touched by one cell alone only if that cell is the whole component.
void check_cavities(const Domain& domain, const Rpd& rpd, std::vector<Violation>& out) {
  if (domain.topology.b2 == 0) return;
  UnionFind shells(count(domain.surface.triangles));
  for (Index t = 0; t < count(domain.surface.triangles); ++t)
    for (const Index n : domain.triangle_neighbors[uz(t)]) shells.unite(t, n);
  constexpr Index kNone = kInvalid, kSeveral = kInvalid - 1;
  std::vector<Index> owner(domain.surface.triangles.size(), kNone);
  for (const RpdCell& c : rpd.cells)
    for (std::size_t f = 0; f < 4; ++f) {
      const Index triangle = domain.tet_triangles[uz(c.tet)][f];
      if (triangle == kInvalid || !(c.facets >> f & 1)) continue;
      Index& o = owner[uz(shells.find(triangle))];
      o = o == kNone || o == c.sphere ? c.sphere : kSeveral;
    }
  std::vector<double> volume(domain.surface.triangles.size(), 0);
  for (Index t = 0; t < count(domain.surface.triangles); ++t) {
    const auto& [a, b, c] = domain.surface.triangles[uz(t)];
    const auto& x = domain.surface.vertices;
    volume[uz(shells.find(t))] += dot(x[uz(a)], cross(x[uz(b)], x[uz(c)]));
  }
  std::vector<Index> enclosing;
  for (Index s = 0; s < count(owner); ++s) {
    if (owner[uz(s)] < 0 || volume[uz(s)] > 0) continue;
    enclosing.push_back(owner[uz(s)]);
  }
  std::vector<Triangle> sets;
  for (const Index e : enclosing) sets.push_back({e, kInvalid, kInvalid});
  for (Violation& v : whole_sets<CellKind>(rpd, std::move(sets), ViolationKind::kCellCavity))
    out.push_back(std::move(v));
}

}  // namespace

std::vector<Violation> whole_cells(const Rpd& rpd, const std::vector<Index>& spheres, ViolationKind kind) {
  std::vector<Triangle> sets;
  for (const Index s : spheres) sets.push_back({s, kInvalid, kInvalid});
  return whole_sets<CellKind>(rpd, std::move(sets), kind);
}

std::vector<Violation> whole_facets(const Rpd& rpd, const std::vector<Edge>& pairs, ViolationKind kind) {
  std::vector<Triangle> sets;
  for (const Edge& e : pairs) sets.push_back({e[0], e[1], kInvalid});
  return whole_sets<FacetKind>(rpd, std::move(sets), kind);
}

RpdComponents rpd_components(const Domain& domain, const Rpd& rpd, const std::vector<PinchContact>& contacts) {
  RpdComponents result;
  result.cells = components<CellKind>(domain, rpd, contacts, result.mismatches);
  result.facets = components<FacetKind>(domain, rpd, contacts, result.mismatches);
  result.edges = components<RidgeKind>(domain, rpd, contacts, result.mismatches);
  return result;
}

Contractibility check_contractible(const Domain& domain, const Rpd& rpd, const std::vector<PinchContact>& contacts) {
  const RpdComponents parts = rpd_components(domain, rpd, contacts);
  Contractibility result;
  result.mismatches = parts.mismatches;
  auto& out = result.violations;
  check_sets<CellKind>(rpd, parts.cells, ViolationKind::kCellEuler, out);
  check_cavities(domain, rpd, out);
  check_sets<FacetKind>(rpd, parts.facets, ViolationKind::kFacetEuler, out);
  check_sets<RidgeKind>(rpd, parts.edges, ViolationKind::kEdgeDisconnected, out);
  std::stable_sort(out.begin(), out.end(), [](const Violation& a, const Violation& b) {
    return std::pair(a.kind, a.spheres) < std::pair(b.kind, b.spheres);
  });
  return result;
}

}  // namespace matstruct
