#include "preserve/lines.h"

#include <cmath>

#include "base/index.h"
#include "base/tolerances.h"
#include "spheres/feature_spheres.h"
#include "spheres/guards.h"

namespace matstruct {

namespace {

// Feature spheres nearer to each other than this share of the least reach are at one place.
constexpr double kSamePlace = 0.01;

// A feature sphere at its place on a line.
struct Station {
  double position = 0;
  Index sphere = kInvalid;
};

// A part of a line in the cell of one sphere.
struct Run {
  double begin = 0, end = 0;
  Index sphere = kInvalid;
};

// A line with its spheres in order and what the diagram says of it.
struct LineState {
  std::vector<Station> stations;
  std::vector<Run> runs;
  std::vector<Edge> crossings;
};

std::vector<LineState> line_states(const Domain& domain, const Spheres& spheres, const Rpd& rpd) {
  const auto& lines = domain.features.lines;
  std::vector<LineState> states(lines.size());
  std::vector<Index> corner_sphere(domain.surface.vertices.size(), kInvalid);
  for (Index s = 0; s < count(spheres.seeds); ++s) {
    const SphereSeed& seed = spheres.seeds[uz(s)];
    if (!spheres.alive[uz(s)]) continue;
    if (seed.type == SphereType::kCorner) corner_sphere[uz(seed.corner)] = s;
    if (seed.type == SphereType::kSharpEdge) states[uz(seed.line)].stations.push_back({seed.position, s});
  }
  std::vector<double> offset(domain.features.edges.size(), 0);
  std::vector<bool> reversed(domain.features.edges.size(), false);
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const FeatureLine& line = lines[l];
    for (std::size_t k = 0; k < line.edges.size(); ++k) {
      offset[uz(line.edges[k])] = static_cast<double>(k);
      reversed[uz(line.edges[k])] = domain.features.edges[uz(line.edges[k])].vertices[0] != line.vertices[k];
    }
    if (line.kind != EdgeKind::kConvex) continue;
    if (!line.closed) {
      states[l].stations.push_back({0, corner_sphere[uz(line.vertices.front())]});
      states[l].stations.push_back({static_cast<double>(line.edges.size()), corner_sphere[uz(line.vertices.back())]});
    }
    std::sort(states[l].stations.begin(), states[l].stations.end(),
              [](const Station& a, const Station& b) { return a.position < b.position; });
  }
  for (const RpdStretch& s : rpd.stretches) {
    const double base = offset[uz(s.sharp_edge)];
    const bool back = reversed[uz(s.sharp_edge)];
    states[uz(domain.features.edges[uz(s.sharp_edge)].line)].runs.push_back(
        {base + (back ? 1 - s.end : s.begin), base + (back ? 1 - s.begin : s.end), s.sphere});
  }
  for (const RpdCrossing& c : rpd.crossings)
    states[uz(domain.features.edges[uz(c.sharp_edge)].line)].crossings.push_back(c.spheres);
  for (LineState& state : states)
    std::sort(state.runs.begin(), state.runs.end(), [](const Run& a, const Run& b) {
      return std::tuple(a.begin, a.end, a.sphere) < std::tuple(b.begin, b.end, b.sphere);
    });
  return states;
}

std::vector<Edge> consecutive_pairs(const LineState& state, bool closed) {
  std::vector<Edge> pairs;
  const std::size_t n = state.stations.size();
  for (std::size_t k = 0; k + 1 < n + (closed ? 1 : 0); ++k) {
    const Index a = state.stations[k].sphere, b = state.stations[(k + 1) % n].sphere;
    pairs.push_back(ordered_edge(a, b));
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// Whether a run lies in the cell of a sphere that has its place there: between the spheres before and after its own.
bool in_place(const LineState& state, const Run& run, bool closed, double edges) {
  const auto& st = state.stations;
  const std::size_t n = st.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (st[k].sphere != run.sphere) continue;
    const double before = k > 0 ? st[k - 1].position : (closed ? st[n - 1].position - edges : 0);
    const double after = k + 1 < n ? st[k + 1].position : (closed ? st[0].position + edges : edges);
    if (run.begin >= before && run.end <= after) return true;
    if (closed && run.begin + edges >= before && run.end + edges <= after) return true;
    if (closed && run.begin - edges >= before && run.end - edges <= after) return true;
  }
  return false;
}

bool preserved(const LineState& state, const std::vector<Edge>& pairs) {
  for (const Run& run : state.runs)
    if (std::none_of(state.stations.begin(), state.stations.end(),
                     [&](const Station& s) { return s.sphere == run.sphere; }))
      return false;
  return std::all_of(state.crossings.begin(), state.crossings.end(),
                     [&](const Edge& e) { return std::binary_search(pairs.begin(), pairs.end(), e); });
}

// The end of `line` at which `other` ends too and that is nearer to `x`, as a surface vertex; kInvalid if there is
// none.
Index shared_end(const Domain& domain, const FeatureLine& line, const FeatureLine& other, const Vec3& x) {
  Index best = kInvalid;
  if (line.closed || other.closed) return best;
  const auto distance_from = [&](Index v) { return distance2(domain.surface.vertices[uz(v)], x); };
  for (const Index v : {line.vertices.front(), line.vertices.back()})
    if (v == other.vertices.front() || v == other.vertices.back())
      if (best == kInvalid || distance_from(v) < distance_from(best)) best = v;
  return best;
}

// Where to put a sphere against the stranger that holds a run: at the foot of the stranger's centre on the line's edge,
// from where it can never be dispossessed again by that stranger, whose ball does not reach the line. If the foot is
// not in the run, in the middle of the run; but against a sphere of no line at the foot all the same, as long as no
// sphere of the line between it and the run has been of no help: a sphere nearer to a corner would come between the
// corner and the seam that ends there.
// Not so against a sphere of another line that ends at the same corner: at a sharp angle the foot would be a stranger
// on that line in turn, nearer to the corner, and so on for ever. Spheres at one distance from the corner leave each
// other alone (the "shells" of Delaunay refinement, Ruppert 1995). That holds for spheres of one weight: not for
// guards.
double remedy(const Domain& domain, const Spheres& spheres, const FeatureLine& line, const LineState& state,
              const Run& run) {
  const SphereSeed& stranger = spheres.seeds[uz(run.sphere)];
  const auto k = std::min(static_cast<std::size_t>(run.begin), line.edges.size() - 1);
  const double start = static_cast<double>(k);
  const Vec3 a = point_on_line(domain, line, start);
  const Vec3 along = point_on_line(domain, line, start + 1) - a;
  if (stranger.line != kInvalid && !stranger.guard) {
    const Index corner = shared_end(domain, line, domain.features.lines[uz(stranger.line)], stranger.center);
    if (corner != kInvalid) {
      const Vec3& c = domain.surface.vertices[uz(corner)];
      const double shell = distance(stranger.center, c), edge = norm(along);
      // From the corner outwards along the run's edge.
      const double at_start = distance(a, c), at_end = distance(a + along, c);
      const double t = at_start < at_end ? (shell - at_start) / edge : 1 - (shell - at_end) / edge;
      if (t > 0 && t < 1) return start + t;
    }
  }
  const double foot = start + dot(stranger.center - a, along) / norm2(along);
  const double from = std::min(run.begin, foot), to = std::max(run.end, foot);
  const bool clear = foot > start && foot < start + 1 && stranger.line == kInvalid &&
                     std::none_of(state.stations.begin(), state.stations.end(),
                                  [&](const Station& s) { return s.position >= from && s.position <= to; });
  const bool in_run = foot > run.begin && foot < run.end;
  return in_run || clear ? foot : middle_of_line(domain, line, run.begin, run.end);
}

void propose(const Domain& domain, const Spheres& spheres, const FeatureReach& reach, Index l, const LineState& state,
             std::vector<SphereSeed>& out) {
  const FeatureLine& line = domain.features.lines[uz(l)];
  const double same_place = kSamePlace * tolerance::kFeatureReach * domain.diagonal;
  // A second sphere at one place hides the first or is hidden, as is one that another's greater reach covers: neither
  // would have the neighbours that it should.
  const auto taken = [&](double position) {
    const Vec3 x = point_on_line(domain, line, position);
    const double weight = reach.at(x) * reach.at(x);
    return std::any_of(state.stations.begin(), state.stations.end(), [&](const Station& s) {
      const SphereSeed& seed = spheres.seeds[uz(s.sphere)];
      return distance2(seed.center, x) <= same_place * same_place + std::abs(seed.reach * seed.reach - weight);
    });
  };
  for (const Run& run : state.runs) {
    if (in_place(state, run, line.closed, static_cast<double>(line.edges.size()))) continue;
    double position = remedy(domain, spheres, line, state, run);
    if (taken(position)) position = middle_of_line(domain, line, run.begin, run.end);
    if (taken(position)) continue;
    const Vec3 x = point_on_line(domain, line, position);
    out.push_back({x, 0, SphereType::kSharpEdge, l, kInvalid, position, reach.at(x)});
  }
}

// Spheres of the line that have no place on it, as one of the line with more reach holds theirs, are no stations.
void give_up_hidden(const Spheres& spheres, const LineState& state, std::vector<Index>& out) {
  std::vector<Index> of_line, seen;
  for (const Station& s : state.stations) of_line.push_back(s.sphere);
  for (const Run& run : state.runs) seen.push_back(run.sphere);
  std::sort(of_line.begin(), of_line.end());
  std::sort(seen.begin(), seen.end());
  for (const Station& s : state.stations) {
    if (spheres.seeds[uz(s.sphere)].type != SphereType::kSharpEdge) continue;
    if (std::binary_search(seen.begin(), seen.end(), s.sphere)) continue;
    if (std::any_of(state.runs.begin(), state.runs.end(), [&](const Run& run) {
          return run.begin <= s.position && s.position <= run.end &&
                 std::binary_search(of_line.begin(), of_line.end(), run.sphere);
        }))
      out.push_back(s.sphere);
  }
}

}  // namespace

LineCheck check_lines(const Domain& domain, const Spheres& spheres, const Rpd& rpd) {
  LineCheck check;
  const std::vector<LineState> states = line_states(domain, spheres, rpd);
  const FeatureReach reach(domain, spheres.seeds);
  for (Index l = 0; l < count(states); ++l) {
    const FeatureLine& line = domain.features.lines[uz(l)];
    if (line.kind != EdgeKind::kConvex) continue;
    ++check.lines;
    const std::vector<Edge> pairs = consecutive_pairs(states[uz(l)], line.closed);
    check.feature_edges.insert(check.feature_edges.end(), pairs.begin(), pairs.end());
    if (preserved(states[uz(l)], pairs)) {
      ++check.preserved;
      continue;
    }
    propose(domain, spheres, reach, l, states[uz(l)], check.edits.insert);
    give_up_hidden(spheres, states[uz(l)], check.edits.remove);
  }
  std::sort(check.feature_edges.begin(), check.feature_edges.end());
  return check;
}

}  // namespace matstruct
