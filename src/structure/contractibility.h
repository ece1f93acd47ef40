// Where the cells of a restricted power diagram fail the nerve theorem.
//
// If every non-empty cell, facet and edge is contractible, the dual complex (the nerve) is homotopy equivalent to the
// solid. A cell is S intersected with a convex polytope: it is contractible if it is connected, has Euler
// characteristic 1 and encloses no cavity of the solid (a bounded piece of its complement can only be such a cavity). A
// facet lies in a plane: connected and Euler characteristic 1. An edge lies on a line: connected.
#pragma once

#include <vector>

#include <matstruct/context.h>

#include "prepare/domain.h"
#include "rpd/pinch_contacts.h"
#include "rpd/rpd.h"

namespace matstruct {

enum class ViolationKind : std::uint8_t {
  kCellDisconnected,
  kCellEuler,
  kCellCavity,
  kFacetDisconnected,
  kFacetEuler,
  kEdgeDisconnected,
  kGuard,  ///< a guard cannot be removed from the dual complex (extract/guards.h); not reported by check_contractible()
};

/// One offending component: all components but the greatest of a disconnected set, or the set itself otherwise.
struct Violation {
  ViolationKind kind = ViolationKind::kCellDisconnected;
  Triangle spheres{kInvalid, kInvalid, kInvalid};  ///< the set's 1, 2 or 3 spheres, ascending
  std::vector<Index> records;                      ///< the component's records in Rpd::cells, facets or edges
};

struct Contractibility {
  std::vector<Violation> violations;  ///< sorted by kind, then spheres
  /// Names on shared tet facets that only one side has: 0 unless the diagram was computed inexactly.
  Index mismatches = 0;
};

/// Connected components of all cells, facets and edges, each named by the least of its records. Cost O(records).
struct RpdComponents {
  std::vector<Index> cells, facets, edges;  ///< #records each: the component
  Index mismatches = 0;                     ///< as in Contractibility
};
RpdComponents rpd_components(const Domain& domain, const Rpd& rpd, const std::vector<PinchContact>& contacts = {});

/// All records of the cell of each given sphere, as a violation of the given kind.
std::vector<Violation> whole_cells(const Rpd& rpd, const std::vector<Index>& spheres, ViolationKind kind);
/// All records of the facet between each given pair (ascending), likewise.
std::vector<Violation> whole_facets(const Rpd& rpd, const std::vector<Edge>& pairs, ViolationKind kind);

/// Cost O(records log records).
/// `contacts`: as found by pinch_contacts(), for a solid that touches itself.
Contractibility check_contractible(const Domain& domain, const Rpd& rpd,
                                   const std::vector<PinchContact>& contacts = {});

}  // namespace matstruct
