// Thinning by importance alone: all simplices valid, so that none goes for its stratum.
#pragma once

#include "extract/thinning.h"
#include "preserved.h"
#include "spheres/sheets.h"

namespace matstruct {

inline MedialMesh thinned_by_importance(const Preserved& p, const Options& options, const DualComplex& dual,
                                        double threshold) {
  Context context;
  context.threads = options.threads;
  FinderPool finders(p.domain, smooth_angle(options));
  const std::vector<TangentSphere> medial = with_contacts(finders, p.spheres, 0, context);
  const SimplexClasses classes{std::vector<std::uint8_t>(dual.edges.size(), 3),
                               std::vector<std::uint8_t>(dual.triangles.size(), 1)};
  return thin(p.domain, p.spheres, medial, dual, classes, p.result.lines.feature_edges, {threshold}, context).mesh;
}

}  // namespace matstruct
