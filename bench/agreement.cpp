// Contacts of the spheres of one model beside the paper's way of finding them (tests/cell_reference.h), for
// bench/run_agreement.py. Prints one JSON object: "samples" compares the volume samples on the first spheres, completed
// to `per_cell` in each cell, which is what the reference has; "few_samples" the same with 200; "contacts" the exact
// contacts of the finished mesh's spheres with a reference of 200. No more than `most` spheres of each.
//
//   agreement FILE [GAMMA [MOST [PER_CELL]]]
#include <cstdio>
#include <cstdlib>
#include <string>

#include <nlohmann/json.hpp>

#include <matstruct/compute.h>

#include "../tests/cell_reference.h"

namespace {

constexpr int kFewSamples = 200;

using namespace matstruct;
using Json = nlohmann::ordered_json;

Json json_of(const reference::Agreement& a) {
  return {{"compared", a.compared},
          {"equal", a.equal},
          {"references_equal", a.references_equal},
          {"equal_where_sure", a.equal_where_sure},
          {"disputed", a.disputed},
          {"ours_right", a.ours_right},
          {"reference_right", a.reference_right},
          {"our_seconds", a.our_seconds},
          {"reference_seconds", a.reference_seconds}};
}

reference::Agreement of_contacts(const Domain& domain, const Result& result, double spacing, Index most,
                                 const Context& context) {
  Spheres spheres;
  for (std::size_t v = 0; v < result.mesh.centers.size(); ++v)
    spheres.add({.center = domain.frame.unrounded(result.mesh.centers[v]),
                 .radius = result.mesh.radii[v] * domain.frame.scale,
                 .type = result.mesh.types[v]});
  const CellModel model(domain, std::move(spheres), spacing, context);
  std::vector<Index> medial, ours;
  for (Index v = 0; v < count(result.mesh.centers); ++v)
    if (result.mesh.radii[uz(v)] > 0) medial.push_back(v);
  const std::vector<Index> compared = reference::some_of(medial, most);
  for (const Index v : compared) ours.push_back(result.contacts.of(v));
  const auto judge = [&](const std::vector<Index>& disputed) {
    return reference::orders_of_centers(model, disputed, spacing, context);
  };
  return reference::agreement(model, compared, ours, kFewSamples, judge, context);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: agreement FILE [GAMMA [MOST [PER_CELL]]]\n");
    return 2;
  }
  try {
    Options options;
    options.samples = 1000;
    if (argc > 2) options.gamma = std::atof(argv[2]);
    const Index most = argc > 3 ? std::atoi(argv[3]) : 500;
    const int per_cell = argc > 4 ? std::atoi(argv[4]) : 10000;
    Context context;
    const std::vector<Solid> solids = read_solids(argv[1], {}, context);
    const Solid& solid = solids.front();
    const Domain domain = prepare_domain(solid.mesh, options, context, solid.known_sharp(), Coordinates::kRounded);
    const auto of_samples = [&](int wanted) {
      return json_of(reference::agreement_of_samples(domain, options, wanted, most, context));
    };
    const Json json{{"samples", of_samples(per_cell)},
                    {"few_samples", of_samples(kFewSamples)},
                    {"contacts", json_of(of_contacts(domain, compute(solid, options, context),
                                                     target_spacing(domain, options), most, context))}};
    std::printf("%s\n", json.dump().c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "agreement: %s\n", error.what());
    return 1;
  }
}
