#include "prepare/solidify.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/index.h"
#include "base/tolerances.h"
#include "geometry/box.h"
#include "prepare/closed_surface.h"
#include "prepare/mesher_process.h"
#include "prepare/messages.h"
#include "prepare/orient_soup.h"
#include "prepare/repair_effect.h"
#include "prepare/tetrahedralise.h"

namespace matstruct {

namespace {

using Clock = std::chrono::steady_clock;

TriSurface surface_of(const mesher::Answer& answer) {
  TriSurface surface;
  for (std::size_t i = 0; i + 2 < answer.points.size(); i += 3)
    surface.vertices.push_back({answer.points[i], answer.points[i + 1], answer.points[i + 2]});
  for (std::size_t i = 0; i + 2 < answer.corners.size(); i += 3)
    surface.triangles.push_back({answer.corners[i], answer.corners[i + 1], answer.corners[i + 2]});
  return surface;
}

// Whether an edge is shorter than `share` of the diagonal: points that are one but for rounding.
bool has_edge_below(const TriSurface& surface, double share) {
  const double least = share * box_diagonal(surface.vertices);
  return std::any_of(surface.triangles.begin(), surface.triangles.end(), [&](const Triangle& t) {
    const auto p = [&](std::size_t k) -> const Vec3& { return surface.vertices[uz(t[k])]; };
    return std::min({distance(p(0), p(1)), distance(p(1), p(2)), distance(p(2), p(0))}) < least;
  });
}

// The steps of a repair on one surface, with one limit of time for all of them.
class RepairChain {
 public:
  RepairChain(const TriSurface& surface, const ReadOptions& options, Context& context, Clock::time_point begin)
      : soup_(surface), options_(options), context_(context), begin_(begin) {}

  // True if the result is the solid; else failures() has reasons more. Needles between the cut triangles may be too
  // much for the mesher, and edges as short as rounding make features that are none: snapping to a grid takes both
  // away.
  bool resolve(const TriSurface& surface) {
    for (const double grid : {0.0, tolerance::kFineSnap, tolerance::kCoarseSnap}) {
      mesher::Answer answer;
      if (!run(mesher::Task::kResolve, surface, grid, "cutting triangles where they meet", answer)) return false;
      std::string step = answer.changed == 0
                             ? "inner walls and what encloses nothing were removed"
                             : fmt::format("triangles were cut where they meet ({}) and inner parts removed",
                                           counted(static_cast<std::size_t>(answer.changed), "pair", "pairs"));
      if (grid > 0) step += fmt::format(", points snapped to {:g} of the diagonal", grid);
      const TriSurface resolved = surface_of(answer);
      if (grid == 0 && !resolved.triangles.empty() && has_edge_below(resolved, tolerance::kFineSnap)) continue;
      if (fill(resolved, true, step)) return true;
    }
    return false;
  }

  bool fill_holes() {
    mesher::Answer answer;
    if (!run(mesher::Task::kFillHoles, soup_, options_.hole_size, "filling holes", answer)) return false;
    const std::string step =
        answer.changed == 1 ? "1 hole was filled" : fmt::format("{} holes were filled", answer.changed);
    const TriSurface closed = surface_of(answer);
    if (fill(closed, false, step)) return true;
    steps_.push_back(step);
    if (resolve(orient_soup(closed))) return true;
    steps_.pop_back();
    return false;
  }

  bool wrap() {
    mesher::Answer answer;
    if (!run(mesher::Task::kWrap, soup_, options_.wrap_size, "wrapping", answer)) return false;
    return fill(surface_of(answer), false,
                fmt::format("the surface was WRAPPED: edges are rounded and openings below {} % of the diagonal closed",
                            100 * options_.wrap_size));
  }

  const std::string& failures() const { return failures_; }

  Solidified result() {
    Solidified made{.mesh = {}, .repair = measure_repair(soup_, solid_)};
    made.mesh = std::move(solid_);
    made.repair.steps = std::move(steps_);
    return made;
  }

