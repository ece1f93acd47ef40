#include "spheres/cell_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <tuple>
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

/// Normals in one bucket of a grid differ by less than the angle; those of buckets further apart than kFar by more.
struct Bucket {
  Index patch = kInvalid;
  std::array<int, 3> place{};
  Index begin = 0, end = 0;  // in the order of the samples

  bool operator==(const Bucket& o) const { return patch == o.patch && place == o.place; }
  bool is_far(const Bucket& o) const {
    constexpr int kFar = 2;
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(place[k] - o.place[k]) > kFar) return true;
    return false;
  }
};

}  // namespace

void join_directions(std::span<const VolumeSample> samples, std::span<const Index> ids, double angle, UnionFind& sets) {
  angle = std::min(angle, std::numbers::pi);
  const double least = std::cos(angle);
  // The diagonal of a bucket is less than the chord of the angle.
  const double edge = 2 * std::sin(angle / 2) / std::numbers::sqrt3 * (1 - 1e-9);
  const auto sample = [&](Index id) -> const VolumeSample& { return samples[uz(id)]; };
  const auto bucket_of = [&](Index id) {
    const auto place = [&](double x) { return static_cast<int>(std::floor(x / edge)); };
    const Vec3& n = sample(id).normal;
    return Bucket{sample(id).patch, {place(n.x), place(n.y), place(n.z)}};
  };
  std::vector<Index> order(ids.begin(), ids.end());
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const Bucket p = bucket_of(a), q = bucket_of(b);
    return std::tie(p.patch, p.place, a) < std::tie(q.patch, q.place, b);
  });
  std::vector<Bucket> buckets;
  for (Index k = 0; k < count(order); ++k) {
    const Bucket bucket = bucket_of(order[uz(k)]);
    if (k > 0 && bucket == buckets.back()) {
      sets.unite(order[uz(k)], order[uz(k) - 1]);
    } else {
      buckets.push_back(bucket);
      buckets.back().begin = k;
    }
    buckets.back().end = k + 1;
  }
  const auto touch = [&](const Bucket& a, const Bucket& b) {
    for (Index i = a.begin; i < a.end; ++i)
      for (Index j = b.begin; j < b.end; ++j)
        if (dot(sample(order[uz(i)]).normal, sample(order[uz(j)]).normal) >= least) return true;
    return false;
  };
  for (std::size_t i = 0; i < buckets.size(); ++i)
    for (std::size_t j = i + 1; j < buckets.size() && buckets[j].patch == buckets[i].patch; ++j) {
      const Index a = order[uz(buckets[i].begin)], b = order[uz(buckets[j].begin)];
      if (sets.find(a) != sets.find(b) && !buckets[i].is_far(buckets[j]) && touch(buckets[i], buckets[j]))
        sets.unite(a, b);
    }
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return sample(a).line < sample(b).line; });
  for (std::size_t k = 1; k < order.size(); ++k)
    if (const Index line = sample(order[k]).line; line != kInvalid && line == sample(order[k - 1]).line)
      sets.unite(order[k], order[k - 1]);
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
