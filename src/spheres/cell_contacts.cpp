#include "spheres/cell_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <utility>

#include "base/index.h"

namespace matstruct {

namespace {

ContactCluster cluster_of(const VolumeSamples& samples, std::span<const Index> members) {
  ContactCluster cluster;
  double on_lines = 0;
  for (const Index m : members) {
    const VolumeSample& s = samples.samples[uz(m)];
    cluster.foot += s.foot * s.weight;
    cluster.normal += s.normal * s.weight;
    cluster.weight += s.weight;
    if (s.line != kInvalid) on_lines += s.weight, cluster.line = s.line;
  }
  cluster.foot = cluster.foot / cluster.weight;
  cluster.normal = cluster.normal / cluster.weight;
  if (on_lines < cluster.weight / 2) cluster.line = kInvalid;
  double nearest2 = std::numeric_limits<double>::infinity();
  for (const Index m : members) {
    const VolumeSample& s = samples.samples[uz(m)];
    if (const double d2 = distance2(s.foot, cluster.foot); d2 < nearest2) nearest2 = d2, cluster.triangle = s.triangle;
  }
  return cluster;
}

/// Appends the clusters of one cell, whose samples are sorted by cluster.
void add_cell(const VolumeSamples& samples, std::span<const Index> cell, UnionFind& sets, double least_share,
              CellContacts& out) {
  std::vector<std::pair<ContactCluster, std::span<const Index>>> found;
  double weight = 0;
  for (std::size_t begin = 0; begin < cell.size();) {
    std::size_t end = begin + 1;
    while (end < cell.size() && sets.find(cell[end]) == sets.find(cell[begin])) ++end;
    const std::span<const Index> members = cell.subspan(begin, end - begin);
    found.emplace_back(cluster_of(samples, members), members);
    weight += found.back().first.weight;
    begin = end;
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first.weight > b.first.weight; });
  for (const auto& [cluster, members] : found) {
    if (cluster.weight < least_share * weight) break;
    out.clusters.push_back(cluster);
    out.members.insert(out.members.end(), members.begin(), members.end());
    out.member_start.push_back(count(out.members));
  }
}

std::vector<Edge> links_between(const VolumeSamples& samples, std::span<const Index> owners, const CellContacts& out) {
  std::vector<Index> cluster(samples.samples.size(), kInvalid);
  for (Index c = 0; c < count(out.clusters); ++c)
    for (Index k = out.member_start[uz(c)]; k < out.member_start[uz(c) + 1]; ++k) cluster[uz(out.members[uz(k)])] = c;
  std::vector<Edge> links;
  for (Index s = 0; s < count(cluster); ++s) {
    if (cluster[uz(s)] == kInvalid) continue;
    for (Index k = samples.start[uz(s)]; k < samples.start[uz(s) + 1]; ++k) {
      const Index other = samples.list[uz(k)];
      if (cluster[uz(other)] != kInvalid && owners[uz(other)] != owners[uz(s)])
        links.push_back({cluster[uz(s)], cluster[uz(other)]});
    }
  }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

/// A sample in a grid of normals: those in one bucket differ by less than the angle.
struct Placed {
  Index patch = kInvalid;
  std::array<int, 3> bucket{};
  Index id = kInvalid;

  auto operator<=>(const Placed&) const = default;
  bool shares_bucket(const Placed& o) const { return patch == o.patch && bucket == o.bucket; }
  /// Whether all normals of the two buckets differ by more than the angle.
  bool is_far(const Placed& o) const {
    constexpr int kFar = 2;
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(bucket[k] - o.bucket[k]) > kFar) return true;
    return false;
  }
};

}  // namespace

