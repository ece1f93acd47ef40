// With d_s = c_s - c_0 for s in S without its first sphere 0, u_a = v_a - v_0 the edges of the simplex and e = c_0 -
// v_0, let p_s = (d_s . u_1, ..., d_s . u_k) and h_s = |d_s|^2 + 2 d_s . e - (w_s - w_0). At v_0 + sum_a t_a u_a the
// power distances satisfy pi_s - pi_0 = h_s - 2 t . p_s. The vertex has 2 t = P^-1 h, and for another sphere m there
//     pi_m - pi_0 = h_m - p_m P^-1 h = det[P h; p_m h_m] / det P.
// For k = 3 the simplex spans space and may be replaced by the unit vectors at c_0: p_s = d_s, e = 0.

#include "geometry/power_predicates.h"

#include "base/index.h"

#include <CGAL/Mpzf.h>
#include <CGAL/number_utils.h>

#include <cmath>
#include <utility>

namespace matstruct {

namespace {

using Exact = CGAL::Mpzf;

// Error analysis. With u = 2^-53: every d, u_a and e carries one rounding, an entry p three products of two such
// numbers and two sums (<= 6 u relative to the sum of absolute values), an entry h at most 9 u relative to its own. A
// determinant of at most 4 x 4 such entries adds three products and five sums to each term: below 3 * 6 + 9 + 8 = 35 u
// relative to the permanent of the absolute values; the permanent's own rounding is below 1 %.
constexpr double kUnit = 0x1.0p-53;
constexpr double kDeterminantError = 48 * kUnit;
// Below this permanent a product may have lost digits to underflow.
constexpr double kSmallestPermanent = 1e-250;

thread_local std::size_t exact_calls = 0;

// One row [p_1 .. p_k h] of the system.
template <class T>
struct Row {
  std::array<T, 3> p{};
  T h{};
};

template <class T>
using Vector = std::array<T, 3>;

template <class T>
Vector<T> difference(const Vec3& a, const Vec3& b) {
  return {T(a.x) - T(b.x), T(a.y) - T(b.y), T(a.z) - T(b.z)};
}

template <class T>
T inner(const Vector<T>& a, const Vector<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The linear system of a vertex in the number type T: simplex edges, offset, and rows made from spheres.
template <class T>
class System {
 public:
  explicit System(const PowerVertex& v) : k_(v.k), origin_(v.spheres[0]) {
    if (k_ == 3) return;
    for (int a = 0; a < k_; ++a) edges_[uz(a)] = difference<T>(v.simplex[uz(a + 1)], v.simplex[0]);
    offset_ = difference<T>(origin_.center, v.simplex[0]);
  }

  Row<T> row(const WeightedPoint& s) const {
    const Vector<T> d = difference<T>(s.center, origin_.center);
    Row<T> r;
    r.h = inner(d, d) - (T(s.weight) - T(origin_.weight));
    if (k_ == 3) {
      r.p = d;
      return r;
    }
    r.h = r.h + T(2) * inner(d, offset_);
    for (std::size_t a = 0; a < uz(k_); ++a) r.p[a] = inner(d, edges_[a]);
    return r;
  }

 private:
  int k_;
  WeightedPoint origin_;
  std::array<Vector<T>, 3> edges_{};
  Vector<T> offset_{};
};

// The same entries with every term taken absolute: what an entry's error is relative to.
class Majorant {
 public:
  explicit Majorant(const PowerVertex& v) : v_(v) {}
  Row<double> row(const WeightedPoint& s) const {
    const auto abs_difference = [](const Vec3& a, const Vec3& b) {
      return Vec3{std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)};
    };
    const WeightedPoint& o = v_.spheres[0];
    const Vec3 d = abs_difference(s.center, o.center);
    Row<double> r;
    r.h = dot(d, d) + std::abs(s.weight) + std::abs(o.weight);
    if (v_.k == 3) {
      r.p = {d.x, d.y, d.z};
      return r;
    }
    r.h += 2 * dot(d, abs_difference(o.center, v_.simplex[0]));
    for (std::size_t a = 0; a < uz(v_.k); ++a) r.p[a] = dot(d, abs_difference(v_.simplex[a + 1], v_.simplex[0]));
    return r;
  }

 private:
  const PowerVertex& v_;
};

// Determinants by expansion; Sign = -1 gives determinants, +1 permanents.
template <int Sign, class T>
T det2(const T& a, const T& b, const T& c, const T& d) {
  if constexpr (Sign < 0)
    return a * d - b * c;
  else
    return a * d + b * c;
}

template <int Sign, class T>
T det3(const Vector<T>& a, const Vector<T>& b, const Vector<T>& c) {
  const T m0 = det2<Sign>(b[1], b[2], c[1], c[2]);
  const T m1 = det2<Sign>(b[0], b[2], c[0], c[2]);
  const T m2 = det2<Sign>(b[0], b[1], c[0], c[1]);
  if constexpr (Sign < 0)
    return a[0] * m0 - a[1] * m1 + a[2] * m2;
  else
    return a[0] * m0 + a[1] * m1 + a[2] * m2;
}

// det P of the first k rows' p parts.
template <int Sign, class T>
T det_p(int k, const std::array<Row<T>, 4>& r) {
  if (k == 0) return T(1);
  if (k == 1) return r[0].p[0];
  if (k == 2) return det2<Sign>(r[0].p[0], r[0].p[1], r[1].p[0], r[1].p[1]);
  return det3<Sign>(r[0].p, r[1].p, r[2].p);
}

// det [P h] of k + 1 rows, the last one being the other sphere's.
template <int Sign, class T>
T det_ph(int k, const std::array<Row<T>, 4>& r) {
  if (k == 0) return r[0].h;
  if (k == 1) return det2<Sign>(r[0].p[0], r[0].h, r[1].p[0], r[1].h);
  if (k == 2)
    return det3<Sign>(Vector<T>{r[0].p[0], r[0].p[1], r[0].h}, Vector<T>{r[1].p[0], r[1].p[1], r[1].h},
                      Vector<T>{r[2].p[0], r[2].p[1], r[2].h});
  const T m0 = det3<Sign>(r[1].p, r[2].p, r[3].p);
  const T m1 = det3<Sign>(r[0].p, r[2].p, r[3].p);
  const T m2 = det3<Sign>(r[0].p, r[1].p, r[3].p);
  const T m3 = det3<Sign>(r[0].p, r[1].p, r[2].p);
  if constexpr (Sign < 0)
    return r[3].h * m3 - r[2].h * m2 + r[1].h * m1 - r[0].h * m0;
  else
    return r[3].h * m3 + r[2].h * m2 + r[1].h * m1 + r[0].h * m0;
}

// det P with column `column` replaced by h: 2 t_column = this / det P.
template <int Sign, class T>
T det_cramer(int k, std::array<Row<T>, 4> r, int column) {
  for (int s = 0; s < k; ++s) r[uz(s)].p[uz(column)] = r[uz(s)].h;
  return det_p<Sign>(k, r);
}

template <class Builder, class T>
std::array<Row<T>, 4> rows_of(const Builder& builder, const PowerVertex& v, const WeightedPoint* other) {
  std::array<Row<T>, 4> r;
  for (int s = 1; s <= v.k; ++s) r[uz(s - 1)] = builder.row(v.spheres[uz(s)]);
  if (other) r[uz(v.k)] = builder.row(*other);
  return r;
}

// Sign of a computed determinant, 0 if its error bound does not decide.
int certain_sign(double value, double permanent) {
  if (!(permanent > kSmallestPermanent)) return 0;
  const double bound = kDeterminantError * permanent;
  return value > bound ? 1 : (value < -bound ? -1 : 0);
}

int sign_of(const Exact& x) {
  return static_cast<int>(CGAL::sign(x));
}

bool lexicographically_less(const Vec3& a, const Vec3& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

// Sign of the barycentric coordinate of p_m with respect to sphere `s` among the vertex's spheres, times sign(det P).
int barycentric_sign(int k, std::array<Row<Exact>, 4> r, int s) {
  const Row<Exact> m = r[uz(k)];
  if (s > 0) {
    r[uz(s - 1)] = m;
  } else {
    for (int j = 0; j < k; ++j)
      for (std::size_t a = 0; a < 3; ++a) r[uz(j)].p[a] = r[uz(j)].p[a] - m.p[a];
  }
  return sign_of(det_p<-1>(k, r));
}

// The tie pi_m = pi_0 under the perturbation w_s -> w_s - eps_s: pi_m - pi_0 gains eps_m - sum_s lambda_s eps_s, with
// lambda the barycentric coordinates of p_m; the greatest centre with a non-zero coefficient decides.
int perturbed_sign(const PowerVertex& v, const WeightedPoint& other, const std::array<Row<Exact>, 4>& rows,
                   int sign_p) {
  std::array<int, 4> order{0, 1, 2, 3};
  for (std::size_t n = 1; n <= uz(v.k); ++n)
    for (std::size_t j = n; j > 0; --j)
      if (lexicographically_less(v.spheres[uz(order[j - 1])].center, v.spheres[uz(order[j])].center))
        std::swap(order[j - 1], order[j]);
  for (int n = 0; n <= v.k; ++n) {
    const int s = order[uz(n)];
    if (lexicographically_less(v.spheres[uz(s)].center, other.center)) return 1;
    const int lambda = v.k == 0 ? 1 : barycentric_sign(v.k, rows, s) * sign_p;
    if (lambda != 0) return -lambda;
  }
  return 1;
}

int power_side_exact(const PowerVertex& v, const WeightedPoint& other) {
  ++exact_calls;
  const auto rows = rows_of<System<Exact>, Exact>(System<Exact>(v), v, &other);
  const int sign_p = sign_of(det_p<-1>(v.k, rows));
  const int sign = sign_of(det_ph<-1>(v.k, rows)) * sign_p;
  return sign != 0 ? sign : perturbed_sign(v, other, rows, sign_p);
}

// Twice the simplex parameters (2 t_a) of the vertex, exact and rounded.
std::array<double, 3> exact_parameters(const PowerVertex& v) {
  const auto rows = rows_of<System<Exact>, Exact>(System<Exact>(v), v, nullptr);
  const double denominator_scale = CGAL::to_double(det_p<-1>(v.k, rows));
  std::array<double, 3> t2{};
  for (int a = 0; a < v.k; ++a) t2[uz(a)] = CGAL::to_double(det_cramer<-1>(v.k, rows, a)) / denominator_scale;
  return t2;
}

// Position from the parameters; for k = 3 the parameters are coordinates from the first sphere's centre.
Vec3 position(const PowerVertex& v, const std::array<double, 3>& t2) {
  if (v.k == 3) return v.spheres[0].center + 0.5 * Vec3{t2[0], t2[1], t2[2]};
  Vec3 x = v.simplex[0];
  for (std::size_t a = 0; a < uz(v.k); ++a) x += (0.5 * t2[a]) * (v.simplex[a + 1] - v.simplex[0]);
  return x;
}

}  // namespace

int power_side(const PowerVertex& v, const WeightedPoint& other) {
  const auto rows = rows_of<System<double>, double>(System<double>(v), v, &other);
  const auto majorants = rows_of<Majorant, double>(Majorant(v), v, &other);
  const int sign_p = v.k == 0 ? 1 : certain_sign(det_p<-1>(v.k, rows), det_p<1>(v.k, majorants));
  if (sign_p != 0) {
    const int sign = certain_sign(det_ph<-1>(v.k, rows), det_ph<1>(v.k, majorants));
    if (sign != 0) return sign * sign_p;
  }
  return power_side_exact(v, other);
}

int power_side_inexact(const PowerVertex& v, const WeightedPoint& other) {
  const auto rows = rows_of<System<double>, double>(System<double>(v), v, &other);
  const double value = det_ph<-1>(v.k, rows) * det_p<-1>(v.k, rows);
  return value > 0 ? 1 : (value < 0 ? -1 : 0);
}

LocatedVertex locate(const PowerVertex& v, double accepted) {
  if (v.k == 0) return {v.simplex[0], 0};
  // Accept the plain solution if its error stays below this many units in the last place of the longest extent.
  constexpr double kAcceptedError = 64 * kUnit;
  const auto rows = rows_of<System<double>, double>(System<double>(v), v, nullptr);
  const auto majorants = rows_of<Majorant, double>(Majorant(v), v, nullptr);
  const double denominator = det_p<-1>(v.k, rows);
  const double denominator_error = kDeterminantError * det_p<1>(v.k, majorants);
  const double safe = std::abs(denominator) - denominator_error;

  std::array<double, 3> t2{};
  double error = 0;
  double extent = 0;
  for (int a = 0; a < v.k && safe > 0; ++a) {
    const auto index = uz(a);
    const double size = v.k == 3 ? 1 : norm(v.simplex[index + 1] - v.simplex[0]);
    t2[index] = det_cramer<-1>(v.k, rows, a) / denominator;
    const double numerator_error = kDeterminantError * det_cramer<1>(v.k, majorants, a);
    error += size * (numerator_error + std::abs(t2[index]) * denominator_error) / safe;
    extent = std::max(extent, size * std::abs(t2[index]));
  }
  const Vec3 base = v.k == 3 ? v.spheres[0].center : v.simplex[0];
  const double rounding = 8 * kUnit * (std::abs(base.x) + std::abs(base.y) + std::abs(base.z) + extent);
  if (safe > 0 && error <= std::max(accepted, kAcceptedError * (extent + norm(base))))
    return {position(v, t2), error + rounding};

  t2 = exact_parameters(v);
  extent = 0;
  for (int a = 0; a < v.k; ++a) {
    const auto index = uz(a);
    extent = std::max(extent, std::abs(t2[index]) * (v.k == 3 ? 1 : norm(v.simplex[index + 1] - v.simplex[0])));
  }
  return {position(v, t2), 8 * kUnit * (std::abs(base.x) + std::abs(base.y) + std::abs(base.z) + 3 * extent)};
}

std::size_t exact_power_sides() {
  return exact_calls;
}

}  // namespace matstruct
