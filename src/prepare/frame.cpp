#include "prepare/frame.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <matstruct/error.h>

#include "base/index.h"
#include "base/tolerances.h"
#include "prepare/messages.h"
#include "prepare/weld.h"

namespace matstruct {

namespace {

constexpr int kGreatestExponent = 1000;  // leaves room to square a length that was scaled to about 1
constexpr int kDirections = 64;          // directions that are looked at, those of the largest triangles
constexpr double kEqual = 1e-9;          // relative: what differs by less is equal but for rounding

struct Box {
  Vec3 low, high;
  double diagonal() const { return std::hypot(high.x - low.x, high.y - low.y, high.z - low.z); }
};

template <class Map>
Box box_of(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles, const Map& map) {
  const Vec3 first = map(points[uz(triangles.front()[0])]);
  Box box{first, first};
  for (const Triangle& t : triangles)
    for (const Index v : t) {
      const Vec3 p = map(points[uz(v)]);
      box.low = min(box.low, p);
      box.high = max(box.high, p);
    }
  return box;
}

// The triangles in an order and each from a vertex that depend on the vertices' ids only, so that sums do, too.
void sort_triangles(std::vector<Triangle>& triangles) {
  for (Triangle& t : triangles) std::sort(t.begin(), t.end());
  std::sort(triangles.begin(), triangles.end());
}

struct Direction {
  Vec3 normal;
  double area = 0;
};

// A surface of about unit size around the origin.
class Pose {
 public:
  Pose(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles)
      : points_(points), triangles_(triangles) {}

  std::optional<std::array<Vec3, 3>> axes() {
    find_directions();
    const Direction* first = greatest([](const Direction&) { return true; });
    if (!first || first->area < tolerance::kPlanarShare * total_) return std::nullopt;
    const Vec3 n = first->normal;
    const Direction* second =
        greatest([&](const Direction& d) { return std::abs(dot(d.normal, n)) < tolerance::kParallel; });
    const Vec3 across = second ? second->normal : farthest_from_axis(n);
    const Vec3 b = normalized(across - n * dot(across, n));
    if (!(norm2(b) > 0)) return std::nullopt;
    return ordered({n, b, cross(n, b)});
  }

 private:
  const Vec3& corner(const Triangle& t, std::size_t k) const { return points_[uz(t[k])]; }

  // Largest triangles first: small ones of a plane have noisy normals.
  void find_directions() {
    std::vector<Direction> left;
    for (const Triangle& t : triangles_) {
      const Vec3 n = cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
      const double area = norm(n) / 2;
      centroid_ += (corner(t, 0) + corner(t, 1) + corner(t, 2)) * (area / 3);
      total_ += area;
      if (area > 0) left.push_back({normalized(n), area});
    }
    if (total_ > 0) centroid_ = centroid_ / total_;
    while (!left.empty() && directions_.size() < kDirections) {
      Direction found = left.front();
      for (const Direction& d : left)
        if (d.area > found.area * (1 + kEqual)) found = d;
      Direction mean;  // of all that are parallel: rounding averages out
      std::erase_if(left, [&](const Direction& d) {
        if (norm(cross(d.normal, found.normal)) >= tolerance::kParallel) return false;
        mean.area += d.area;
        mean.normal += d.normal * std::copysign(d.area, dot(d.normal, found.normal));
        return true;
      });
      mean.normal = normalized(mean.normal);
      directions_.push_back(mean);
    }
  }

  template <class Fits>
  const Direction* greatest(const Fits& fits) const {
    const Direction* best = nullptr;
    for (const Direction& d : directions_)
      if (fits(d) && (!best || d.area > best->area * (1 + kEqual))) best = &d;
    return best;
  }

  Vec3 farthest_from_axis(const Vec3& n) const {
    Vec3 best;
    for (const Triangle& t : triangles_)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 arm = corner(t, k) - centroid_, out = arm - n * dot(arm, n);
        if (norm2(out) > norm2(best) * (1 + kEqual)) best = out;
      }
    return best;
  }

  // What tells one way of an axis from the other, in the order in which it counts: how far the area spreads (which is
  // the same both ways), to which side it leans, and to which side the later vertices lie.
  std::array<double, 3> marks(const Vec3& axis) const {
    std::array<double, 3> sums{};
    const double count_of = static_cast<double>(points_.size());
    for (const Triangle& t : triangles_) {
      const Vec3 n = cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
      const double area = norm(n) / 2;
      std::array<double, 3> f{};
      for (std::size_t k = 0; k < 3; ++k) {
        f[k] = dot(axis, corner(t, k) - centroid_);
        sums[2] += area * f[k] * static_cast<double>(t[k]) / count_of;
      }
      const auto [a, b, c] = f;
      sums[0] += area / 6 * (a * a + b * b + c * c + a * b + b * c + c * a);
      sums[1] += area / 10 * (a * a * (a + b + c) + b * b * (a + b + c) + c * c * (a + b + c) + a * b * c);
    }
    return sums;
  }

