#include "pipeline/structure_loop.h"

#include "base/index.h"
#include "extract/guards.h"
#include "preserve/refine.h"
#include "spheres/initial_spheres.h"

namespace matstruct {

namespace {

// Refinements of a round keep this share of the spacing from each other.
constexpr double kApart = 0.3;

}  // namespace

StructureResult build_structure(const Domain& domain, const Options& options, Spheres& spheres, RpdEngine& engine,
                                StageClock& clock, Context& context) {
  StructureResult result;
  const double spacing = target_spacing(domain, options);
  FinderPool finders(domain, smooth_angle(options));
  clock.begin("placing seams and junctions");
  result.network = place_seams(domain, options, spheres, engine, finders, context).network;
  for (int round = 0;; ++round) {
    clock.begin("preserving topology and features");
    const PreserveResult kept = preserve(domain, options, spheres, engine, context);
    const Index inserted = result.kept.inserted;
    result.kept = kept;
    result.kept.inserted += inserted;

    clock.begin("thinning");
    const GuardRemoval guarded = remove_guards(dual_complex(engine.diagram()), spheres);
    result.forced_guards = count(guarded.forced);
    result.medial = with_contacts(finders, spheres, spacing, context);
    const SimplexClasses classes = classify(finders, result.medial, guarded.dual, kept.lines.feature_edges, context);
    result.thin = thin(domain, spheres, result.medial, guarded.dual, classes, kept.lines.feature_edges,
                       {options.thinning}, context);
    if (round == options.refinements) return result;

    clock.begin("refining");
    const Edits edits = propose_refinement(finders, result.thin, result.medial,
                                           {options.deviation / 100 * domain.diagonal, spacing}, context);
    if (edits.insert.empty()) return result;
    const AppliedEdits applied = apply_edits(spheres, edits, kApart * spacing);
    engine.update(weighted_points(spheres), applied.inserted, applied.removed, context);
    result.refined += count(applied.inserted);
  }
}

}  // namespace matstruct
