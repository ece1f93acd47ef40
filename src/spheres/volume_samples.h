// Points inside the solid whose nearest surface points are known: stand-ins for the volume of power cells.
//
// A point x = p - t n on the inward normal of a surface point p projects on p as long as t does not exceed the radius
// R(p) of the shrinking ball. One pass of sphere shrinking over a dense set of surface points therefore gives samples
// that serve a whole computation, however the spheres move: only their owners change (spheres/power_owners.h).
#pragma once

#include <cstdint>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "prepare/domain.h"

namespace matstruct {

/// A point inside the solid with its nearest surface point. Internal units.
struct VolumeSample {
  Vec3 point;
  Vec3 foot;                  ///< a surface point nearest to `point`
  Vec3 normal;                ///< unit, from point to foot; very near the surface the triangle's normal
  Index triangle = kInvalid;  ///< holds the foot
  Index patch = kInvalid;     ///< part of the surface between convex sharp edges, named by its least triangle
  Index line = kInvalid;      ///< concave feature line that holds the foot; such a contact has a fan of normals
  double weight = 0;          ///< volume that the sample stands for
};

/// Samples, and which of them lie side by side on the surface: those of s are list[start[s]] .. list[start[s + 1]],
/// ascending; the relation is symmetric.
struct VolumeSamples {
  std::vector<VolumeSample> samples;
  std::vector<Index> start, list;
};

struct SampleOptions {
  double spacing = 0;  ///< of the medial spheres, internal units, > 0
  std::uint64_t seed = 1;
};

/// About 24 samples per square of the spacing on the surface, more on patches between convex edges that are narrower
/// than the spacing; fans of samples along concave lines and at vertices where they end. Depths are random, more of
/// them near the axis, where cells part, than near the surface. Every foot is the nearest surface point, verified by a
/// query. Costs a sphere shrinking per sample. The same for any number of threads.
VolumeSamples volume_samples(const Domain& domain, const SampleOptions& options, const Context& context);

/// Finds who lies beside whom, which fills `start`, `list` and the samples' patches: feet at most `reach` apart whose
/// triangles hang together within that reach of the foot without crossing a convex sharp edge.
void link_samples(const Domain& domain, double reach, const Context& context, VolumeSamples& samples);
/// The triangles on which samples beside one lie: those that hang together with its own within `reach` of its foot
/// without crossing a convex sharp edge, ascending.
void triangles_beside(const Domain& domain, const VolumeSample& sample, double reach, std::vector<Index>& reached);
/// Reach for samples of the density of volume_samples().
double link_reach(double spacing);

/// The sample for point `x` inside the solid, with its nearest surface point by a query; `guess`: a triangle near it.
VolumeSample project_sample(const Domain& domain, const Vec3& x, Index guess);

}  // namespace matstruct
