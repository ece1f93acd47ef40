#include "rpd/rpd.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/index.h"
#include "base/parallel.h"
#include "rpd/piece_records.h"

namespace matstruct {

namespace {

constexpr Index kTetGrain = 32, kSphereGrain = 256, kSpliceGrain = 512;

// Where the records of one kind of a tet are to be found.
struct Source {
  const PieceRecords* fresh = nullptr;  // null: among the old records
  Index begin = 0, end = 0;
};

// Concatenates records tet by tet from their sources.
template <class Record, class SourceOf>
void splice(std::vector<Record>& records, std::size_t kind, std::vector<Record> PieceRecords::*member,
            std::vector<std::array<Index, 6>>& start, const SourceOf& source_of, const Context& context) {
  const Index tets = count(start) - 1;
  Index total = 0;
  for (Index t = 0; t < tets; ++t) {
    const Source s = source_of(t, kind);
    start[uz(t)][kind] = total;
    total += s.end - s.begin;
  }
  start.back()[kind] = total;
  std::vector<Record> result(uz(total));
  parallel_for(context, tets, kSpliceGrain, [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t) {
      const Source s = source_of(t, kind);
      const std::vector<Record>& from = s.fresh ? s.fresh->*member : records;
      std::copy(from.begin() + s.begin, from.begin() + s.end, result.begin() + start[uz(t)][kind]);
    }
  });
  records = std::move(result);
}

std::array<Index, 6> sizes(const PieceRecords& r) {
  return {count(r.cells), count(r.facets), count(r.edges), count(r.vertices), count(r.stretches), count(r.crossings)};
}

template <class Record, class Key>
void sort_tail(std::vector<Record>& records, Index begin, Key key) {
  std::sort(records.begin() + begin, records.end(), [&](const Record& a, const Record& b) { return key(a) < key(b); });
}

void sort_tet_records(PieceRecords& r, const std::array<Index, 6>& begin) {
  sort_tail(r.cells, begin[0], [](const RpdCell& c) { return c.sphere; });
  sort_tail(r.facets, begin[1], [](const RpdFacet& f) { return f.spheres; });
  sort_tail(r.edges, begin[2], [](const RpdEdge& e) { return e.spheres; });
  sort_tail(r.vertices, begin[3], [](const RpdVertex& v) { return v.spheres; });
  sort_tail(r.stretches, begin[4], [](const RpdStretch& s) { return std::pair(s.sharp_edge, s.sphere); });
  sort_tail(r.crossings, begin[5], [](const RpdCrossing& c) { return std::pair(c.sharp_edge, c.spheres); });
}

// Strictly nearer in power distance at a point, ties broken as everywhere.
bool nearer(const std::vector<WeightedPoint>& spheres, const Vec3& x, Index a, Index b) {
  constexpr double kRounding = 16 * 0x1.0p-53;  // each distance carries at most 6 roundings, the difference three more
  const WeightedPoint &p = spheres[uz(a)], &q = spheres[uz(b)];
  const double p2 = norm2(x - p.center), q2 = norm2(x - q.center);
  const double difference = (p2 - p.weight) - (q2 - q.weight);
  const double bound = kRounding * (p2 + std::abs(p.weight) + q2 + std::abs(q.weight));
  if (std::abs(difference) > bound) return difference < 0;
  PowerVertex at;
  at.simplex[0] = x;
  at.spheres[0] = q;
  return power_side(at, p) < 0;
}

// Whether the piece has a facet with one of the marked spheres.
bool borders(const Clipper& piece, const std::vector<std::uint8_t>& marked) {
  for (const PieceVertex& v : piece.vertices())
    for (const int p : v.planes)
      if (p >= kFirstBisector && marked[uz(piece.sphere_of_plane(p))]) return true;
  return false;
}

}  // namespace

struct RpdEngine::TetTables {
  std::vector<TetOwnership> ownership;
};

