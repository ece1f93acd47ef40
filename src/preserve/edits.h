// Changes of the sphere set: proposed by the preservation steps, made here and nowhere else.
#pragma once

#include <vector>

#include "model/spheres.h"

namespace matstruct {

/// Changes that a step asks for.
struct Edits {
  std::vector<SphereSeed> insert;
  std::vector<Index> remove;  ///< ids; dead ones and repetitions are passed over
};

/// What an application did.
struct AppliedEdits {
  std::vector<Index> inserted;  ///< new ids
  std::vector<Index> removed;
};

/// Leaves proposed spheres out that are copies of one that is alive and no guard, to within a hundredth of the spacing:
/// the cells of the two would share what one of them should have.
void leave_out_copies(const Spheres& spheres, double spacing, Edits& edits);

/// Removes, then inserts. A proposed sphere whose centre lies within `closest` of that of a sphere inserted by the same
/// call, and on the same line if on any, is left out: two proposals often have the same cause.
AppliedEdits apply_edits(Spheres& spheres, const Edits& edits, double closest);

}  // namespace matstruct
