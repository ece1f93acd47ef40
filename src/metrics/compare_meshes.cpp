// Two medial meshes compared as sets of points with radii.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <matstruct/error.h>
#include <matstruct/metrics.h>

#include "base/index.h"
#include "base/parallel.h"
#include "geometry/primitives.h"
#include "metrics/medial_tree.h"
#include "metrics/sampling.h"
#include "query/surface_query.h"

namespace matstruct {

namespace {

constexpr Index kGrain = 256;

/// Points of a mesh of one dimension or another; those that count for the means come first.
struct MeshSamples {
  std::vector<Ball> balls;
  Index for_means = 0;
};

std::vector<Ball> on_faces(const MedialMesh& mesh, Index samples) {
  std::vector<Ball> balls;
  for (const TriangleSample& place : sample_by_area(mesh.centers, mesh.faces, samples)) {
    const auto& [i, j, k] = mesh.faces[uz(place.triangle)];
    balls.push_back({place.at(mesh.centers[uz(i)], mesh.centers[uz(j)], mesh.centers[uz(k)]),
                     place.at(mesh.radii[uz(i)], mesh.radii[uz(j)], mesh.radii[uz(k)])});
  }
  return balls;
}

/// Equally far apart along the edges without faces.
std::vector<Ball> on_lone_edges(const MedialMesh& mesh, const std::vector<MedialPrimitive>& primitives, Index samples) {
  std::vector<Edge> edges;
  std::vector<double> length_up_to;
  double total = 0;
  for (const auto& [i, j, k] : primitives) {
    if (i == j || j != k) continue;
    edges.push_back({i, j});
    length_up_to.push_back(total += distance(mesh.centers[uz(i)], mesh.centers[uz(j)]));
  }
  std::vector<Ball> balls;
  for (Index s = 0; s < samples && total > 0; ++s) {
    const double at = total * (s + 0.5) / samples;
    const auto found = std::upper_bound(length_up_to.begin(), length_up_to.end() - 1, at) - length_up_to.begin();
    const auto [i, j] = edges[static_cast<std::size_t>(found)];
    const double length = distance(mesh.centers[uz(i)], mesh.centers[uz(j)]);
    const double t = 1 - (length_up_to[static_cast<std::size_t>(found)] - at) / length;
    balls.push_back({lerp(mesh.centers[uz(i)], mesh.centers[uz(j)], t),
                     mesh.radii[uz(i)] + (mesh.radii[uz(j)] - mesh.radii[uz(i)]) * t});
  }
  return balls;
}

MeshSamples sample(const MedialMesh& mesh, const std::vector<MedialPrimitive>& primitives, Index samples) {
  MeshSamples result;
  const auto add = [&](const std::vector<Ball>& balls) {
    result.balls.insert(result.balls.end(), balls.begin(), balls.end());
    if (result.for_means == 0) result.for_means = count(balls);
  };
  add(on_faces(mesh, samples));
  add(on_lone_edges(mesh, primitives, samples));
  std::vector<Ball> vertices;
  for (std::size_t v = 0; v < mesh.centers.size(); ++v) vertices.push_back({mesh.centers[v], mesh.radii[v]});
  add(vertices);
  return result;
}

/// Nearest points of a mesh and their radii.
class MeshQuery {
 public:
  explicit MeshQuery(const MedialMesh& mesh)
      : mesh_(mesh), primitives_(maximal_primitives(mesh)), query_({mesh.centers, primitives_}) {}

  const std::vector<MedialPrimitive>& primitives() const { return primitives_; }
  Ball nearest(const Vec3& x) const {
    const auto& [i, j, k] = primitives_[uz(query_.closest(x).triangle)];
    const PrimitiveHit hit = closest_on_triangle(x, mesh_.centers[uz(i)], mesh_.centers[uz(j)], mesh_.centers[uz(k)]);
    const auto ball = [&](Index v) { return Ball{mesh_.centers[uz(v)], mesh_.radii[uz(v)]}; };
    return ball_at(ball(i), ball(j), ball(k), hit.weights);
  }

 private:
  const MedialMesh& mesh_;
  std::vector<MedialPrimitive> primitives_;
  SurfaceQuery query_;
};

MeshComparison::Side side(const MeshSamples& from, const MeshQuery& to, const Context& context) {
  std::vector<double> distances(from.balls.size()), differences(from.balls.size());
  parallel_for(context, count(from.balls), kGrain, [&](Index begin, Index end) {
    for (Index s = begin; s < end; ++s) {
      const Ball& ball = from.balls[uz(s)];
      const Ball nearest = to.nearest(ball.center);
      distances[uz(s)] = distance(ball.center, nearest.center);
      differences[uz(s)] = std::abs(ball.radius - nearest.radius);
    }
  });
  const auto mean = [&](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.begin() + from.for_means, 0.0) / from.for_means;
  };
  const auto greatest = [](const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
  };
  return {greatest(distances), mean(distances), greatest(differences), mean(differences)};
}

}  // namespace

double MeshComparison::hausdorff() const {
  return std::max(first_to_second.max_distance, second_to_first.max_distance);
}

MeshComparison compare_meshes(const MedialMesh& first, const MedialMesh& second, Index samples, Context& context) {
  if (first.centers.empty() || second.centers.empty())
    throw Error("a medial mesh has no spheres: there is nothing to compare.");
  if (samples < 1) throw Error(fmt::format("{} samples are too few for a comparison; take at least 1.", samples));
  const MeshQuery query_first(first), query_second(second);
  MeshComparison result;
  result.first_to_second = side(sample(first, query_first.primitives(), samples), query_second, context);
  result.second_to_first = side(sample(second, query_second.primitives(), samples), query_first, context);
  result.first = structure_counts(first);
  result.second = structure_counts(second);
  return result;
}

}  // namespace matstruct
