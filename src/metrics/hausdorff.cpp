// Two-sided Hausdorff distance between a surface and the envelope of a medial mesh, from samples on both sides with
// exact distances to the other side.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <fmt/format.h>

#include <matstruct/error.h>
#include <matstruct/metrics.h>

#include "base/index.h"
#include "base/parallel.h"
#include "base/tolerances.h"
#include "metrics/envelope.h"
#include "metrics/sampling.h"
#include "query/surface_query.h"

namespace matstruct {

namespace {

constexpr Index kMinSamples = 1000;
constexpr Index kGrain = 256;

/// Vertices of triangles, without points that belong to none.
std::vector<Vec3> used_vertices(const TriSurface& surface) {
  std::vector<char> used(surface.vertices.size(), 0);
  for (const Triangle& t : surface.triangles)
    for (const Index v : t) used[uz(v)] = 1;
  std::vector<Vec3> points;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) points.push_back(surface.vertices[v]);
  return points;
}

std::vector<Vec3> points_by_area(const TriSurface& surface, Index samples) {
  const auto& v = surface.vertices;
  std::vector<Vec3> points;
  for (const TriangleSample& place : sample_by_area(v, surface.triangles, samples)) {
    const auto [i, j, k] = surface.triangles[uz(place.triangle)];
    points.push_back(place.at(v[uz(i)], v[uz(j)], v[uz(k)]));
  }
  return points;
}

std::vector<double> distances(const std::vector<Vec3>& points, const std::function<double(const Vec3&)>& distance_to,
                              const Context& context) {
  std::vector<double> result(points.size());
  parallel_for(context, count(points), kGrain, [&](Index begin, Index end) {
    for (Index p = begin; p < end; ++p) result[uz(p)] = distance_to(points[uz(p)]);
  });
  return result;
}

double greatest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// 0 if the weights are.
double mean(const std::vector<double>& values, const std::vector<double>& weights) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  return total > 0 ? std::inner_product(values.begin(), values.end(), weights.begin(), 0.0) / total : 0;
}

void check_request(const TriSurface& surface, Index samples) {
  if (surface.triangles.empty()) throw Error("the surface has no triangles: there is no distance to measure.");
  if (samples < kMinSamples)
    throw Error(fmt::format("{} samples are too few for a distance; take at least {}.", samples, kMinSamples));
}

}  // namespace

double Hausdorff::percent() const {
  return 100 * std::max(surface_to_envelope, envelope_to_surface) / diagonal;
}

Hausdorff hausdorff_distance(const MedialMesh& mesh, const TriSurface& surface, Index samples, Context& context) {
  if (mesh.centers.empty()) throw Error("the medial mesh has no spheres: there is no envelope to measure.");
  check_request(surface, samples);
  std::vector<Vec3> on_surface = used_vertices(surface);
  Hausdorff result;
  result.diagonal = diagonal_of(surface);
  if (!(result.diagonal > 0)) throw Error("all points of the surface coincide: there is no distance to measure.");
  // Vertices count for the greatest distance, not for the mean.
  std::vector<double> weights(on_surface.size(), 0);
  const std::vector<Vec3> by_area = points_by_area(surface, samples);
  on_surface.insert(on_surface.end(), by_area.begin(), by_area.end());
  weights.resize(on_surface.size(), 1);

  const Envelope envelope(mesh, samples, tolerance::kOnEnvelope * result.diagonal, context);
  const auto to_envelope = distances(
      on_surface, [&](const Vec3& x) { return envelope.distance(x); }, context);
  result.surface_to_envelope = greatest(to_envelope);
  result.mean_surface_to_envelope = mean(to_envelope, weights);

  const SurfaceQuery query(surface);
  const auto to_surface = distances(
      envelope.samples().points, [&](const Vec3& x) { return std::sqrt(query.closest(x).distance2); }, context);
  result.envelope_to_surface = greatest(to_surface);
  result.mean_envelope_to_surface = mean(to_surface, envelope.samples().weights);
  return result;
}

SurfaceDistance surface_distance(const TriSurface& from, const TriSurface& to, Index samples, Context& context) {
  check_request(from, samples);
  check_request(to, samples);
  const SurfaceQuery query(to);
  const auto distance_to = [&](const Vec3& x) { return std::sqrt(query.closest(x).distance2); };
  SurfaceDistance result;
  result.of_vertices = distances(from.vertices, distance_to, context);
  const auto of_samples = distances(points_by_area(from, samples), distance_to, context);
  result.greatest = std::max(greatest(of_samples), greatest(distances(used_vertices(from), distance_to, context)));
  result.mean = mean(of_samples, std::vector<double>(of_samples.size(), 1));
  return result;
}

}  // namespace matstruct
