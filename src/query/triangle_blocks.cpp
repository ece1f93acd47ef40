// The hot loops, four lanes at a time. On x86 a second copy of the search, for AVX2, is compiled and chosen when the
// program loads. Both copies do the same operations in the same order and none is fused, so that the result is the same
// to the bit.
#include "query/triangle_blocks.h"

#include <cstddef>

#include "base/index.h"
#include "base/tolerances.h"
#include "query/triangle_point.h"

#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define MATSTRUCT_SIMD_COPIES __attribute__((target_clones("avx2", "default"), flatten))
#else
#define MATSTRUCT_SIMD_COPIES
#endif

// Vectors pass through inlined functions only, so that how calls would pass them does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace matstruct {
namespace {

// Four lanes of a GCC/Clang vector type: one AVX2 register, two SSE2 ones.
using Four = double __attribute__((vector_size(32)));
using FourVec3 = std::array<Four, 3>;
constexpr std::size_t kLanes = 4;
static_assert(TriangleBlock::kSize == kLanes && BoxTree::kWidth % kLanes == 0);

inline Four load(const double* aligned) {
  return *reinterpret_cast<const Four*>(aligned);
}
inline void store(const Four& v, double* aligned) {
  *reinterpret_cast<Four*>(aligned) = v;
}
inline FourVec3 load(const std::array<TriangleBlock::Lanes, 3>& v) {
  return {load(v[0].data()), load(v[1].data()), load(v[2].data())};
}
inline Four splat(double x) {
  return Four{x, x, x, x};
}
inline Four least(const Four& a, const Four& b) {
  return a < b ? a : b;
}
inline Four greatest(const Four& a, const Four& b) {
  return a > b ? a : b;
}
inline Four clamp01(const Four& t) {
  return least(greatest(t, splat(0)), splat(1));
}
inline Four dot(const FourVec3& a, const FourVec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline FourVec3 minus(const FourVec3& a, const FourVec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline FourVec3 plus(const FourVec3& a, const FourVec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline FourVec3 times(const Four& s, const FourVec3& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
inline Four length2(const FourVec3& a) {
  return dot(a, a);
}
/// Squared distances from `p` to the eight boxes of a node; those of unused slots mean nothing.
inline void box_distances(const BoxTree::Node& node, const FourVec3& p, double* out) {
  for (std::size_t first = 0; first < BoxTree::kWidth; first += kLanes) {
    FourVec3 d;
    for (std::size_t x = 0; x < 3; ++x) {
      const Four below = load(&node.lo[x][first]) - p[x], above = p[x] - load(&node.hi[x][first]);
      d[x] = greatest(greatest(below, above), splat(0));
    }
    store(length2(d), out + first);
  }
}

/// Squared distances from `p` to the triangles of a block: the least of those to the three edges and, where `p`
/// projects into the triangle, to the projection. All candidates are points of the triangle: none can be too near.
inline Four triangle_distances(const TriangleBlock& block, const FourVec3& p) {
  const FourVec3 ab = load(block.ab), h = load(block.h);
  const Four k = load(block.k.data());
  const FourVec3 ac = plus(times(k, ab), h), bc = minus(ac, ab);
  const FourVec3 ap = minus(p, load(block.a)), bp = minus(ap, ab);

  const Four s = dot(ap, ab) * load(block.inv_ab2.data());
  const Four t = dot(ap, ac) * load(block.inv_ac2.data());
  const Four u = dot(bp, bc) * load(block.inv_bc2.data());
  const Four to_ab = length2(minus(ap, times(clamp01(s), ab)));
  const Four to_ac = length2(minus(ap, times(clamp01(t), ac)));
  const Four to_bc = length2(minus(bp, times(clamp01(u), bc)));
  const Four to_edges = least(to_ab, least(to_ac, to_bc));

  const Four w = dot(ap, h) * load(block.inv_h2.data());
  const Four v = s - w * k;
  const Four to_projection = length2(minus(minus(ap, times(s, ab)), times(w, h)));
  const Four margin = least(least(v, w), splat(1) - v - w);  // not negative: p projects into the triangle
  return margin >= splat(0) ? least(to_edges, to_projection) : to_edges;
}

/// The nearer of `best` and the triangles of a block.
inline NearestTriangle nearer(const NearestTriangle& best, const TriangleBlock& block, const FourVec3& p) {
  alignas(64) TriangleBlock::Lanes d;
  store(triangle_distances(block, p), d.data());
  NearestTriangle result = best;
  for (std::size_t k = 0; k < d.size(); ++k) {
    if (d[k] < result.distance2 || (d[k] == result.distance2 && block.id[k] < result.triangle)) {
      result = {d[k], block.id[k]};
    }
  }
  return result;
}

struct Entry {
  double distance2;
  Index child;
};

}  // namespace

void TriangleBlock::set(int slot, const std::array<Vec3, 3>& corners, Index triangle) {
  const TriangleFrame frame(corners);
  const auto lane = static_cast<std::size_t>(slot);
  for (int axis = 0; axis < 3; ++axis) {
    const auto x = static_cast<std::size_t>(axis);
    a[x][lane] = frame.a[axis], ab[x][lane] = frame.ab[axis], h[x][lane] = frame.h[axis];
  }
  const auto inverse = [](double x) { return x > 0 ? 1 / x : 0; };
  const Vec3 ac = frame.ab * frame.k + frame.h;
  k[lane] = frame.k;
  inv_ab2[lane] = inverse(norm2(frame.ab)), inv_h2[lane] = inverse(norm2(frame.h));
  inv_ac2[lane] = inverse(norm2(ac)), inv_bc2[lane] = inverse(norm2(ac - frame.ab));
  id[lane] = triangle;
}

MATSTRUCT_SIMD_COPIES
NearestTriangle nearest_triangle(const BoxTree& tree, const std::vector<TriangleBlock>& blocks, const Vec3& p,
                                 double bound2, Index first) {
  const FourVec3 p4{splat(p.x), splat(p.y), splat(p.z)};
  NearestTriangle best{bound2, std::numeric_limits<Index>::max()};
  if (first != kInvalid) best = nearer(best, blocks[uz(first)], p4);
  Entry stack[BoxTree::kMaxStack];
  int top = 0;
  if (!tree.nodes.empty()) stack[top++] = {0, 0};
  while (top > 0) {
    const Entry entry = stack[--top];
    // A box is dropped only if it is farther by more than the rounding of the triangles' distances.
    const double limit = best.distance2 * tolerance::kPruneSlack;
    if (entry.distance2 > limit) continue;
    if (entry.child < 0) {
      best = nearer(best, blocks[uz(~entry.child)], p4);
      continue;
    }
    const BoxTree::Node& node = tree.nodes[uz(entry.child)];
    alignas(64) std::array<double, BoxTree::kWidth> d;
    box_distances(node, p4, d.data());
    const int base = top;
    for (Index k = 0; k < node.children; ++k) {
      if (!(d[uz(k)] <= limit)) continue;
      int at = top++;  // insertion sort: the nearest child ends on top
      for (; at > base && stack[at - 1].distance2 < d[uz(k)]; --at) stack[at] = stack[at - 1];
      stack[at] = {d[uz(k)], node.child[uz(k)]};
    }
  }
  if (best.triangle == std::numeric_limits<Index>::max()) return {};
  return best;
}

MATSTRUCT_SIMD_COPIES
void triangles_within(const BoxTree& tree, const std::vector<TriangleBlock>& blocks, const Vec3& p, double bound2,
                      std::vector<Index>& triangles) {
  const FourVec3 p4{splat(p.x), splat(p.y), splat(p.z)};
  const double limit = bound2 * tolerance::kPruneSlack;
  Index stack[BoxTree::kMaxStack];
  int top = 0;
  if (!tree.nodes.empty()) stack[top++] = 0;
  while (top > 0) {
    const Index child = stack[--top];
    if (child < 0) {
      const TriangleBlock& block = blocks[uz(~child)];
      alignas(64) TriangleBlock::Lanes d;
      store(triangle_distances(block, p4), d.data());
      for (std::size_t k = 0; k < d.size(); ++k)
        if (d[k] <= limit && (k == 0 || block.id[k] != block.id[k - 1])) triangles.push_back(block.id[k]);
      continue;
    }
    const BoxTree::Node& node = tree.nodes[uz(child)];
    alignas(64) std::array<double, BoxTree::kWidth> d;
    box_distances(node, p4, d.data());
    for (Index k = 0; k < node.children; ++k)
      if (d[uz(k)] <= limit) stack[top++] = node.child[uz(k)];
  }
}

}  // namespace matstruct
