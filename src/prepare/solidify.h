// From any triangle surface to a tetrahedral mesh of what it encloses, repairing no more than needed.
#pragma once

#include <vector>

#include <matstruct/context.h>
#include <matstruct/solid.h>
#include <matstruct/types.h>

namespace matstruct {

struct Solidified {
  TetMesh mesh;
  Repair repair;
};

/// Tries, one after the other until one gives a valid mesh: the surface as it is (tetrahedralise()); its triangles cut
/// where they meet, exactly, and the part kept that separates the inside (winding number above one half) from the
/// outside; the same after filling holes up to options.hole_size; a wrap, if options.allow_wrap. What was done is said
/// in the result and in a warning. Throws Error, saying what is wrong with the surface and what was tried.
/// `sharp`: known sharp edges, which merging of flat regions must keep.
Solidified solidify(const TriSurface& surface, const ReadOptions& options, Context& context,
                    const std::vector<SharpSegment>* sharp = nullptr);

}  // namespace matstruct