// Walks from cell to cell inside one tet; reused over the tets of one range.
struct RpdEngine::Worker {
  Worker(const RpdEngine& e) : engine(e), clipper(e.arithmetic_), seen(e.spheres_.size(), kInvalid) {}

  const RpdEngine& engine;
  Clipper clipper;
  std::vector<Index> seen;  // last tet in which the sphere was queued
  std::vector<Index> queue;
  PieceRecords records;

  // Appends the records of all pieces in the tet; returns (share of the Euler characteristic, consistent).
  std::pair<std::int32_t, bool> clip_tet(Index tet) {
    const auto begin = sizes(records);
    const auto corners = engine.corners_of(tet);
    std::int32_t euler = 0;
    bool consistent = true;
    queue.clear();
    push(tet, engine.seeds_[uz(engine.domain_.solid.tets[uz(tet)][0])]);
    for (std::size_t n = 0; n < queue.size(); ++n) {
      const Index sphere = queue[n];
      if (!clipper.clip(corners, engine.spheres_, sphere, engine.bisectors_of(sphere))) {
        consistent = false;
        continue;
      }
      consistent = consistent && !clipper.broken();
      if (clipper.broken()) continue;
      euler += append_piece(clipper, engine.domain_, engine.tables_->ownership[uz(tet)], tet, sphere, records);
      for (const int plane : clipper.planes())
        if (plane >= kFirstBisector) push(tet, clipper.sphere_of_plane(plane));
    }
    sort_tet_records(records, begin);
    return {euler, consistent};
  }

  void push(Index tet, Index sphere) {
    if (seen[uz(sphere)] == tet) return;
    seen[uz(sphere)] = tet;
    queue.push_back(sphere);
  }
};

RpdEngine::RpdEngine(const Domain& domain, Arithmetic arithmetic) : domain_(domain), arithmetic_(arithmetic) {
  tables_ = std::make_shared<const TetTables>(TetTables{tet_ownership(domain)});
}

std::span<const Index> RpdEngine::neighbors_of(Index sphere) const {
  const auto& n = triangulation_.neighbors();
  const Index begin = n.start[uz(sphere)];
  return {n.list.data() + begin, uz(n.start[uz(sphere) + 1] - begin)};
}

std::span<const Bisector> RpdEngine::bisectors_of(Index sphere) const {
  const auto& start = triangulation_.neighbors().start;
  return {bisectors_.data() + start[uz(sphere)], uz(start[uz(sphere) + 1] - start[uz(sphere)])};
}

void RpdEngine::find_bisectors(const Context& context) {
  const auto& neighbors = triangulation_.neighbors();
  bisectors_.resize(neighbors.list.size());
  parallel_for(context, count(spheres_), kSphereGrain, [&](Index begin, Index end) {
    for (Index s = begin; s < end; ++s)
      for (Index n = neighbors.start[uz(s)]; n < neighbors.start[uz(s) + 1]; ++n)
        bisectors_[uz(n)] = bisector(spheres_, s, neighbors.list[uz(n)]);
  });
}

std::array<Vec3, 4> RpdEngine::corners_of(Index tet) const {
  const Tetrahedron& v = domain_.solid.tets[uz(tet)];
  const auto& x = domain_.solid.vertices;
  return {x[uz(v[0])], x[uz(v[1])], x[uz(v[2])], x[uz(v[3])]};
}

void RpdEngine::compute(const std::vector<WeightedPoint>& spheres, const std::vector<Index>& absent,
                        const Context& context) {
  spheres_ = spheres;
  std::vector<bool> present(spheres.size(), true);
  for (const Index s : absent) present[uz(s)] = false;
  std::vector<Index> ids;
  for (Index s = 0; s < count(spheres); ++s)
    if (present[uz(s)]) ids.push_back(s);
  triangulation_ = {};
  triangulation_.update(spheres, ids, {});
  context.check();
  find_bisectors(context);
  const std::size_t tets = domain_.solid.tets.size();
  rpd_ = {};
  rpd_.start.assign(tets + 1, {});
  rpd_.euler.assign(tets, 0);
  seeds_.assign(domain_.solid.vertices.size(), kInvalid);
  std::vector<Index> all(tets);
  std::iota(all.begin(), all.end(), 0);
  locate_seeds(all, context);
  clip_tets(all, context);
}

