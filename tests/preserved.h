// A solid taken through the stages up to the preservation of topology and features.
#pragma once

#include "extract/thinning.h"
#include "model/spheres.h"
#include "pipeline/preserve_loop.h"
#include "prepare/domain.h"
#include "rpd/rpd.h"
#include "spheres/initial_spheres.h"

namespace matstruct {

struct Preserved {
  Domain domain;
  Spheres spheres;
  Rpd rpd;
  PreserveResult result;
};

inline Preserved preserved(const TetMesh& solid, const Options& options) {
  Context context;
  context.threads = options.threads;
  Preserved p{prepare_domain(solid, options, context), {}, {}, {}};
  p.spheres = initial_spheres(p.domain, options, context);
  RpdEngine engine(p.domain);
  engine.compute(weighted_points(p.spheres), context);
  FinderPool finders(p.domain, smooth_angle(options));
  p.result = preserve(p.domain, options, {}, finders, p.spheres, engine, context);
  p.rpd = engine.diagram();
  return p;
}

// Thinning with every simplex valid.
inline MedialMesh thinned(const Preserved& p, const DualComplex& dual, double importance) {
  Context context;
  std::vector<TangentSphere> medial;
  for (const SphereSeed& seed : p.spheres.seeds) medial.push_back({seed.center, seed.radius, {}});
  const SimplexClasses valid{std::vector<std::uint8_t>(dual.edges.size(), 3),
                             std::vector<std::uint8_t>(dual.triangles.size(), 1)};
  return thin(p.domain, p.spheres, medial, dual, valid, p.result.lines.feature_edges, {importance}, context).mesh;
}

}  // namespace matstruct
