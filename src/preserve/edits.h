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

/// Spheres as near to each other, in spacings, are copies: their cells would share what one of them should have.
inline constexpr double kCopy = 0.01;

/// The spheres that are alive, guards left out, with a centre nearer than `near`, ascending. O(#seeds).
std::vector<Index> spheres_near(const Spheres& spheres, const Vec3& center, double near);

/// Removes, then inserts. A proposed sphere whose centre lies within `closest` of that of a sphere inserted by the same
/// call, and on the same line if on any, is left out: two proposals often have the same cause.
AppliedEdits apply_edits(Spheres& spheres, const Edits& edits, double closest);

}  // namespace matstruct