void RpdEngine::update(const std::vector<WeightedPoint>& spheres, const std::vector<Index>& inserted,
                       const std::vector<Index>& removed, const Context& context) {
  spheres_ = spheres;
  std::vector<bool> before = triangulation_.visible();
  before.resize(spheres.size(), false);
  triangulation_.update(spheres, inserted, removed);
  find_bisectors(context);
  const std::vector<Index> tets = reached_tets(removed, before, context);
  locate_seeds(tets, context);
  clip_tets(tets, context);
}

// The least sphere, in power distance, at the first vertex of each given tet: greedy descent over the triangulation's
// edges, which cannot get stuck because power cells are convex.
void RpdEngine::locate_seeds(const std::vector<Index>& tets, const Context& context) {
  const auto& visible = triangulation_.visible();
  const auto first = std::find(visible.begin(), visible.end(), true);
  if (first == visible.end()) return;
  const auto fallback = static_cast<Index>(first - visible.begin());
  std::vector<Index> vertices;
  for (const Index t : tets) vertices.push_back(domain_.solid.tets[uz(t)][0]);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

  parallel_for(context, count(vertices), kTetGrain, [&](Index begin, Index end) {
    Index hint = fallback;
    for (Index n = begin; n < end; ++n) {
      const Vec3& x = domain_.solid.vertices[uz(vertices[uz(n)])];
      Index& seed = seeds_[uz(vertices[uz(n)])];
      Index best = seed != kInvalid && visible[uz(seed)] ? seed : hint;
      for (bool moved = true; moved;) {
        moved = false;
        for (const Index s : neighbors_of(best))
          if (nearer(spheres_, x, s, best)) {
            best = s;
            moved = true;
            break;
          }
      }
      seed = hint = best;
    }
  });
}

void RpdEngine::clip_tets(const std::vector<Index>& tets, const Context& context) {
  const Index ranges = (count(tets) + kTetGrain - 1) / kTetGrain;
  std::vector<PieceRecords> fresh(uz(ranges));
  std::vector<std::array<Index, 6>> begin(tets.size()), end(tets.size());
  std::vector<const PieceRecords*> source(tets.size());
  std::vector<std::uint8_t> consistent(tets.size(), 1);
  const bool any = std::find(visible().begin(), visible().end(), true) != visible().end();

  parallel_for(context, ranges, 8, [&](Index first, Index last) {
    Worker worker(*this);
    for (Index r = first; r < last; ++r) {
      worker.records = {};
      for (Index n = r * kTetGrain; n < std::min(count(tets), (r + 1) * kTetGrain); ++n) {
        begin[uz(n)] = sizes(worker.records);
        if (any) {
          const auto [euler, good] = worker.clip_tet(tets[uz(n)]);
          rpd_.euler[uz(tets[uz(n)])] = euler;
          consistent[uz(n)] = good;
        }
        end[uz(n)] = sizes(worker.records);
        source[uz(n)] = &fresh[uz(r)];
      }
      fresh[uz(r)] = std::move(worker.records);
    }
  });

  std::vector<Index> slot(domain_.solid.tets.size(), kInvalid);
  for (Index n = 0; n < count(tets); ++n) slot[uz(tets[uz(n)])] = n;
  std::vector<std::array<Index, 6>> start(rpd_.start.size());
  const auto source_of = [&](Index tet, std::size_t kind) -> Source {
    const Index n = slot[uz(tet)];
    if (n == kInvalid) return {nullptr, rpd_.start[uz(tet)][kind], rpd_.start[uz(tet) + 1][kind]};
    return {source[uz(n)], begin[uz(n)][kind], end[uz(n)][kind]};
  };
  const auto merge = [&](auto& records, std::size_t kind, auto member) {
    splice(records, kind, member, start, source_of, context);
  };
  merge(rpd_.cells, 0, &PieceRecords::cells);
  merge(rpd_.facets, 1, &PieceRecords::facets);
  merge(rpd_.edges, 2, &PieceRecords::edges);
  merge(rpd_.vertices, 3, &PieceRecords::vertices);
  merge(rpd_.stretches, 4, &PieceRecords::stretches);
  merge(rpd_.crossings, 5, &PieceRecords::crossings);
  rpd_.start = std::move(start);
  rpd_.broken += static_cast<Index>(std::count(consistent.begin(), consistent.end(), 0));
}