void join_directions(std::span<const VolumeSample> samples, std::span<const Index> ids, double angle, UnionFind& sets) {
  angle = std::min(angle, std::numbers::pi);
  const double least = std::cos(angle);
  // The diagonal of a bucket is less than the chord of the angle.
  const double edge = 2 * std::sin(angle / 2) / std::numbers::sqrt3 * (1 - 1e-9);
  const auto place = [&](double x) { return static_cast<int>(std::floor(x / edge)); };
  std::vector<Placed> placed;
  std::vector<std::pair<Index, Index>> on_lines;  // line, sample
  for (const Index id : ids) {
    const VolumeSample& s = samples[uz(id)];
    placed.push_back({s.patch, {place(s.normal.x), place(s.normal.y), place(s.normal.z)}, id});
    if (s.line != kInvalid) on_lines.emplace_back(s.line, id);
  }
  std::sort(placed.begin(), placed.end());
  std::vector<std::span<const Placed>> buckets;
  for (std::size_t begin = 0, end = 0; begin < placed.size(); begin = end) {
    for (end = begin + 1; end < placed.size() && placed[end].shares_bucket(placed[begin]); ++end)
      sets.unite(placed[begin].id, placed[end].id);
    buckets.push_back(std::span(placed).subspan(begin, end - begin));
  }
  const auto agree = [&](const Placed& a, const Placed& b) {
    return dot(samples[uz(a.id)].normal, samples[uz(b.id)].normal) >= least;
  };
  const auto touch = [&](std::span<const Placed> some, std::span<const Placed> others) {
    return std::any_of(some.begin(), some.end(), [&](const Placed& a) {
      return std::any_of(others.begin(), others.end(), [&](const Placed& b) { return agree(a, b); });
    });
  };
  for (std::size_t i = 0; i < buckets.size(); ++i)
    for (std::size_t j = i + 1; j < buckets.size() && buckets[j][0].patch == buckets[i][0].patch; ++j) {
      const Placed &a = buckets[i][0], &b = buckets[j][0];
      if (sets.find(a.id) != sets.find(b.id) && !a.is_far(b) && touch(buckets[i], buckets[j])) sets.unite(a.id, b.id);
    }
  std::sort(on_lines.begin(), on_lines.end());
  for (std::size_t k = 1; k < on_lines.size(); ++k)
    if (on_lines[k].first == on_lines[k - 1].first) sets.unite(on_lines[k].second, on_lines[k - 1].second);
}

CellContacts cell_contacts(const VolumeSamples& samples, std::span<const Index> owners, Index spheres,
                           const ContactOptions& options) {
  const Index n = count(samples.samples);
  std::vector<Index> order;
  UnionFind sets(n);
  for (Index s = 0; s < n; ++s) {
    if (owners[uz(s)] < 0 || owners[uz(s)] >= spheres) continue;
    order.push_back(s);
    for (Index k = samples.start[uz(s)]; k < samples.start[uz(s) + 1]; ++k)
      if (owners[uz(samples.list[uz(k)])] == owners[uz(s)]) sets.unite(s, samples.list[uz(k)]);
  }
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::pair(owners[uz(a)], a) < std::pair(owners[uz(b)], b); });
  CellContacts out;
  out.start.push_back(0);
  out.member_start.push_back(0);
  std::size_t begin = 0;
  for (Index sphere = 0; sphere < spheres; ++sphere) {
    std::size_t end = begin;
    while (end < order.size() && owners[uz(order[end])] == sphere) ++end;
    const std::span<Index> cell = std::span(order).subspan(begin, end - begin);
    join_directions(samples.samples, cell, options.same_direction, sets);
    std::sort(cell.begin(), cell.end(),
              [&](Index a, Index b) { return std::pair(sets.find(a), a) < std::pair(sets.find(b), b); });
    add_cell(samples, cell, sets, options.least_share, out);
    out.start.push_back(count(out.clusters));
    begin = end;
  }
  out.links = links_between(samples, owners, out);
  return out;
}

Index contact_order(const CellContacts& contacts, Index sphere) {
  return contacts.start[uz(sphere) + 1] - contacts.start[uz(sphere)];
}

bool goes_on(const CellContacts& contacts, Index cell, Index other) {
  const Index low = contacts.start[uz(other)], high = contacts.start[uz(other) + 1];
  for (Index c = contacts.start[uz(cell)]; c < contacts.start[uz(cell) + 1]; ++c) {
    const auto link = std::lower_bound(contacts.links.begin(), contacts.links.end(), Edge{c, low});
    if (link == contacts.links.end() || (*link)[0] != c || (*link)[1] >= high) return false;
  }
  return true;
}

bool is_valid_edge(const CellContacts& contacts, const Edge& edge) {
  return goes_on(contacts, edge[0], edge[1]) || goes_on(contacts, edge[1], edge[0]);
}

bool is_valid_face(const CellContacts& contacts, const Triangle& face) {
  return is_valid_edge(contacts, {face[0], face[1]}) && is_valid_edge(contacts, {face[1], face[2]}) &&
         is_valid_edge(contacts, {face[0], face[2]});
}

}  // namespace matstruct
