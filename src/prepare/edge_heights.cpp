#include "prepare/edge_heights.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "base/index.h"
#include "base/tolerances.h"
#include "query/face_angle.h"

namespace matstruct {

namespace {

// Share of the edges that are no higher than what is taken as their height.
constexpr double kMost = 0.9;

class Heights {
 public:
  Heights(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
          const std::vector<Vec3>& normals, double smooth)
      : surface_(surface), neighbors_(neighbors), normals_(normals), smooth_(smooth) {}

  void add(Index triangle, std::size_t local) {
    const Triangle& t = surface_.triangles[uz(triangle)];
    const double length =
        distance(surface_.vertices[uz(t[(local + 1) % 3])], surface_.vertices[uz(t[(local + 2) % 3])]);
    found_.emplace_back(edge_height(surface_, neighbors_, normals_, triangle, local, smooth_) / 2, length);
    all_ += length;
  }

  double of_most() && {
    std::sort(found_.begin(), found_.end());
    double length = 0;
    for (const auto& [height, edge_length] : found_)
      if ((length += edge_length) >= kMost * all_) return height;
    return 0;
  }

 private:
  const TriSurface& surface_;
  const std::vector<std::array<Index, 3>>& neighbors_;
  const std::vector<Vec3>& normals_;
  double smooth_;
  std::vector<std::pair<double, double>> found_;  // height, length
  double all_ = 0;
};

}  // namespace

double height_of_edges(const TriSurface& surface, const std::vector<std::array<Index, 3>>& neighbors,
                       const std::vector<Vec3>& normals, const std::vector<SharpEdge>& edges, double smooth) {
  Heights heights(surface, neighbors, normals, smooth);
  for (const SharpEdge& e : edges) {
    const auto& beside = neighbors[uz(e.triangles[0])];
    const auto local = std::find(beside.begin(), beside.end(), e.triangles[1]) - beside.begin();
    heights.add(e.triangles[0], static_cast<std::size_t>(local));
  }
  return std::move(heights).of_most();
}

double height_of_facets(const Domain& domain, double smooth) {
  Heights heights(domain.surface, domain.triangle_neighbors, domain.triangle_normals, smooth);
  for (Index t = 0; t < count(domain.surface.triangles); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = domain.triangle_neighbors[uz(t)][k];
      if (other < t || domain.features.triangle_edges[uz(t)][k] != kInvalid) continue;
      const double turn = angle_between(domain.triangle_normals[uz(t)], domain.triangle_normals[uz(other)]);
      if (turn >= tolerance::kFlatTurn * std::numbers::pi / 180) heights.add(t, k);
    }
  return std::move(heights).of_most();
}

double height_of_facet(const Domain& domain, Index triangle, double smooth) {
  double height = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (domain.features.triangle_edges[uz(triangle)][k] == kInvalid)
      height = std::max(
          height,
          edge_height(domain.surface, domain.triangle_neighbors, domain.triangle_normals, triangle, k, smooth) / 2);
  return height;
}

}  // namespace matstruct
