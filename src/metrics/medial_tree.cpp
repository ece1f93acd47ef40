#include "metrics/medial_tree.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "base/index.h"

namespace matstruct {

namespace {

constexpr Index kLeafSize = 4;

}  // namespace

std::vector<MedialPrimitive> maximal_primitives(const MedialMesh& mesh) {
  std::vector<MedialPrimitive> result(mesh.faces.begin(), mesh.faces.end());
  std::vector<Edge> of_faces;
  std::vector<char> alone(mesh.centers.size(), 1);
  for (const auto& [i, j, k] : mesh.faces) {
    of_faces.insert(of_faces.end(), {ordered_edge(i, j), ordered_edge(j, k), ordered_edge(i, k)});
    alone[uz(i)] = alone[uz(j)] = alone[uz(k)] = 0;
  }
  std::sort(of_faces.begin(), of_faces.end());
  for (const auto& [i, j] : mesh.edges) {
    alone[uz(i)] = alone[uz(j)] = 0;
    if (!std::binary_search(of_faces.begin(), of_faces.end(), ordered_edge(i, j))) result.push_back({i, j, j});
  }
  for (Index v = 0; v < count(mesh.centers); ++v)
    if (alone[uz(v)]) result.push_back({v, v, v});
  return result;
}

MedialTree::MedialTree(const std::vector<Vec3>& centers, const std::vector<double>& radii,
                       std::vector<MedialPrimitive> primitives) {
  if (primitives.empty()) return;
  primitives_.reserve(primitives.size());
  for (const auto& p : primitives) {
    Primitive primitive;
    primitive.size = p[0] == p[1] ? 1 : (p[1] == p[2] ? 2 : 3);
    for (std::size_t k = 0; k < 3; ++k) primitive.balls[k] = {centers[uz(p[k])], radii[uz(p[k])]};
    const auto& [a, b, c] = primitive.balls;
    if (primitive.size == 3) primitive.slab = slab_frame(a, b, c);
    primitive.cones = {cone_frame(a, b), cone_frame(b, c), cone_frame(c, a)};
    primitives_.push_back(primitive);
  }
  nodes_.reserve(2 * primitives_.size());
  nodes_.push_back({bounds_of(0, count(primitives_))});
  build(0, 0, count(primitives_));
}

/// In the frame of the largest primitive: on a smooth sheet the others lie nearly in its plane.
BallBox MedialTree::bounds_of(Index first, Index last) const {
  const std::span<const Primitive> primitives(primitives_.begin() + first, primitives_.begin() + last);
  const auto size = [](const Primitive& p) {
    const auto& [a, b, c] = p.balls;
    return std::pair(triangle_area(a.center, b.center, c.center), distance2(a.center, b.center));
  };
  const auto largest = std::max_element(primitives.begin(), primitives.end(),
                                        [&](const Primitive& p, const Primitive& q) { return size(p) < size(q); });
  return BallBox(frame_of(largest->balls[0], largest->balls[1], largest->balls[2]), primitives);
}

/// Completes the node, whose bounds are there, for the primitives from `first` up to `last`.
void MedialTree::build(Index node, Index first, Index last) {
  if (last - first <= kLeafSize) {
    nodes_[uz(node)].first = first;
    nodes_[uz(node)].primitives = last - first;
    return;
  }
  const BallBox& box = nodes_[uz(node)].bounds;
  const Vec3& half = box.half;
  const std::size_t longest = half.x >= half.y && half.x >= half.z ? 0 : (half.y >= half.z ? 1 : 2);
  const auto position = [axis = box.frame.axes[longest]](const Primitive& p) {
    return dot(axis, p.balls[0].center + p.balls[1].center + p.balls[2].center);
  };
  const Index middle = first + (last - first) / 2;
  std::nth_element(primitives_.begin() + first, primitives_.begin() + middle, primitives_.begin() + last,
                   [&](const Primitive& p, const Primitive& q) { return position(p) < position(q); });
  const Index left = count(nodes_);
  nodes_[uz(node)].first = left;
  nodes_.push_back({bounds_of(first, middle)});
  nodes_.push_back({bounds_of(middle, last)});
  build(left, first, middle);
  build(left + 1, middle, last);
}

/// The hull of the balls lies on one side of each of its supporting planes; of these, one whose normal points from the
/// centres to `x` is nearly as far from `x` as the hull is. Far cheaper than the exact distance.
double MedialTree::lower_bound(const Primitive& primitive, const Vec3& x) {
  const auto& [a, b, c] = primitive.balls;
  const Vec3 normal = normalized(x - (a.center + b.center + c.center) / 3);
  const auto beyond = [&](const Ball& ball) { return dot(normal, x - ball.center) - ball.radius; };
  return std::min({beyond(a), beyond(b), beyond(c)});
}

MedialHit MedialTree::hit(const Primitive& primitive, const Vec3& x) {
  const auto& [a, b, c] = primitive.balls;
  if (primitive.size == 1) return {distance_to_ball(x, a), a};
  const PrimitiveHit h = primitive.size == 2 ? closest_on_cone(x, a, b, primitive.cones[0])
                                             : closest_on_slab(x, primitive.balls, primitive.slab, primitive.cones);
  return {h.distance, ball_at(a, b, c, h.weights)};
}

MedialHit MedialTree::closest(const Vec3& x) const {
  MedialHit best;
  traverse(x, best.distance, [&](const Primitive& p) {
    if (!(lower_bound(p, x) < best.distance)) return true;
    const MedialHit candidate = hit(p, x);
    if (candidate.distance < best.distance) best = candidate;
    return true;
  });
  return best;
}

bool MedialTree::covers(const Vec3& x, double depth) const {
  bool found = false;
  traverse(x, -depth, [&](const Primitive& p) {
    found = lower_bound(p, x) < -depth && hit(p, x).distance < -depth;
    return !found;
  });
  return found;
}

}  // namespace matstruct