  // The right-handed choice of axes and their signs whose marks are greatest.
  std::array<Vec3, 3> ordered(const std::array<Vec3, 3>& axes) const {
    std::array<std::array<double, 3>, 3> mark{};
    for (std::size_t k = 0; k < 3; ++k) mark[k] = marks(axes[k]);
    struct Choice {
      std::array<std::size_t, 3> order;
      std::array<double, 3> sign;
      std::array<double, 9> key;
    };
    std::optional<Choice> best;
    std::array<std::size_t, 3> order{0, 1, 2};
    do {
      const bool even = (order[1] + 3 - order[0]) % 3 == 1;
      for (int signs = 0; signs < 4; ++signs) {
        Choice choice{.order = order, .sign = {}, .key = {}};
        choice.sign[0] = signs & 1 ? -1 : 1;
        choice.sign[1] = signs & 2 ? -1 : 1;
        choice.sign[2] = choice.sign[0] * choice.sign[1] * (even ? 1 : -1);
        for (std::size_t k = 0; k < 3; ++k) {
          choice.key[k] = mark[order[k]][0];
          choice.key[3 + k] = mark[order[k]][1] * choice.sign[k];
          choice.key[6 + k] = mark[order[k]][2] * choice.sign[k];
        }
        if (!best || exceeds(choice.key, best->key)) best = choice;
      }
    } while (std::next_permutation(order.begin(), order.end()));
    std::array<Vec3, 3> result;
    for (std::size_t k = 0; k < 3; ++k) result[k] = axes[best->order[k]] * best->sign[k];
    return result;
  }

  bool exceeds(const std::array<double, 9>& a, const std::array<double, 9>& b) const {
    for (std::size_t k = 0; k < a.size(); ++k)
      if (std::abs(a[k] - b[k]) > kEqual * total_) return a[k] > b[k];
    return false;
  }

  const std::vector<Vec3>& points_;
  const std::vector<Triangle>& triangles_;
  Vec3 centroid_;
  double total_ = 0;
  std::vector<Direction> directions_;
};

// Whether different points stay different in a frame that rounds, and no triangle is too low for it.
bool keeps_apart(const Frame& rounded, const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  std::vector<Vec3> mapped;
  mapped.reserve(points.size());
  for (const Vec3& p : points) mapped.push_back(rounded.to_internal(p));
  const double least = tolerance::kGridHeights * rounded.grid;
  const auto is_low = [&](const Triangle& t) {
    const Vec3 &a = mapped[uz(t[0])], &b = mapped[uz(t[1])], &c = mapped[uz(t[2])];
    const double longest = std::sqrt(std::max({distance2(a, b), distance2(b, c), distance2(c, a)}));
    return norm(cross(b - a, c - a)) < least * longest;
  };
  return std::none_of(triangles.begin(), triangles.end(), is_low) && weld_equal(mapped) == weld_equal(points);
}

}  // namespace

Frame fit_frame(const std::vector<Vec3>& points, std::vector<Triangle> triangles, Coordinates coordinates) {
  if (triangles.empty()) throw Error("the model has no triangles.");
  sort_triangles(triangles);
  const Box file = box_of(points, triangles, [](const Vec3& p) { return p; });
  const double size = file.diagonal();
  if (size == 0) throw Error(fmt::format("the model has no extent: all its vertices are at {}.", place(file.low)));
  int exponent = 0;
  if (std::isfinite(size)) std::frexp(size, &exponent);
  if (!std::isfinite(size) || std::abs(exponent) > kGreatestExponent)
    throw Error(
        fmt::format("the model's extent, {:.3g}, is beyond what can be computed with; use another unit.", size));

  Frame frame{.offset = file.low + (file.high - file.low) * 0.5, .scale = std::ldexp(1.0, -exponent)};
  std::vector<Vec3> near(points.size());
  for (const Triangle& t : triangles)
    for (const Index v : t) near[uz(v)] = frame.to_internal(points[uz(v)]);
  if (const auto axes = Pose(near, triangles).axes()) frame.axes = *axes;

  const Box box = box_of(near, triangles, [&](const Vec3& p) { return frame.turned(p); });
  frame.offset = frame.to_input((box.low + box.high) * 0.5);
  if (coordinates == Coordinates::kRounded) {
    Frame rounded = frame;
    rounded.scale /= box.diagonal();
    rounded.grid = tolerance::kGrid;
    if (keeps_apart(rounded, points, triangles)) return rounded;
  }
  int rest = 0;
  if (std::frexp(box.diagonal(), &rest) == 0.5) --rest;
  frame.scale = std::ldexp(frame.scale, -rest);
  return frame;
}

}  // namespace matstruct
