#include "prepare/radial_pairs.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/index.h"
#include "geometry/exact.h"
#include "prepare/closed_surface.h"

namespace matstruct {

namespace {

// A triangle at an edge, which it runs along from the lower to the upper vertex (`up`) or back.
struct Page {
  Index triangle = 0, local = 0, apex = 0;
  bool up = true;
};

// Order of pages by their angle around the edge from `a` to `b`, counted from the half-plane of a first one.
class AroundEdge {
 public:
  AroundEdge(const TriSurface& surface, Index a, Index b, Index first)
      : surface_(surface), a_(a), b_(b), first_(first) {}

  bool operator()(const Page& p, const Page& q) const {
    const int in_p = quarter(p.apex), in_q = quarter(q.apex);
    if (in_p != in_q) return in_p < in_q;
    return in_p % 2 == 1 && side(p.apex, q.apex) > 0;
  }

 private:
  const Vec3& point(Index v) const { return surface_.vertices[uz(v)]; }
  int side(Index p, Index q) const { return orientation(point(a_), point(b_), point(p), point(q)); }

  // 0: the first half-plane; 1: less than half a turn from it; 2: opposite; 3: more.
  int quarter(Index p) const {
    const int s = side(first_, p);
    if (s != 0) return s > 0 ? 1 : 3;
    const Vec3 axis = point(b_) - point(a_);
    return dot(cross(axis, point(first_) - point(a_)), cross(axis, point(p) - point(a_))) > 0 ? 0 : 2;
  }

  const TriSurface& surface_;
  Index a_, b_, first_;
};

}  // namespace

std::vector<std::array<Index, 3>> pair_across_material(const TriSurface& surface, const VertexName& name) {
  struct Entry {
    Edge edge;
    Page page;
  };
  std::vector<Entry> entries;
  for (Index t = 0; t < count(surface.triangles); ++t)
    for (Index k = 0; k < 3; ++k) {
      const Triangle& v = surface.triangles[uz(t)];
      const Index a = v[uz((k + 1) % 3)], b = v[uz((k + 2) % 3)];
      entries.push_back({ordered_edge(a, b), {t, k, v[uz(k)], a < b}});
    }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.page.triangle < b.page.triangle;
  });
  std::vector<std::array<Index, 3>> neighbors(surface.triangles.size(), {kInvalid, kInvalid, kInvalid});
  std::vector<Page> pages;
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    const Edge edge = entries[begin].edge;
    pages.clear();
    for (; end < entries.size() && entries[end].edge == edge; ++end) pages.push_back(entries[end].page);
    std::sort(pages.begin(), pages.end(), AroundEdge(surface, edge[0], edge[1], pages.front().apex));
    // Seen along the edge a page that runs up has its material clockwise, before itself in this order.
    for (std::size_t i = 0; i < pages.size(); ++i) {
      const Page &page = pages[i],
                 &other = pages[page.up ? (i + pages.size() - 1) % pages.size() : (i + 1) % pages.size()];
      if (page.up == other.up)
        throw SurfaceError(pages.size() % 2 == 1 ? SurfaceDefect::kOpen : SurfaceDefect::kCrowdedEdge,
                           fmt::format("the surface does not separate inside and outside at the edge from {} to {}.",
                                       name(edge[0]), name(edge[1])));
      neighbors[uz(page.triangle)][uz(page.local)] = other.triangle;
    }
  }
  return neighbors;
}

}  // namespace matstruct
