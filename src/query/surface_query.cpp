// Closest points: a depth-first walk of an 8-wide tree finds the nearest triangle (triangle_blocks.h), then one careful
// evaluation finds the point and the feature that holds it. Signs: J. A. Baerentzen and H. Aanaes, "Signed distance
// computation using the angle weighted pseudonormal", 2005.
#include "query/surface_query.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/index.h"
#include "base/tolerances.h"
#include "query/box_tree.h"
#include "query/triangle_blocks.h"
#include "query/triangle_point.h"

namespace matstruct {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

std::array<Vec3, 3> corners_of(const TriSurface& surface, Index t) {
  const Triangle& ids = surface.triangles[uz(t)];
  return {surface.vertices[uz(ids[0])], surface.vertices[uz(ids[1])], surface.vertices[uz(ids[2])]};
}

/// What several triangles share: the least of their ids, and a normal that tells inside from outside around it.
struct SharedFeature {
  Index triangle = std::numeric_limits<Index>::max();
  Vec3 normal;
  void add(Index t, const Vec3& weighted_normal) {
    triangle = std::min(triangle, t);
    normal += weighted_normal;
  }
};

/// The surface's vertices and edges with their pseudonormals.
struct SurfaceFeatures {
  std::vector<Vec3> face_normals;                    ///< unit, zero for triangles without area
  std::vector<SharedFeature> vertices;               ///< #V
  std::vector<SharedFeature> edges;                  ///< one for each pair of vertices joined by triangles
  std::vector<std::array<Index, 3>> triangle_edges;  ///< edge opposite local vertex k
};

/// Numbers the edges in the order of their vertex pairs.
void find_edges(const TriSurface& surface, SurfaceFeatures& features) {
  struct Side {
    Edge edge;
    Index triangle, local;
  };
  std::vector<Side> sides;
  sides.reserve(3 * surface.triangles.size());
  for (Index t = 0; t < count(surface.triangles); ++t) {
    const Triangle& v = surface.triangles[uz(t)];
    for (Index k = 0; k < 3; ++k) {
      const auto [lo, hi] = std::minmax(v[uz((k + 1) % 3)], v[uz((k + 2) % 3)]);
      sides.push_back({{lo, hi}, t, k});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.edge != b.edge ? a.edge < b.edge : a.triangle < b.triangle; });
  features.triangle_edges.resize(surface.triangles.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i == 0 || sides[i].edge != sides[i - 1].edge) features.edges.emplace_back();
    features.triangle_edges[uz(sides[i].triangle)][uz(sides[i].local)] = count(features.edges) - 1;
    features.edges.back().add(sides[i].triangle, features.face_normals[uz(sides[i].triangle)]);
  }
}

SurfaceFeatures find_features(const TriSurface& surface) {
  SurfaceFeatures features;
  features.vertices.resize(surface.vertices.size());
  for (Index t = 0; t < count(surface.triangles); ++t) {
    const std::array<Vec3, 3> p = corners_of(surface, t);
    const Vec3 normal = normalized(cross(p[1] - p[0], p[2] - p[0]));
    features.face_normals.push_back(normal);
    for (Index k = 0; k < 3; ++k) {
      const Vec3& a = p[uz(k)];
      const double angle = angle_between(p[uz((k + 1) % 3)] - a, p[uz((k + 2) % 3)] - a);
      features.vertices[uz(surface.triangles[uz(t)][uz(k)])].add(t, normal * angle);
    }
  }
  find_edges(surface, features);
  return features;
}

/// Boxes of the triangles, larger than they are by more than the rounding of a distance.
std::vector<Box> triangle_boxes(const TriSurface& surface) {
  double largest = 0;
  for (const Vec3& p : surface.vertices) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  const double growth = largest * tolerance::kDistanceRounding;
  std::vector<Box> boxes(surface.triangles.size());
  for (Index t = 0; t < count(boxes); ++t) {
    Box& box = boxes[uz(t)];
    for (const Vec3& p : corners_of(surface, t)) box.add(p);
    box.lo -= {growth, growth, growth};
    box.hi += {growth, growth, growth};
  }
  return boxes;
}

