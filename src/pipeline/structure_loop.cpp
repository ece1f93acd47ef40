#include "pipeline/structure_loop.h"

#include <algorithm>

#include "base/index.h"
#include "base/tolerances.h"
#include "extract/erosion.h"
#include "extract/guards.h"
#include "extract/split_dual.h"
#include "pipeline/particle_stage.h"
#include "prepare/edge_heights.h"
#include "preserve/refine.h"
#include "spheres/guards.h"
#include "spheres/initial_spheres.h"
#include "spheres/volume_samples.h"

namespace matstruct {

namespace {

// Refinements of a round keep this share of the spacing from each other.
constexpr double kApart = 0.3;
// Spheres of seams put against shortcuts may be nearer to each other: corners need it.
constexpr double kSeamsApart = 0.05;
// A mechanical part has fewer loose invalid edges than one for this many faces.
constexpr Index kLooseShare = 4;
// So many more sets of the diagram may be disconnected, to be split, with refined spheres: what these bring nearer to
// the axis is worth more.
constexpr Index kFewNewDefects = 30;
// And of smooth shapes, whose refined spheres stand close by nature, one for this many spheres.
constexpr Index kNewDefectsShare = 10;
// Further rounds against shortcuts alone.
constexpr int kSeamRounds = 2;
// Sheets of bumps lower than this share of the allowed deviation, or of a smooth shape's noise, burn: what burns goes
// by whole faces.
constexpr double kSheetBumps = 0.5;
// Distance of the surface points that are looked at, in spacings.
constexpr double kFinePins = 0.4;

// Importance below which faces of smooth shapes go, unless asked otherwise (MATTopo).
constexpr double kOrganicThinning = 0.1;

bool is_organic(const Domain& domain, const Options& options) {
  if (options.shape != ShapeKind::kAuto) return options.shape == ShapeKind::kOrganic;
  return std::none_of(domain.features.lines.begin(), domain.features.lines.end(),
                      [](const FeatureLine& line) { return line.kind == EdgeKind::kConvex; });
}

// Height of the bumps that are noise, internal units: of a mechanical part if it is a scan; of a smooth shape as high
// as most edges between its facets stand above both together, unless spheres can follow them.
double noise_height(const Domain& domain, const Options& options, bool organic) {
  if (!organic) return domain.features.noise_height;
  return std::min(2 * height_of_facets(domain, smooth_angle(options)),
                  tolerance::kNoise * target_spacing(domain, options));
}

// Whether most of the mesh is curves of spheres without common contacts: a smooth shape, sharp lines or not.
bool falls_apart(const ThinMesh& thin) {
  return kLooseShare * count(invalid_edges(thin).loose) > count(thin.mesh.faces);
}

// What preservation has left that cannot be split.
Index lasting_defects(const PreserveResult& kept) {
  return defects_of(kept)[0];
}

// Where walls are far thinner than the spacing, or facets far smaller, the spheres of seams may break what nothing
// mends, or make more gaps than they close. Sets that can be split are a small price for seams.
PreserveResult without_seams_if_better(const Domain& domain, const Options& options, const Spheres& initial,
                                       const PreserveResult& with, SeamNetwork& network, FinderPool& finders,
                                       Spheres& spheres, RpdEngine& engine, Context& context) {
  Spheres others = initial;
  engine.compute(weighted_points(others), context);
  const PreserveResult without = preserve(domain, options, {}, finders, others, engine, context);
  if (with.seams_crowded ? !worse(without, with) : lasting_defects(without) < lasting_defects(with)) {
    spheres = std::move(others);
    network = {};
    return without;
  }
  engine.compute(weighted_points(spheres), dead_ids(spheres), context);
  return with;
}

}  // namespace

StructureResult build_structure(const Domain& domain, const Options& options, Spheres& spheres, RpdEngine& engine,
                                FinderPool& finders, StageClock& clock, Context& context) {
  StructureResult result;
  const double spacing = target_spacing(domain, options);
  const bool organic = is_organic(domain, options);
  result.organic = organic;
  const Spheres initial = spheres;
  Spheres before;  // those of the round before
  clock.begin("placing seams and junctions");
  const double noise = noise_height(domain, options, organic);
  if (organic || !options.seams) {
    engine.compute(weighted_points(spheres), context);
    if (noise > 0) drop_bumps(noise, with_contacts(finders, spheres, 0, context), spheres, engine, context);
  } else {
    SeamStage placed = place_seams(domain, options, spheres, engine, finders, context);
    if (noise > 0) drop_bumps(noise, placed.medial, spheres, engine, context);
    result.network = std::move(placed.network);
  }
  const double thinning = organic && options.thinning == Options{}.thinning ? kOrganicThinning : options.thinning;
  const double deviation = options.deviation / 100 * domain.diagonal;
  // What the result may deviate by: bumps as high as noise make no sheets.
  const RefineOptions refine{std::max(noise, deviation), spacing, noise == 0};
  const double burning = organic ? kSheetBumps * noise : std::max(noise, kSheetBumps * deviation);
  const std::vector<Pin> pins = sample_surface(domain, kFinePins * spacing, options.seed, context);
  VolumeSamples samples;  // for classification by the surface
  if (!options.volume_classification) samples = volume_samples(domain, {spacing, options.seed}, context);
  for (int round = 0;; ++round) {
    clock.begin("preserving topology and features");
    PreserveResult kept = preserve(domain, options, result.network, finders, spheres, engine, context);
    if (round == 0 && !organic && options.seams && (lasting_defects(kept) > 0 || kept.seams_crowded))
      kept = without_seams_if_better(domain, options, initial, kept, result.network, finders, spheres, engine, context);
    if (round > 0 && worse(kept, result.kept, organic ? count(spheres.seeds) / kNewDefectsShare : kFewNewDefects)) {
      // What was added did harm: back to the state before.
      spheres = std::move(before);
      engine.compute(weighted_points(spheres), dead_ids(spheres), context);
      return result;
    }
    if (round == 0)
      result.particles =
          spread_particles(domain, options, result.network, !organic, finders, spheres, engine, kept, clock, context);
    const Index inserted = result.kept.inserted;
    result.kept = kept;
    result.kept.inserted += inserted;

    clock.begin("thinning");
    // What is not connected after all is split; what cannot be removed of the guards stays.
    const SplitDual split = split_dual(domain, engine, spheres, pinch_contacts(domain, engine));
    Spheres all = spheres;
    for (const SphereSeed& seed : split.added) all.add(seed);
    const GuardRemoval guarded = remove_guards(split.dual, all);
    for (const Index g : guarded.forced) all.seeds[uz(g)] = medial_sphere_at(domain, all.seeds[uz(g)]);
    result.forced_guards = count(guarded.forced);
    result.medial = with_contacts(finders, all, organic ? 0 : spacing, context);
    const SimplexClasses classes =
        !options.volume_classification
            ? classify_by_surface(samples, all, guarded.dual, kept.lines.feature_edges, context)
        : organic ? classify_smooth(finders, result.medial, guarded.dual, refine.deviation, context)
                  : classify(finders, result.medial, guarded.dual, kept.lines.feature_edges, context);
    result.thin = thin(domain, all, result.medial, guarded.dual, classes, kept.lines.feature_edges,
                       {thinning, refine.deviation / 2}, context);
    // Fire leaves the borders of smooth sheets ragged: there only against what is higher than allowed.
    if (!organic || noise > deviation)
      result.thin = eroded(result.thin, kept.lines.feature_edges, {burning, refine.deviation});
    if (round == 0 && !organic && options.shape == ShapeKind::kAuto && falls_apart(result.thin)) {
      Options smooth = options;
      smooth.shape = ShapeKind::kOrganic;
      spheres = initial;
      return build_structure(domain, smooth, spheres, engine, finders, clock, context);
    }
    const std::vector<Edge> shortcuts = invalid_edges(result.thin).shortcuts;
    // Refined spheres may let preservation end where it ran away before; where it still does, more make it worse.
    const bool hopeless = round > 0 && kept.ran_away;
    if (hopeless || round >= options.refinements + (shortcuts.empty() ? 0 : kSeamRounds)) return result;

    clock.begin("refining");
    Edits edits;
    if (round < options.refinements) {
      edits = propose_refinement(finders, result.thin, result.medial, result.network, refine, context);
      const Edits missing =
          organic ? Edits{}
                  : propose_missing_sheets(finders, result.thin, result.medial, smooth_angle(options), refine, context);
      const Edits coverage = propose_coverage(domain, result.thin.mesh, pins, smooth_angle(options), refine, context);
      for (const Edits* more : {&missing, &coverage})
        edits.insert.insert(edits.insert.end(), more->insert.begin(), more->insert.end());
    }
    Edits on_seams = propose_on_seams(finders, result.network, result.medial, shortcuts, spacing, context);
    for (Edits* proposed : {&edits, &on_seams}) leave_out_copies(spheres, spacing, *proposed);
    if (edits.insert.empty() && on_seams.insert.empty()) return result;
    before = spheres;
    AppliedEdits applied = apply_edits(spheres, edits, kApart * spacing);
    const AppliedEdits seams = apply_edits(spheres, on_seams, kSeamsApart * spacing);
    applied.inserted.insert(applied.inserted.end(), seams.inserted.begin(), seams.inserted.end());
    engine.update(weighted_points(spheres), applied.inserted, applied.removed, context);
    result.refined += count(applied.inserted);
  }
}

}  // namespace matstruct
