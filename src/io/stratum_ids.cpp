#include "io/stratum_ids.h"

#include "base/index.h"

namespace matstruct {

StratumIds::StratumIds(const Strata& strata)
    : seams(strata.sheets),
      boundaries(seams + count(strata.seams)),
      curves(boundaries + count(strata.boundaries)),
      junctions(curves + count(strata.curves)) {}

std::vector<Index> stratum_of_vertices(const MedialMesh& mesh, const Strata& strata) {
  std::vector<Index> stratum(mesh.centers.size(), kInvalid);
  const StratumIds ids(strata);
  // What comes later counts more; of one kind, the first counts.
  for (std::size_t f = mesh.faces.size(); f-- > 0;)
    for (const Index v : mesh.faces[f]) stratum[uz(v)] = strata.sheet_of_face[f];
  const auto put = [&](const std::vector<Curve>& curves, Index first) {
    for (Index k = count(curves); k-- > 0;)
      for (const Index v : curves[uz(k)].vertices) stratum[uz(v)] = first + k;
  };
  put(strata.boundaries, ids.boundaries);
  put(strata.curves, ids.curves);
  put(strata.seams, ids.seams);
  for (Index k = 0; k < count(strata.junctions); ++k) stratum[uz(strata.junctions[uz(k)])] = ids.junctions + k;
  return stratum;
}

}  // namespace matstruct