std::vector<TriangleBlock> fill_blocks(const TriSurface& surface, const BoxTree& tree) {
  std::vector<TriangleBlock> blocks(tree.leaves.size());
  for (Index leaf = 0; leaf < count(blocks); ++leaf) {
    const auto [first, size] = tree.leaves[uz(leaf)];
    for (Index k = 0; k < TriangleBlock::kSize; ++k) {
      const Index t = tree.order[uz(first + std::min(k, size - 1))];
      blocks[uz(leaf)].set(k, corners_of(surface, t), t);
    }
  }
  return blocks;
}

}  // namespace

struct SurfaceQuery::Impl {
  TriSurface surface;
  SurfaceFeatures features;
  BoxTree tree;
  std::vector<TriangleBlock> blocks;   ///< #leaves
  std::vector<Index> triangle_blocks;  ///< #triangles, the block of each

  explicit Impl(const TriSurface& source) : surface(source), features(find_features(surface)) {
    tree = build_box_tree(triangle_boxes(surface), TriangleBlock::kSize);
    blocks = fill_blocks(surface, tree);
    triangle_blocks.resize(surface.triangles.size());
    for (Index b = 0; b < count(blocks); ++b) {
      for (const Index t : blocks[uz(b)].id) triangle_blocks[uz(t)] = b;
    }
  }

  TrianglePoint nearest_on(Index triangle, const Vec3& p) const {
    return nearest_on_triangle(p, corners_of(surface, triangle), surface.triangles[uz(triangle)]);
  }

  /// A closest point with the pseudonormal of the vertex, edge or face that holds it.
  struct Located {
    SurfaceHit hit;
    Vec3 normal;
  };

  Located locate(const Vec3& p, double bound2, Index guess) const {
    const bool has_guess = guess >= 0 && guess < count(triangle_blocks);
    const Index first = has_guess ? triangle_blocks[uz(guess)] : kInvalid;
    const NearestTriangle nearest = nearest_triangle(tree, blocks, p, bound2, first);
    if (nearest.triangle == kInvalid) return {};
    const TrianglePoint q = nearest_on(nearest.triangle, p);
    Located result{{q.distance2, q.point, nearest.triangle}, features.face_normals[uz(nearest.triangle)]};
    if (q.feature == TriangleFeature::kFace) return result;
    // Which of the triangles around an edge or vertex was found is a matter of rounding: name the least.
    const SharedFeature& shared = q.feature == TriangleFeature::kVertex
                                      ? features.vertices[uz(surface.triangles[uz(nearest.triangle)][uz(q.local)])]
                                      : features.edges[uz(features.triangle_edges[uz(nearest.triangle)][uz(q.local)])];
    result.hit.triangle = shared.triangle;
    result.normal = shared.normal;
    return result;
  }
};

SurfaceQuery::SurfaceQuery(const TriSurface& surface) : impl_(std::make_unique<Impl>(surface)) {}
SurfaceQuery::~SurfaceQuery() = default;
SurfaceQuery::SurfaceQuery(SurfaceQuery&&) noexcept = default;
SurfaceQuery& SurfaceQuery::operator=(SurfaceQuery&&) noexcept = default;

SurfaceHit SurfaceQuery::closest(const Vec3& p, double bound2) const {
  return impl_->locate(p, bound2, kInvalid).hit;
}

SurfaceHit SurfaceQuery::closest_near(const Vec3& p, Index triangle_guess) const {
  return impl_->locate(p, kNoBound, triangle_guess).hit;
}

SurfaceHit SurfaceQuery::closest_on(Index triangle, const Vec3& p) const {
  const TrianglePoint q = impl_->nearest_on(triangle, p);
  return {q.distance2, q.point, triangle};
}

void SurfaceQuery::within(const Vec3& p, double reach, std::vector<Index>& triangles) const {
  triangles.clear();
  triangles_within(impl_->tree, impl_->blocks, p, reach * reach, triangles);
  std::sort(triangles.begin(), triangles.end());
}

bool SurfaceQuery::inside(const Vec3& p) const {
  return signed_distance(p) < 0;
}

double SurfaceQuery::signed_distance(const Vec3& p, Index triangle_guess) const {
  const Impl::Located located = impl_->locate(p, kNoBound, triangle_guess);
  const double d = std::sqrt(located.hit.distance2);
  return dot(p - located.hit.point, located.normal) < 0 ? -d : d;
}

}  // namespace matstruct
