// One piece of the restricted power diagram: a power cell clipped to a tetrahedron.
//
// The clipped polytope is simple (the perturbation of power_predicates.h leaves no four planes through a point), so it
// is kept as a graph of vertices with three planes and three neighbours each; a new plane removes the vertices beyond
// it and closes the hole. All signs come from exact predicates, so that two pieces that share a facet agree on it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <matstruct/types.h>

#include "geometry/power_predicates.h"

namespace matstruct {

/// Planes 0..3 are the tet's facets (facet k lies opposite local vertex k); planes from 4 on are bisectors of the
/// sphere and its neighbours (Clipper::sphere_of_plane), in the order in which clip() was given them.
inline constexpr int kFirstBisector = 4;

struct PieceVertex {
  std::array<std::int32_t, 3> planes{};     ///< the tet's facets first, then bisectors as they cut
  std::array<std::int32_t, 3> neighbors{};  ///< vertex across the edge that leaves planes[k]
  Vec3 point;
  double error = 0;  ///< bound of the error of `point`
};

/// The half-space that the cell of a sphere keeps against another: power distance to the other less that to the sphere
/// itself = constant - gradient . (x - centre of the sphere) >= 0.
struct Bisector {
  Index other = kInvalid;
  Vec3 gradient;
  double steepness = 0;  ///< hardly more than |gradient|, never less
  double constant = 0;
  double magnitude = 0;  ///< sum of the terms of `constant`, all taken positive
};
Bisector bisector(const std::vector<WeightedPoint>& spheres, Index self, Index other);

/// kPlain decides by doubles alone and is wrong near ties: for tests that show what exactness buys.
enum class Arithmetic { kExact, kPlain };

/// Reusable workspace that clips one piece at a time; no allocation once its buffers have grown.
class Clipper {
 public:
  explicit Clipper(Arithmetic arithmetic = Arithmetic::kExact) : arithmetic_(arithmetic) {}

  /// Clips tet `corners` to the cell of sphere `self` among `spheres`, against its bisectors with others. Returns false
  /// if nothing is left.
  bool clip(const std::array<Vec3, 4>& corners, const std::vector<WeightedPoint>& spheres, Index self,
            std::span<const Bisector> bisectors);

  /// The piece of the last clip() that returned true.
  const std::vector<PieceVertex>& vertices() const { return vertices_; }
  /// Sphere behind a bisector plane.
  Index sphere_of_plane(int plane) const { return at(plane).bisector.other; }
  /// Planes that carry a facet of the piece, ascending.
  const std::vector<int>& planes();
  /// Vertices of the facet on `plane`, in cyclic order, into `polygon`.
  void polygon(int plane, std::vector<int>& polygon) const;
  double volume();
  /// Area of the facet on the bisector with a sphere of greater id: it is asked for once from each facet's two sides.
  double area(int plane);
  /// True if the graph closed inconsistently, which only plain arithmetic can cause.
  bool broken() const { return broken_; }

 private:
  // A bisector that may cut the tet, with a bound of its value's rounding there.
  struct Plane {
    Bisector bisector;
    double rounding = 0;
  };
  // A new vertex on edge `edge` of a kept vertex (its last neighbour), and its number.
  struct Crossing {
    PieceVertex vertex;
    std::size_t edge = 0;
    std::int32_t place = kInvalid;
  };
  // A bisector that may cut, and about the distance of the tet's middle from it, negative if the middle is beyond.
  struct Cut {
    double distance = 0;
    int plane = 0;
  };

  void start_from_tet();
  const Plane& at(int plane) const { return planes_cut_[static_cast<std::size_t>(plane - kFirstBisector)]; }
  void collect_planes(std::span<const Bisector> bisectors);
  double value(const Bisector& b, const Vec3& x) const { return b.constant - dot(b.gradient, x - center_); }
  int side(std::size_t vertex, const Plane& plane) const;
  PowerVertex name(const PieceVertex& v) const;
  void cut(int plane);
  void find_crossings(int plane);
  void place(PieceVertex& v, std::size_t kept, std::size_t removed, const Plane& plane);
  void replace_removed();
  void link_crossings();
  void fill_holes();
  void measure();

  Arithmetic arithmetic_;
  bool broken_ = false, measured_ = false;
  const std::vector<WeightedPoint>* spheres_ = nullptr;
  Index self_ = kInvalid;
  std::array<Vec3, 4> corners_;
  Vec3 center_;
  std::vector<Plane> planes_cut_;  // from kFirstBisector on
  std::vector<Cut> cuts_;          // nearest first
  std::vector<PieceVertex> vertices_;
  double greatest_error_ = 0;  // of any vertex so far
  // Of the bisector at hand: its values at the vertices, which are kept and which not, and new vertices.
  std::vector<double> values_;
  std::vector<std::uint8_t> kept_;
  std::vector<std::int32_t> removed_;
  std::vector<Crossing> crossings_;
  std::vector<std::int32_t> open_;  // per plane: 2 v + k for a new vertex v that lacks neighbour k there
  // The piece's measures.
  std::vector<int> planes_;
  std::vector<std::int32_t> poles_;  // per plane: one vertex of the facet
  std::vector<double> areas_;        // per plane that area() may be asked for: twice the area times |gradient|
  double volume_ = 0;
};

}  // namespace matstruct
