#include "spheres/sheets.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "base/index.h"
#include "base/tolerances.h"

namespace matstruct {

namespace {

constexpr Index kGrain = 64;
// A contact that goes round by more than this, radians, holds its ball on a medial curve: more than the half circle
// (and half the smooth angle) in which a sheet between parallel walls may end.
constexpr double kGoesRound = 0.65 * std::numbers::pi;
// A single contact that goes round by more than this, radians, but less than that, holds its ball at the end of a
// sheet: both contacts of the spheres further in run together there, as in a fillet.
constexpr double kGoesTogether = 0.15 * std::numbers::pi;
// At the end of a sheet the ball in the middle of a simplex may stick out by this share of its radius: a tessellated
// fillet stands proud of the true one by as much.
constexpr double kProud = 0.01;
// A sheet sphere's second contact is sought within these shares of its radius.
constexpr std::array<double, 2> kNearlyTouches{0.05, 0.5};
// No sheet sphere is moved further than this share of the spacing.
constexpr double kMostMotion = 0.5;
// The ball tangent to the shared contacts may stand this far from the middle of the simplex, in longest edges.
constexpr double kMostBend = 0.7;

// Adds a sphere's contacts as they are at `place`, each once.
void add_followed(ContactFinder& finder, const TangentSphere& sphere, const Vec3& place, Contacts& contacts) {
  for (const Contact& c : sphere.contacts) {
    const Contact there = finder.follow(c, place);
    if (std::none_of(contacts.begin(), contacts.end(), [&](const Contact& o) { return finder.same(o, there); }))
      contacts.push_back(there);
  }
}

// Contacts that all corners have at `middle`, each once.
Contacts common_contacts(ContactFinder& finder, std::span<const TangentSphere* const> corners, const Vec3& middle) {
  Contacts common;
  add_followed(finder, *corners[0], middle, common);
  for (std::size_t k = 1; k < corners.size() && !common.empty(); ++k) {
    Contacts others;
    for (const Contact& c : corners[k]->contacts) others.push_back(finder.follow(c, middle));
    std::erase_if(common, [&](const Contact& c) {
      return std::none_of(others.begin(), others.end(), [&](const Contact& o) { return finder.same(o, c); });
    });
  }
  return common;
}

struct Middle {
  Vec3 place;
  double reach = 0;  // how far the ball of the stratum may stand from it
  Contacts common;
};

Middle middle_of(ContactFinder& finder, std::span<const TangentSphere* const> corners) {
  Middle middle;
  for (const TangentSphere* c : corners) {
    middle.place += c->center / static_cast<double>(corners.size());
    for (const TangentSphere* d : corners)
      middle.reach = std::max(middle.reach, kMostBend * distance(c->center, d->center));
  }
  middle.common = common_contacts(finder, corners, middle.place);
  return middle;
}

// The empty ball tangent to all common contacts or, failing that, to two of them.
std::optional<TangentSphere> ball_of(ContactFinder& finder, const Middle& middle, double depth) {
  const auto empty = [&](const Contacts& contacts) {
    auto ball = tangent_sphere(finder, middle.place, contacts, middle.reach);
    if (ball && intruder(finder, *ball, depth)) ball.reset();
    return ball;
  };
  const Contacts& common = middle.common;
  if (common.size() < 2) return {};
  if (auto ball = empty(common)) return ball;
  for (std::size_t i = 0; common.size() > 2 && i < common.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (auto ball = empty({common[i], common[j]})) return ball;
  return {};
}

// A sphere of radius 0 with a single contact stands where a sharp line fades out, or meets concave ones.
bool ends_sheet(const TangentSphere& sphere) {
  return sphere.contacts.size() == 1 &&
         (sphere.radius == 0 || (sphere.spread > kGoesTogether && sphere.spread <= kGoesRound));
}

// Whether two contacts at least of a sphere run together in the single one of another.
bool run_together(ContactFinder& finder, const TangentSphere& sphere, const TangentSphere& end) {
  return std::count_if(sphere.contacts.begin(), sphere.contacts.end(), [&](const Contact& c) {
           return finder.same(finder.follow(c, end.center), end.contacts[0]);
         }) >= 2;
}

// Whether spheres, of which `ends` end a sheet and `others` do not, lie in one sheet up to its end. Three that end one
// have no sheet between them.
bool in_sheet_to_its_end(ContactFinder& finder, std::span<const TangentSphere* const> ends,
                         std::span<const TangentSphere* const> others, double depth) {
  if (others.empty() && ends.size() > 2) return false;
  for (const TangentSphere* other : others)
    for (const TangentSphere* end : ends)
      if (!run_together(finder, *other, *end)) return false;
  Vec3 middle;
  double radius = 0;
  const double n = static_cast<double>(ends.size() + others.size());
  for (const auto& group : {ends, others})
    for (const TangentSphere* s : group) middle += s->center / n, radius += s->radius / n;
  if (others.size() != 1 && common_contacts(finder, others.empty() ? ends : others, middle).empty()) return false;
  return radius - std::sqrt(finder.domain().query.closest(middle).distance2) <= std::max(depth, kProud * radius);
}

// The empty ball that touches the nearest contact and another one.
std::optional<TangentSphere> onto_sheet(ContactFinder& finder, const TangentSphere& near, double reach) {
  const double touch = tolerance::kSameDistance * finder.domain().diagonal;
  std::size_t tried = 1;
  for (const double part : kNearlyTouches) {
    const Contacts contacts = finder.find(near.center, near.radius, part * near.radius);
    for (; tried < contacts.size(); ++tried) {
      auto ball = tangent_sphere(finder, near.center, {contacts[0], contacts[tried]}, reach);
      if (ball && is_medial(finder, *ball, touch)) return ball;
    }
  }
  return {};
}

std::optional<TangentSphere> end_of_sheet(ContactFinder& finder, const TangentSphere& from, const TangentSphere& to) {
  if (from.contacts.size() < 2) return {};
  const double touch = tolerance::kSameDistance * finder.domain().diagonal;
  const double way = distance(from.center, to.center);
  // Of more than two contacts the pair that the other sphere shares most with is not known: take the nearest two.
  const Contacts pair(from.contacts.begin(), from.contacts.begin() + 2);
  for (const double part : {1.0, 0.5}) {
    const auto ball = tangent_sphere(finder, lerp(from.center, to.center, part), pair, way);
    if (!ball) continue;
    if (auto seam = shrunk_to_next_contact(finder, *ball, touch, 2 * way)) return seam;
  }
  return {};
}

// Of two sheets with a contact in common that meet at less than a right angle: the balls of each that are next to the
// other are still in it.
std::optional<TangentSphere> where_sheets_meet(ContactFinder& finder, const TangentSphere& a, const TangentSphere& b) {
  const Vec3 middle = lerp(a.center, b.center, 0.5);
  Contacts all;
  for (const TangentSphere* sphere : {&a, &b}) add_followed(finder, *sphere, middle, all);
  if (all.size() != 3) return {};
  auto ball = tangent_sphere(finder, middle, all, distance(a.center, b.center));
  if (ball && !is_medial(finder, *ball, tolerance::kSameDistance * finder.domain().diagonal)) ball.reset();
  return ball;
}

}  // namespace

Index common_stratum(ContactFinder& finder, std::span<const TangentSphere* const> corners, double depth) {
  const Middle middle = middle_of(finder, corners);
  if (middle.common.size() == 1 && corners.size() == 2)
    if (finder.spread(middle.common[0], middle.place) > kGoesRound) return 1;
  if (const auto ball = ball_of(finder, middle, depth)) return count(ball->contacts);
  std::vector<const TangentSphere*> ends, others;
  for (const TangentSphere* c : corners) (ends_sheet(*c) ? ends : others).push_back(c);
  return !ends.empty() && in_sheet_to_its_end(finder, ends, others, depth) ? 2 : 0;
}

bool on_medial_curve(const TangentSphere& sphere) {
  return sphere.contacts.size() == 1 && sphere.spread > kGoesRound;
}

std::optional<TangentSphere> common_ball(ContactFinder& finder, std::span<const TangentSphere* const> corners,
                                         double depth) {
  return ball_of(finder, middle_of(finder, corners), depth);
}

std::vector<TangentSphere> with_contacts(FinderPool& finders, const Spheres& spheres, double spacing,
                                         const Context& context) {
  std::vector<TangentSphere> result(spheres.seeds.size());
  const double touch = tolerance::kSameDistance * finders.domain().diagonal;
  finders.for_each(context, count(result), kGrain, [&](ContactFinder& finder, Index s) {
    const SphereSeed& seed = spheres.seeds[uz(s)];
    TangentSphere& sphere = result[uz(s)];
    sphere = {seed.center, seed.radius, {}};
    if (!spheres.alive[uz(s)] || seed.guard) return;
    if (seed.type == SphereType::kSheet)
      if (auto moved = onto_sheet(finder, sphere, kMostMotion * spacing)) sphere = *std::move(moved);
    sphere.contacts = finder.find(sphere.center, sphere.radius, touch);
    if (sphere.contacts.size() == 1 && sphere.radius > touch)
      sphere.spread = finder.spread(sphere.contacts[0], sphere.center);
  });
  return result;
}

std::vector<TangentSphere> seam_seeds(FinderPool& finders, const std::vector<TangentSphere>& spheres,
                                      const std::vector<Edge>& pairs, const Context& context) {
  std::vector<std::array<std::optional<TangentSphere>, 3>> found(pairs.size());
  finders.for_each(context, count(pairs), kGrain, [&](ContactFinder& finder, Index p) {
    const TangentSphere &a = spheres[uz(pairs[uz(p)][0])], &b = spheres[uz(pairs[uz(p)][1])];
    const std::array<const TangentSphere*, 2> ends{&a, &b};
    if (common_stratum(finder, ends, tolerance::kInSheet * distance(a.center, b.center)) > 0) return;
    auto& [of_a, of_b, of_both] = found[uz(p)];
    of_a = end_of_sheet(finder, a, b);
    of_b = end_of_sheet(finder, b, a);
    if (!of_a && !of_b) of_both = where_sheets_meet(finder, a, b);
  });
  std::vector<TangentSphere> seeds;
  for (auto& [of_a, of_b, of_both] : found)
    for (auto* seed : {&of_a, &of_b})
      if (*seed) seeds.push_back(std::move(**seed));
  // The others last: of a seam's spheres the first to be traced from is of the first kind if there is one.
  for (auto& [of_a, of_b, of_both] : found)
    if (of_both) seeds.push_back(*std::move(of_both));
  return seeds;
}

}  // namespace matstruct
