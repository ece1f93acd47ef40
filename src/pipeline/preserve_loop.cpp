#include "pipeline/preserve_loop.h"

#include <limits>

#include "base/index.h"
#include "extract/guards.h"
#include "preserve/topology.h"
#include "spheres/initial_spheres.h"
#include "structure/contractibility.h"

namespace matstruct {

namespace {

// Proposed spheres nearer to each other than this share of the spacing have one cause.
constexpr double kSameCause = 0.01;
// Rounds without progress after which the loop gives up: while something is left that nothing mends later; where all
// that is left can be split (extract/split_dual.h); where only seams have gaps, which close soon or not at all.
constexpr Index kPatience = 12, kSplitPatience = 4, kSeamPatience = 3;
// Progress is a state with less than this share of the defects of the last one.
constexpr double kProgress = 0.9;
// The loop also gives up when it has inserted this many times the spheres that it began with: then the solid has gaps
// far below the sampling density, and every insertion asks for the next.
constexpr Index kMostGrowth = 2;
// And when the violations are more than this many times the fewest that it had and a few: then insertion breaks more
// than it mends, and every round takes longer than the one before.
constexpr Index kRunaway = 4, kFew = 100;
// Where more than a few violations are left, all of which can be split, and so many rounds have not made them fewer,
// only lines are mended: new spheres of sheets take the lines' cells away as fast as those are mended.
constexpr Index kLinePatience = 2;
// Seams are crowded if more than a few gaps are left and these are more than this part of all pairs of neighbours.
constexpr double kCrowded = 0.5;

// The state with the fewest defects so far: to return to if the loop does not end well.
struct Best {
  Spheres spheres;
  Defects defects{std::numeric_limits<Index>::max(), 0, 0};
  Index round = 0;
};

bool can_be_split(const Violation& v) {
  return v.kind != ViolationKind::kCellEuler && v.kind != ViolationKind::kCellCavity &&
         v.kind != ViolationKind::kFacetEuler;
}

bool much_better(const Defects& now, const Defects& then) {
  const Index sum = now[0] + now[1], sum_then = then[0] + then[1];
  if (sum != sum_then) return sum < kProgress * sum_then;
  return now[2] < kProgress * then[2];
}

Index patience(const Defects& best) {
  if (best[0] > 0) return kPatience;
  return best[1] > 0 ? kSplitPatience : kSeamPatience;
}

// Without the facets and edges of cells that are violated themselves: they mostly mend with the cell.
std::vector<Violation> independent(const Spheres& spheres, const std::vector<Violation>& violations) {
  std::vector<bool> violated(spheres.seeds.size(), false);
  for (const Violation& v : violations)
    if (v.spheres[1] == kInvalid) violated[uz(v.spheres[0])] = true;
  std::vector<Violation> result;
  for (const Violation& v : violations)
    if (v.spheres[1] == kInvalid ||
        std::none_of(v.spheres.begin(), v.spheres.end(), [&](Index s) { return s != kInvalid && violated[uz(s)]; }))
      result.push_back(v);
  return result;
}

// Guards that cannot be removed: facets where they meet others ask for a sphere between, else the cell as a whole.
void add_guard_violations(const Spheres& spheres, const Rpd& rpd, std::vector<Violation>& violations) {
  const GuardRemoval removal = remove_guards(dual_complex(rpd), spheres);
  std::vector<bool> meets(spheres.seeds.size(), false);
  for (const Edge& e : removal.meeting) meets[uz(e[0])] = meets[uz(e[1])] = true;
  std::vector<Index> alone;
  for (const Index g : removal.forced)
    if (!meets[uz(g)]) alone.push_back(g);
  for (Violation& v : whole_facets(rpd, removal.meeting, ViolationKind::kGuard)) violations.push_back(std::move(v));
  for (Violation& v : whole_cells(rpd, alone, ViolationKind::kGuard)) violations.push_back(std::move(v));
}

}  // namespace

Defects defects_of(const PreserveResult& r) {
  return {r.lines.lines - r.lines.preserved + r.not_mended, r.violations_left - r.not_mended, r.seam_gaps};
}

bool worse(const PreserveResult& a, const PreserveResult& b, Index few) {
  const Defects x = defects_of(a), y = defects_of(b);
  return x[0] != y[0] ? x[0] > y[0] : x[1] > y[1] + few;
}

PreserveResult preserve(const Domain& domain, const Options& options, const SeamNetwork& network, FinderPool& finders,
                        Spheres& spheres, RpdEngine& engine, Context& context) {
  PreserveResult result;
  Best best;
  Defects reference = best.defects;  // of the last progress
  Index progress = 0;                // its round
  const double spacing = target_spacing(domain, options);
  const Index most_inserted = kMostGrowth * count(spheres.seeds);
  Index inserted = 0, fewest = std::numeric_limits<Index>::max(), fewest_round = 0;
  for (Index round = 0;; ++round) {
    context.report("preserving topology and features", static_cast<double>(round) / std::max(1, options.max_rounds));
    Contractibility check = check_contractible(domain, engine.diagram(), pinch_contacts(domain, engine));
    add_guard_violations(spheres, engine.diagram(), check.violations);
    const LineCheck lines = check_lines(domain, spheres, engine.diagram());
    SeamCheck seams = check_seams(finders, network, spheres, engine.diagram(), spacing);
    const bool crowded = seams.missing > std::max<double>(kFew, kCrowded * seams.pairs);
    if (crowded) seams.edits = {};
    const auto not_mended = static_cast<Index>(
        std::count_if(check.violations.begin(), check.violations.end(), [](auto& v) { return !can_be_split(v); }));
    const PreserveResult now{round, inserted, count(check.violations), not_mended, lines, seams.missing, crowded};
    const Defects defects = defects_of(now);
    if (defects < best.defects) {
      best = {spheres, defects, round};
      result = now;
    }
    if (much_better(defects, reference)) {
      reference = defects;
      progress = round;
    }
    // What is left and has no proposal is not mended by waiting.
    const bool hopeless = check.violations.empty() && lines.edits.insert.empty() && lines.edits.remove.empty();
    if (hopeless && seams.edits.insert.empty()) {
      if (best.round == round) return result;
      break;
    }
    if (now.violations_left < fewest) {
      fewest = now.violations_left;
      fewest_round = round;
    }
    const bool only_lines = lines.preserved < lines.lines && not_mended == 0 && now.violations_left > kFew &&
                            round - fewest_round > kLinePatience;
    if (only_lines) check.violations.clear();
    result.ran_away = now.violations_left > kRunaway * (fewest + kFew);
    if (round == options.max_rounds || inserted > most_inserted || result.ran_away ||
        round - progress > (hopeless ? kSeamPatience : patience(best.defects)))
      break;

    Edits edits = propose_for_topology(domain, engine, spheres, independent(spheres, check.violations),
                                       {spacing, smooth_angle(options), options.seed}, round, context);
    edits.insert.insert(edits.insert.end(), lines.edits.insert.begin(), lines.edits.insert.end());
    edits.remove.insert(edits.remove.end(), lines.edits.remove.begin(), lines.edits.remove.end());
    edits.insert.insert(edits.insert.end(), seams.edits.insert.begin(), seams.edits.insert.end());
    const AppliedEdits applied = apply_edits(spheres, edits, kSameCause * spacing);
    engine.update(weighted_points(spheres), applied.inserted, applied.removed, context);
    inserted += count(applied.inserted);
  }
  spheres = std::move(best.spheres);
  engine.compute(weighted_points(spheres), dead_ids(spheres), context);
  return result;
}

}  // namespace matstruct
