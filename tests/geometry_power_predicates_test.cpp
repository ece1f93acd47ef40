// power_side() and locate() against rational arithmetic that takes the definition at its word: the perturbation is made
// of real, very small numbers, and the vertex is found by elimination.

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "base/index.h"
#include "base/random.h"
#include "geometry/power_predicates.h"

namespace matstruct {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using RationalVec = std::array<Rational, 3>;

RationalVec exact(const Vec3& a) {
  return {Rational(a.x), Rational(a.y), Rational(a.z)};
}
RationalVec operator-(const RationalVec& a, const RationalVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Rational dot(const RationalVec& a, const RationalVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct RationalSphere {
  RationalVec center;
  Rational weight;
  Rational power(const RationalVec& x) const { return dot(x - center, x - center) - weight; }
};

RationalSphere exact(const WeightedPoint& s) {
  return {exact(s.center), Rational(s.weight)};
}

// Solution of a k x k system whose rows end with the right-hand side; nothing if it is singular.
std::optional<std::vector<Rational>> solve(std::vector<std::vector<Rational>> rows) {
  const std::size_t k = rows.size();
  for (std::size_t c = 0; c < k; ++c) {
    const auto pivot = std::find_if(rows.begin() + static_cast<std::ptrdiff_t>(c), rows.end(),
                                    [&](const auto& row) { return row[c] != 0; });
    if (pivot == rows.end()) return std::nullopt;
    std::swap(*pivot, rows[c]);
    for (std::size_t r = 0; r < k; ++r) {
      if (r == c || rows[r][c] == 0) continue;
      const Rational factor = rows[r][c] / rows[c][c];
      for (std::size_t j = c; j <= k; ++j) rows[r][j] -= factor * rows[c][j];
    }
  }
  std::vector<Rational> x;
  for (std::size_t c = 0; c < k; ++c) x.push_back(rows[c][k] / rows[c][c]);
  return x;
}

// The point of the simplex's hull where the first k + 1 spheres have equal power distance, if there is just one.
std::optional<RationalVec> vertex_of(const PowerVertex& v, const std::vector<RationalSphere>& spheres) {
  const RationalVec base = exact(v.simplex[0]);
  std::vector<RationalVec> directions;
  for (int a = 0; a < v.k; ++a) {
    const RationalVec unit{Rational(a == 0), Rational(a == 1), Rational(a == 2)};
    directions.push_back(v.k == 3 ? unit : exact(v.simplex[uz(a + 1)]) - base);
  }
  std::vector<std::vector<Rational>> rows;  // pi_s - pi_0 is affine in x
  for (int s = 1; s <= v.k; ++s) {
    const RationalVec d = spheres[uz(s)].center - spheres[0].center;
    std::vector<Rational> row;
    for (const RationalVec& u : directions) row.push_back(2 * dot(d, u));
    row.push_back(spheres[uz(s)].power(base) - spheres[0].power(base));
    rows.push_back(std::move(row));
  }
  const auto t = solve(std::move(rows));
  if (!t) return std::nullopt;
  RationalVec x = base;
  for (std::size_t a = 0; a < t->size(); ++a)
    for (std::size_t c = 0; c < 3; ++c) x[c] += (*t)[a] * directions[a][c];
  return x;
}

// Weights less 2^-1000, 2^-2000, ..., the most from the lexicographically greatest centre. Doubles of the size used
// here have determinants that are 0 or far greater than 2^-1000, so that the numbers are as good as infinitesimals.
void perturb(std::vector<RationalSphere>& spheres) {
  constexpr unsigned kStep = 1000;
  std::vector<std::size_t> order(spheres.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return spheres[a].center > spheres[b].center; });
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto bits = static_cast<unsigned>(rank + 1) * kStep;
    spheres[order[rank]].weight -= Rational(1, boost::multiprecision::cpp_int(1) << bits);
  }
}

// Sign of pi_other - pi_vertex for the weights as they are, or perturbed; nothing if the vertex does not exist.
std::optional<int> rational_side(const PowerVertex& v, const WeightedPoint& other, bool perturbed) {
  std::vector<RationalSphere> spheres;
  for (int s = 0; s <= v.k; ++s) spheres.push_back(exact(v.spheres[uz(s)]));
  spheres.push_back(exact(other));
  if (perturbed) perturb(spheres);
  const auto x = vertex_of(v, spheres);
  if (!x) return std::nullopt;
  return Rational(spheres.back().power(*x) - spheres[0].power(*x)).sign();
}

bool vertex_exists(const PowerVertex& v, const WeightedPoint& other) {
  return rational_side(v, other, false).has_value();
}

// The sign that power_side() should give. Infinitesimals matter for ties only, and real ones are costly.
std::optional<int> true_side(const PowerVertex& v, const WeightedPoint& other) {
  const auto side = rational_side(v, other, false);
  return side == 0 ? rational_side(v, other, true) : side;
}

struct Case {
  PowerVertex vertex;
  WeightedPoint other;
};

bool distinct(const Case& c) {
  std::vector<Vec3> centers{c.other.center};
  for (int s = 0; s <= c.vertex.k; ++s) centers.push_back(c.vertex.spheres[uz(s)].center);
  for (std::size_t i = 0; i < centers.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (centers[i] == centers[j]) return false;
  return true;
}

// All points and weights from two sources of numbers.
template <class Point, class Weight>
Case make_case(int k, Point point, Weight weight) {
  Case c;
  c.vertex.k = k;
  for (std::size_t a = 0; a < 4; ++a) {
    c.vertex.simplex[a] = point();
    c.vertex.spheres[a] = {point(), weight()};
  }
  c.other = {point(), weight()};
  return c;
}

Case generic_case(int k, std::uint64_t n) {
  KeyedRandom random(1, static_cast<std::uint64_t>(k), n);
  const auto number = [&] { return 2 * random.uniform() - 1; };
  return make_case(
      k,
      [&] {
        return Vec3{number(), number(), number()};
      },
      [&] { return random.uniform(); });
}

// Everything on a small grid of integers: ties, coplanar and collinear centres, simplices through centres abound.
Case grid_case(int k, std::uint64_t n) {
  KeyedRandom random(2, static_cast<std::uint64_t>(k), n);
  const auto number = [&] { return static_cast<double>(random.next() % 3); };
  return make_case(
      k,
      [&] {
        return Vec3{number(), number(), number()};
      },
      [&] { return static_cast<double>(random.next() % 2); });
}

// Spheres through one point up to rounding: the sign hides in the last digits.
Case near_tie_case(int k, std::uint64_t n) {
  Case c = generic_case(k, n);
  const Vec3 x = k == 0   ? c.vertex.simplex[0]
                 : k == 1 ? lerp(c.vertex.simplex[0], c.vertex.simplex[1], 0.25)
                 : k == 2 ? (c.vertex.simplex[0] + c.vertex.simplex[1] + c.vertex.simplex[2]) / 3
                          : Vec3{0.1, 0.2, 0.3};
  for (WeightedPoint& s : c.vertex.spheres) s.weight = distance2(s.center, x);
  c.other.weight = distance2(c.other.center, x);
  return c;
}

using MakeCase = Case (*)(int k, std::uint64_t n);

// How many of `n` cases of each k have a vertex, after comparing them.
int compare(MakeCase make, std::uint64_t n) {
  int compared = 0;
  for (int k = 0; k <= 3; ++k)
    for (std::uint64_t i = 0; i < n; ++i) {
      const Case c = make(k, i);
      const auto truth = true_side(c.vertex, c.other);
      if (!distinct(c) || !truth) continue;
      ++compared;
      EXPECT_EQ(power_side(c.vertex, c.other), *truth) << "k = " << k << ", case " << i;
    }
  return compared;
}

TEST(PowerSide, EqualsRationalArithmetic) {
  EXPECT_EQ(compare(generic_case, 100), 400);
}

TEST(PowerSide, EqualsRationalArithmeticOnTies) {
  EXPECT_GT(compare(grid_case, 250), 400);
}

TEST(PowerSide, EqualsRationalArithmeticNearTies) {
  EXPECT_EQ(compare(near_tie_case, 100), 400);
}

TEST(PowerSide, DoesNotDependOnTheOrderOfItsArguments) {
  for (const MakeCase make : {grid_case, near_tie_case})
    for (int k = 1; k <= 3; ++k)
      for (std::uint64_t n = 0; n < 200; ++n) {
        const Case c = make(k, n);
        if (!distinct(c) || !vertex_exists(c.vertex, c.other)) continue;
        const int side = power_side(c.vertex, c.other);
        std::vector<std::size_t> order(uz(k + 1));
        std::iota(order.begin(), order.end(), std::size_t{0});
        while (std::next_permutation(order.begin(), order.end())) {
          PowerVertex spheres_moved = c.vertex, simplex_moved = c.vertex;
          for (std::size_t a = 0; a < order.size(); ++a) {
            spheres_moved.spheres[a] = c.vertex.spheres[order[a]];
            simplex_moved.simplex[a] = c.vertex.simplex[order[a]];
          }
          EXPECT_EQ(power_side(spheres_moved, c.other), side) << "k = " << k << ", case " << n;
          EXPECT_EQ(power_side(simplex_moved, c.other), side) << "k = " << k << ", case " << n;
        }
      }
}

// Two tets that share a facet or an edge may name its hull by any of its points.
TEST(PowerSide, DependsOnTheHullOfTheSimplexOnly) {
  for (int k = 1; k <= 2; ++k)
    for (std::uint64_t n = 0; n < 500; ++n) {
      const Case c = grid_case(k, n);
      if (!distinct(c) || !vertex_exists(c.vertex, c.other)) continue;
      PowerVertex moved = c.vertex;
      const auto& v = c.vertex.simplex;
      moved.simplex = {v[0] + 3 * (v[1] - v[0]), v[1] - 2 * (v[uz(k)] - v[0]), v[uz(k)] + (v[uz(k)] - v[0]), {}};
      if (!vertex_exists(moved, c.other)) continue;
      EXPECT_EQ(power_side(moved, c.other), power_side(c.vertex, c.other)) << "k = " << k << ", case " << n;
    }
}

// Where twelve spheres tie at a point, "nearer" is still a total order: sorting them by it makes every pair agree.
TEST(PowerSide, OrdersTyingSpheres) {
  const std::vector<Vec3> twelve{{3, 4, 0},  {4, 3, 0},  {5, 0, 0},   {0, 5, 0},   {-3, 4, 0}, {0, 0, 5},
                                 {0, 3, -4}, {4, 0, -3}, {-4, 0, -3}, {0, -4, -3}, {0, 0, -5}, {-5, 0, 0}};
  const auto nearer = [](const Vec3& a, const Vec3& b) {
    return power_side({0, {}, {{{a, 1}, {}, {}, {}}}}, {b, 1}) > 0;
  };
  std::vector<Vec3> sorted = twelve;
  std::sort(sorted.begin(), sorted.end(), nearer);
  for (std::size_t i = 0; i < sorted.size(); ++i)
    for (std::size_t j = 0; j < sorted.size(); ++j)
      if (i != j) {
        EXPECT_EQ(nearer(sorted[i], sorted[j]), i < j);
      }
}

TEST(PowerSide, NeedsExactArithmeticOnlyNearTies) {
  const std::size_t before = exact_power_sides();
  for (std::uint64_t n = 0; n < 1000; ++n) {
    const Case c = generic_case(3, n);
    (void)power_side(c.vertex, c.other);
  }
  const std::size_t generic = exact_power_sides() - before;
  EXPECT_LT(generic, 5u);
  for (std::uint64_t n = 0; n < 1000; ++n) {
    const Case c = near_tie_case(3, n);
    (void)power_side(c.vertex, c.other);
  }
  EXPECT_GT(exact_power_sides() - before - generic, 900u);
}

// The negative control: the same formulas in plain double precision.
TEST(PowerSide, PlainFloatingPointFailsNearTies) {
  int undecided = 0, wrong = 0, wrong_if_generic = 0;
  for (int k = 0; k <= 3; ++k)
    for (std::uint64_t n = 0; n < 200; ++n) {
      const Case tie = grid_case(k, n), near = near_tie_case(k, n), generic = generic_case(k, n);
      if (distinct(tie) && vertex_exists(tie.vertex, tie.other))
        undecided += power_side_inexact(tie.vertex, tie.other) == 0;
      wrong += power_side_inexact(near.vertex, near.other) == -power_side(near.vertex, near.other);
      wrong_if_generic +=
          power_side_inexact(generic.vertex, generic.other) != power_side(generic.vertex, generic.other);
    }
  EXPECT_GT(undecided, 50);
  EXPECT_GT(wrong, 50);
  EXPECT_EQ(wrong_if_generic, 0);
}

void expect_located(const Case& c) {
  std::vector<RationalSphere> spheres;
  for (const WeightedPoint& s : c.vertex.spheres) spheres.push_back(exact(s));
  const auto truth = vertex_of(c.vertex, spheres);
  if (!truth) return;
  const LocatedVertex located = locate(c.vertex);
  const RationalVec error = exact(located.point) - *truth;
  const Rational bound(located.error);
  EXPECT_LE(dot(error, error), bound * bound);
  double size = 1;
  for (const Rational& x : *truth) size = std::max(size, std::abs(x.convert_to<double>()));
  EXPECT_LE(located.error, 1e-13 * size);
}

TEST(Locate, KeepsItsErrorBound) {
  for (const MakeCase make : {generic_case, grid_case, near_tie_case})
    for (int k = 0; k <= 3; ++k)
      for (std::uint64_t n = 0; n < 200; ++n) {
        SCOPED_TRACE(testing::Message() << "k = " << k << ", case " << n);
        expect_located(make(k, n));
      }
}

// Centres in a plane but for their last digits: the determinants cancel, the vertex may be anywhere.
TEST(Locate, KeepsItsErrorBoundWhereDeterminantsCancel) {
  for (std::uint64_t n = 0; n < 200; ++n) {
    SCOPED_TRACE(testing::Message() << "case " << n);
    Case c = generic_case(3, n);
    for (WeightedPoint& s : c.vertex.spheres) s.center.z = 0.3 * s.center.x - 0.7 * s.center.y + 0x1p-40 * s.center.z;
    expect_located(c);
  }
}

}  // namespace
}  // namespace matstruct
