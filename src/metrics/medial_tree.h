// Signed distance to the union of many medial primitives, by a bounding volume hierarchy.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "base/index.h"
#include "geometry/primitives.h"
#include "metrics/ball_box.h"

namespace matstruct {

/// A slab of three balls; the last id is repeated for a cone, all three are equal for a ball.
using MedialPrimitive = std::array<Index, 3>;

/// The primitives of a mesh that are not part of another one: its faces, edges without faces and lone vertices.
std::vector<MedialPrimitive> maximal_primitives(const MedialMesh& mesh);

/// The primitive of a tree that is nearest to a point or, if the point is in several, in which it is deepest.
struct MedialHit {
  double distance = std::numeric_limits<double>::infinity();  ///< signed, negative inside
  Ball ball;                                                  ///< of the primitive, nearest to the point
};

/// Immutable; all queries may run in several threads at once.
class MedialTree {
 public:
  /// O(n log n). There may be no primitives.
  MedialTree(const std::vector<Vec3>& centers, const std::vector<double>& radii,
             std::vector<MedialPrimitive> primitives);

  /// Least signed distance to a primitive; infinite if there are none.
  MedialHit closest(const Vec3& x) const;
  /// The distances of closest() for many points at once: much faster for points that are near each other,
  /// which share the search. The same whatever the number of threads. Throws Cancelled if the context says so.
  std::vector<double> distances(const std::vector<Vec3>& points, const Context& context) const;
  /// True if `x` lies deeper than `depth` in some primitive. Faster than closest().
  bool covers(const Vec3& x, double depth) const;

 private:
  struct Node {
    BallBox bounds;
    Index first = 0;       // leaf: first primitive; inner node: left child, the right one is next to it
    Index primitives = 0;  // 0 for inner nodes
  };
  struct Primitive {
    std::array<Ball, 3> balls;
    int size = 1;
    std::optional<SlabFrame> slab;
    std::array<ConeFrame, 3> cones;  // from each ball to the next one
  };

  BallBox bounds_of(Index first, Index last) const;
  void build(Index node, Index first, Index last);
  static double lower_bound(const Primitive& primitive, const Vec3& x);
  void share(const std::vector<Vec3>& points, std::span<Index> ids, const std::vector<Index>& candidates,
             std::vector<double>& result) const;
  static MedialHit hit(const Primitive& primitive, const Vec3& x);
  template <class Visit>
  void traverse(const Vec3& x, const double& bound, const Visit& visit) const;

  /// Of the stack of a traversal: halving makes trees at most 32 levels deep, and a level leaves one node on the stack.
  static constexpr std::size_t kStackSize = 64;

  std::vector<Primitive> primitives_;
  std::vector<Node> nodes_;
};

/// Calls visit(primitive) for all primitives in nodes whose lower bound is less than `bound`, which visit may reduce,
/// the nearer child first. Stops when visit returns false.
template <class Visit>
void MedialTree::traverse(const Vec3& x, const double& bound, const Visit& visit) const {
  if (nodes_.empty()) return;
  struct Pending {
    Index node;
    double at_least;
  };
  std::array<Pending, kStackSize> stack;
  std::size_t size = 0;
  stack[size++] = {0, nodes_[0].bounds.lower_bound(x)};
  while (size > 0) {
    const auto [id, at_least] = stack[--size];
    if (!(at_least < bound)) continue;
    const Node& node = nodes_[uz(id)];
    if (node.primitives > 0) {
      for (Index p = node.first; p < node.first + node.primitives; ++p)
        if (!visit(primitives_[uz(p)])) return;
      continue;
    }
    Pending near{node.first, nodes_[uz(node.first)].bounds.lower_bound(x)};
    Pending far{node.first + 1, nodes_[uz(node.first + 1)].bounds.lower_bound(x)};
    if (far.at_least < near.at_least) std::swap(near, far);
    stack[size++] = far;
    stack[size++] = near;
  }
}

}  // namespace matstruct
