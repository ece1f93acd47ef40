// A solid taken through the stages up to the preservation of topology and features.
#pragma once

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
  p.result = preserve(p.domain, options, {}, finders, p.spheres, engine, context);  // without seams
  p.rpd = engine.diagram();
  return p;
}

}  // namespace matstruct
