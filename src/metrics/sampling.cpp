#include "metrics/sampling.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "geometry/primitives.h"

namespace matstruct {

std::vector<TriangleSample> sample_by_area(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                           Index samples) {
  constexpr double kPlastic = 1.32471795724474602596;  // root of x^3 = x + 1
  if (triangles.empty()) return {};
  std::vector<double> area_up_to;
  double total = 0;
  for (const auto& [i, j, k] : triangles)
    area_up_to.push_back(total += triangle_area(vertices[uz(i)], vertices[uz(j)], vertices[uz(k)]));
  std::vector<TriangleSample> places;
  for (Index s = 0; s < samples; ++s) {
    const double area = total * (s + 0.5) / samples;
    const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, area);
    places.push_back({static_cast<Index>(found - area_up_to.begin()), std::sqrt(std::fmod(s / kPlastic, 1)),
                      std::fmod(s / (kPlastic * kPlastic), 1)});
  }
  return places;
}

double diagonal_of(const TriSurface& surface) {
  if (surface.triangles.empty()) return 0;
  Vec3 low = surface.vertices[uz(surface.triangles.front()[0])], high = low;
  for (const Triangle& t : surface.triangles) {
    for (const Index v : t) {
      low = min(low, surface.vertices[uz(v)]);
      high = max(high, surface.vertices[uz(v)]);
    }
  }
  return distance(low, high);
}

}  // namespace matstruct
