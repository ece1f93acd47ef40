// Triangle soup: what the repairs work on.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "prepare/mesher/protocol.h"

namespace matstruct::mesher {

using Inexact = CGAL::Exact_predicates_inexact_constructions_kernel;

struct Soup {
  std::vector<Inexact::Point_3> points;
  std::vector<std::array<std::size_t, 3>> triangles;

  Inexact::Point_3 corner(std::size_t triangle, std::size_t k) const { return points[triangles[triangle][k]]; }
  Inexact::Triangle_3 triangle(std::size_t t) const { return {corner(t, 0), corner(t, 1), corner(t, 2)}; }
};

Soup soup_of(const Request& request);

/// The triangles with their points, unused ones left out.
Answer answer_of(const Soup& soup);

/// Makes equal points one and drops triangles whose corners lie on a line, exactly.
void weld_and_drop_flat(Soup& soup);

/// Pairs of triangles that meet elsewhere than in a common vertex or edge; triangles with the same corners do not
/// count.
std::vector<std::array<std::size_t, 2>> intersecting_pairs(const Soup& soup);

double diagonal(const Soup& soup);

}  // namespace matstruct::mesher