 private:
  double seconds_left() const {
    return tolerance::kMesherSeconds - std::chrono::duration<double>(Clock::now() - begin_).count();
  }

  void fail(const std::string& what, const std::string& why) {
    failures_ += fmt::format("{}{}: {}", failures_.empty() ? "" : "; ", what, why);
  }

  bool run(mesher::Task task, const TriSurface& surface, double size, const char* what, mesher::Answer& answer) {
    context_.report("repair", 0);
    mesher::Request request;
    request.task = task;
    request.size = size;
    for (const Vec3& p : surface.vertices) request.points.insert(request.points.end(), {p.x, p.y, p.z});
    for (const Triangle& t : surface.triangles) request.corners.insert(request.corners.end(), t.begin(), t.end());
    answer = mesher::run(request, seconds_left(), context_);
    if (!answer.error.empty()) fail(what, answer.error);
    return answer.error.empty();
  }

  bool fill(const TriSurface& surface, bool resolved, const std::string& step) {
    std::vector<std::string> warnings = context_.warnings;
    try {
      solid_ = tetrahedralise(surface, context_,
                              {.tet_size = options_.tet_size, .seconds = seconds_left(), .resolved = resolved});
      steps_.push_back(step);
      return true;
    } catch (const Error& error) {
      context_.warnings = std::move(warnings);
      std::string reason = error.what();
      if (!reason.empty() && reason.back() == '.') reason.pop_back();
      fail("filling with tetrahedra", reason);
      return false;
    }
  }

  const TriSurface& soup_;
  const ReadOptions& options_;
  Context& context_;
  Clock::time_point begin_;
  TetMesh solid_;
  std::vector<std::string> steps_;
  std::string failures_;
};

std::string warning_of(const Repair& repair) {
  std::string text =
      fmt::format("the surface bounds no solid as it is and was repaired: {}", fmt::join(repair.steps, "; "));
  if (!std::isnan(repair.volume_change_percent))
    text += fmt::format("; the enclosed volume changed by {:.3g} %", repair.volume_change_percent);
  if (!std::isnan(repair.sharp_edges_kept_percent))
    text += fmt::format("; {:.4g} % of the sharp edges are kept", repair.sharp_edges_kept_percent);
  return text + fmt::format("; the result is within {:.2g} % of the diagonal of the input.", repair.distance_percent);
}

}  // namespace

Solidified solidify(const TriSurface& surface, const ReadOptions& options, Context& context,
                    const std::vector<SharpSegment>* sharp) {
  const auto begin = Clock::now();
  const std::vector<std::string> warnings = context.warnings;
  std::string sentence;
  SurfaceDefect defect{};
  try {
    const FillOptions fill{.tet_size = options.tet_size, .merge_flat = !options.keep_triangles, .sharp = sharp};
    return {.mesh = tetrahedralise(surface, context, fill), .repair = {}};
  } catch (const SurfaceError& error) {
    sentence = error.what();
    defect = error.defect;
  }
  context.warnings = warnings;
  const TriSurface soup = orient_soup(weld_surface(surface));
  RepairChain chain(soup, options, context, begin);
  const bool closed = defect != SurfaceDefect::kOpen && defect != SurfaceDefect::kOneSided;
  const bool may_fill = defect != SurfaceDefect::kOneSided;
  if ((closed && chain.resolve(soup)) || (may_fill && chain.fill_holes()) ||
      (defect == SurfaceDefect::kOpen && chain.resolve(soup)) || (options.allow_wrap && chain.wrap())) {
    Solidified made = chain.result();
    context.warnings.push_back(warning_of(made.repair));
    return made;
  }
  if (sentence.back() == '.') sentence.pop_back();
  if (!chain.failures().empty()) sentence += fmt::format("; no repair worked ({})", chain.failures());
  if (!options.allow_wrap) sentence += "; --allow-wrap wraps what cannot be closed otherwise";
  throw Error(sentence + ".");
}

}  // namespace matstruct
