#include "spheres/feature_spheres.h"

#include <cmath>

#include "base/index.h"
#include "base/tolerances.h"

namespace matstruct {

namespace {

// Arc length at the start of each edge of a line, and its whole length at the end.
std::vector<double> arc_lengths(const Domain& domain, const FeatureLine& line) {
  std::vector<double> length{0};
  for (std::size_t k = 0; k < line.edges.size(); ++k) {
    const Vec3& a = domain.surface.vertices[uz(line.vertices[k])];
    const Vec3& b = domain.surface.vertices[uz(line.vertices[(k + 1) % line.vertices.size()])];
    length.push_back(length.back() + distance(a, b));
  }
  return length;
}

double length_at(const std::vector<double>& arc, double position) {
  const auto k = std::min(static_cast<std::size_t>(position), arc.size() - 2);
  return arc[k] + (position - static_cast<double>(k)) * (arc[k + 1] - arc[k]);
}

double position_at(const std::vector<double>& arc, double length) {
  const auto above = std::upper_bound(arc.begin() + 1, arc.end() - 1, length);
  const auto k = static_cast<std::size_t>(above - arc.begin()) - 1;
  return static_cast<double>(k) + (length - arc[k]) / (arc[k + 1] - arc[k]);
}

}  // namespace

Vec3 point_on_line(const Domain& domain, const FeatureLine& line, double position) {
  const auto k = std::min(static_cast<std::size_t>(position), line.edges.size() - 1);
  const Vec3& a = domain.surface.vertices[uz(line.vertices[k])];
  const Vec3& b = domain.surface.vertices[uz(line.vertices[(k + 1) % line.vertices.size()])];
  return lerp(a, b, position - static_cast<double>(k));
}

std::vector<Vec3> points_of_line(const Domain& domain, const FeatureLine& line) {
  std::vector<Vec3> points;
  for (const Index v : line.vertices) points.push_back(domain.surface.vertices[uz(v)]);
  if (line.closed) points.push_back(points.front());
  return points;
}

double middle_of_line(const Domain& domain, const FeatureLine& line, double from, double to) {
  const std::vector<double> arc = arc_lengths(domain, line);
  const double edges = static_cast<double>(line.edges.size());
  const double end = to <= edges ? length_at(arc, to) : arc.back() + length_at(arc, to - edges);
  const double middle = (length_at(arc, from) + end) / 2;
  return position_at(arc, middle <= arc.back() ? middle : middle - arc.back());
}

std::vector<SphereSeed> feature_spheres(const Domain& domain, double spacing) {
  std::vector<SphereSeed> seeds;
  const double reach = tolerance::kFeatureReach * domain.diagonal;
  std::vector<bool> has_corner(domain.surface.vertices.size(), false);
  for (const FeatureLine& line : domain.features.lines) {
    if (line.kind != EdgeKind::kConvex || line.closed) continue;
    for (const Index v : {line.vertices.front(), line.vertices.back()}) {
      if (has_corner[uz(v)]) continue;
      has_corner[uz(v)] = true;
      seeds.push_back({domain.surface.vertices[uz(v)], 0, SphereType::kCorner, kInvalid, v, 0, reach});
    }
  }
  for (Index l = 0; l < count(domain.features.lines); ++l) {
    const FeatureLine& line = domain.features.lines[uz(l)];
    if (line.kind != EdgeKind::kConvex) continue;
    const std::vector<double> arc = arc_lengths(domain, line);
    const int pieces = std::max(line.closed ? 3 : 2, static_cast<int>(std::ceil(arc.back() / spacing)));
    for (int k = line.closed ? 0 : 1; k < pieces; ++k) {
      const double position = position_at(arc, arc.back() * k / pieces);
      seeds.push_back({point_on_line(domain, line, position), 0, SphereType::kSharpEdge, l, kInvalid, position, reach});
    }
  }
  return seeds;
}

}  // namespace matstruct