// Tets whose pieces change. A removed or newly hidden sphere frees the tets of its old pieces. An inserted sphere (or
// one that appears again) takes room only from those and from old cells that still border an inserted one, or only from
// pieces of theirs: an old piece is convex, so what is left of it, if anything, has a facet with an inserted sphere.
std::vector<Index> RpdEngine::reached_tets(const std::vector<Index>& removed, const std::vector<bool>& visible_before,
                                           const Context& context) const {
  const auto& now = triangulation_.visible();
  const Index n = count(spheres_);
  std::vector<std::uint8_t> is_new(uz(n), 0), losing(uz(n), 0), gone(uz(n), 0);
  for (Index s = 0; s < n; ++s) {
    if (!now[uz(s)] && visible_before[uz(s)]) gone[uz(s)] = 1;
    if (!now[uz(s)] || visible_before[uz(s)]) continue;
    is_new[uz(s)] = 1;
    for (const Index m : neighbors_of(s)) losing[uz(m)] = 1;
  }
  for (const Index s : removed)
    if (s < count(visible_before) && visible_before[uz(s)]) gone[uz(s)] = 1;

  std::vector<Index> reached, in_doubt;  // tets; cells
  for (Index c = 0; c < count(rpd_.cells); ++c) {
    const RpdCell& cell = rpd_.cells[uz(c)];
    if (gone[uz(cell.sphere)])
      reached.push_back(cell.tet);
    else if (losing[uz(cell.sphere)])
      in_doubt.push_back(c);
  }
  std::vector<std::uint8_t> changed(in_doubt.size(), 0);
  parallel_for(context, count(in_doubt), kTetGrain, [&](Index begin, Index end) {
    Clipper clipper(arithmetic_);
    std::vector<Bisector> inserted;
    const auto loses = [&](const RpdCell& cell, std::span<const Bisector> bisectors) {
      return !clipper.clip(corners_of(cell.tet), spheres_, cell.sphere, bisectors) || borders(clipper, is_new);
    };
    for (Index k = begin; k < end; ++k) {
      const RpdCell& cell = rpd_.cells[uz(in_doubt[uz(k)])];
      const std::span<const Bisector> bisectors = bisectors_of(cell.sphere);
      inserted.clear();
      for (const Bisector& b : bisectors)
        if (is_new[uz(b.other)]) inserted.push_back(b);
      changed[uz(k)] = loses(cell, inserted) && loses(cell, bisectors);  // few of them settle most pieces
    }
  });
  for (Index k = 0; k < count(in_doubt); ++k)
    if (changed[uz(k)]) reached.push_back(rpd_.cells[uz(in_doubt[uz(k)])].tet);
  std::sort(reached.begin(), reached.end());
  reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
  return reached;
}

void RpdEngine::piece(Index tet, Index sphere, Clipper& clipper) const {
  clipper.clip(corners_of(tet), spheres_, sphere, bisectors_of(sphere));
}

double total_volume(const Rpd& rpd) {
  double sum = 0;
  for (const RpdCell& c : rpd.cells) sum += c.volume;
  return sum;
}

Index total_euler(const Rpd& rpd) {
  return std::accumulate(rpd.euler.begin(), rpd.euler.end(), Index{0});
}

}  // namespace matstruct
