#include "reconstruct/level_set.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>

#include "base/index.h"

namespace matstruct {

namespace {

using Order = std::array<std::size_t, 4>;
/// Even permutations: by their first element, and by their first two.
constexpr std::array<Order, 4> kFirst{{{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 0, 1, 3}, {3, 0, 2, 1}}};
constexpr std::array<Order, 6> kFirstTwo{
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

class March {
 public:
  March(const std::vector<Vec3>& places, const std::vector<double>& values, double margin)
      : places_(places), values_(values), margin_(margin) {
    vertex_.reserve(places.size());
  }

  void add(const Tetrahedron& tet) {
    std::array<bool, 4> in{};
    for (std::size_t k = 0; k < 4; ++k) in[k] = values_[uz(tet[k])] < 0;
    const auto inside = std::count(in.begin(), in.end(), true);
    if (inside == 0 || inside == 4) return;
    if (inside == 2) {
      const auto [v, w, a, b] = *std::find_if(kFirstTwo.begin(), kFirstTwo.end(),
                                              [&](const Order& order) { return in[order[0]] == in[order[1]]; });
      const std::array<Index, 4> quad{on(tet[v], tet[a]), on(tet[v], tet[b]), on(tet[w], tet[b]), on(tet[w], tet[a])};
      emit(quad[0], quad[1], quad[2], in[v]);
      emit(quad[0], quad[2], quad[3], in[v]);
      return;
    }
    const bool alone = inside == 1;  // what the single vertex is
    const auto [v, a, b, c] =
        *std::find_if(kFirst.begin(), kFirst.end(), [&](const Order& order) { return in[order[0]] == alone; });
    emit(on(tet[v], tet[a]), on(tet[v], tet[b]), on(tet[v], tet[c]), alone);
  }
  TriSurface result() && { return std::move(surface_); }

 private:
  /// The vertex on an edge whose ends have different signs.
  Index on(Index a, Index b) {
    if (a > b) std::swap(a, b);
    const std::uint64_t key = static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b);
    const auto [found, added] = vertex_.try_emplace(key, count(surface_.vertices));
    if (added) {
      const Vec3 &p = places_[uz(a)], &q = places_[uz(b)];
      const double margin = std::min(0.1, margin_ / distance(p, q));
      const double t = values_[uz(a)] / (values_[uz(a)] - values_[uz(b)]);
      surface_.vertices.push_back(lerp(p, q, std::clamp(t, margin, 1 - margin)));
    }
    return found->second;
  }
  void emit(Index a, Index b, Index c, bool outward) {
    surface_.triangles.push_back(outward ? Triangle{a, b, c} : Triangle{a, c, b});
  }

  const std::vector<Vec3>& places_;
  const std::vector<double>& values_;
  double margin_;
  TriSurface surface_;
  std::unordered_map<std::uint64_t, Index> vertex_;  // of an edge
};

}  // namespace

TriSurface march(const std::vector<Vec3>& places, const std::vector<double>& values,
                 const std::vector<Tetrahedron>& tets, double margin) {
  March cells(places, values, margin);
  for (const Tetrahedron& tet : tets) cells.add(tet);
  return std::move(cells).result();
}

}  // namespace matstruct
