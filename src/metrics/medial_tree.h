// Signed distance to the union of many medial primitives, by a bounding volume hierarchy.
#pragma once

#include <limits>
#include <vector>

#include <matstruct/types.h>

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
  };

  BallBox bounds_of(Index first, Index last) const;
  void build(Index node, Index first, Index last);
  static double lower_bound(const Primitive& primitive, const Vec3& x);
  static MedialHit hit(const Primitive& primitive, const Vec3& x);
  template <class Visit>
  void traverse(const Vec3& x, const double& bound, const Visit& visit) const;

  std::vector<Primitive> primitives_;
  std::vector<Node> nodes_;
};

}  // namespace matstruct
