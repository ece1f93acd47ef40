// How far the faces of a medial mesh are from being medial.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <matstruct/error.h>
#include <matstruct/metrics.h>

#include "base/index.h"
#include "base/parallel.h"
#include "metrics/sampling.h"
#include "query/surface_query.h"

namespace matstruct {

namespace {

constexpr Index kGrain = 256;

}  // namespace

Medialness medialness(const MedialMesh& mesh, const TriSurface& surface, Index samples, Context& context) {
  if (surface.triangles.empty()) throw Error("the surface has no triangles: there is no distance to measure.");
  if (samples < 1) throw Error(fmt::format("{} samples are too few for medialness; take at least 1.", samples));
  if (mesh.faces.empty()) return {};
  std::vector<TriangleSample> places = sample_by_area(mesh.centers, mesh.faces, samples);
  for (Index f = 0; f < count(mesh.faces); ++f) places.push_back({f, 2.0 / 3, 0.5});

  const SurfaceQuery query(surface);
  std::vector<double> error(places.size());
  parallel_for(context, count(places), kGrain, [&](Index begin, Index end) {
    Index guess = kInvalid;
    for (Index p = begin; p < end; ++p) {
      const TriangleSample& place = places[uz(p)];
      const auto& [i, j, k] = mesh.faces[uz(place.triangle)];
      const Vec3 center = place.at(mesh.centers[uz(i)], mesh.centers[uz(j)], mesh.centers[uz(k)]);
      const SurfaceHit hit = query.closest_near(center, guess);
      error[uz(p)] =
          std::abs(place.at(mesh.radii[uz(i)], mesh.radii[uz(j)], mesh.radii[uz(k)]) - std::sqrt(hit.distance2));
      guess = hit.triangle;
    }
  });
  Medialness result;
  for (Index s = 0; s < samples; ++s) result.mean += error[uz(s)] / samples;
  result.max = *std::max_element(error.begin(), error.end());
  return result;
}

}  // namespace matstruct
