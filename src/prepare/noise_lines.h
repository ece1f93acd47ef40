// Telling feature lines from edges that only happen to turn by more than the limit.
#pragma once

#include <vector>

#include <matstruct/options.h>

#include "prepare/domain.h"

namespace matstruct {

struct NoiseLines {
  std::vector<char> noise;  ///< of each sharp edge
  bool mostly = false;      ///< more than a quarter of the length of all edges is noise at first sight
};

/// Finds the noise among edges that are sharp by their angle. A chain runs through vertices with two sharp edges, of
/// whatever kind; its end is free if no other sharp edge arrives there. An edge is weak if it turns by less than one
/// and a half times the limit of its kind, a chain or a connected set if its edges are on average, weighted by length.
/// Noise is:
/// - a chain with a free end that is shorter than `diagonal` / gamma, or weak and shorter than tolerance::kWeakLine;
///   again and again, as removing a chain may free the end of another;
/// - a connected set of sharp edges that is weak and altogether shorter than tolerance::kWeakLine.
/// If this is more than a quarter of the length of all edges, the surface is a scan and the limit cuts through its
/// noise: edges are then weak below twice the limit, and chains with a free end and connected sets are noise if weak,
/// or shorter than kWeakLine in the case of sets. The result does not depend on the order of vertices, but for
/// rounding.
NoiseLines find_noise_lines(const TriSurface& surface, const std::vector<SharpEdge>& edges, double diagonal,
                            const Options& options);

}  // namespace matstruct
