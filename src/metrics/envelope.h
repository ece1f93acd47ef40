// The envelope of a medial mesh: the boundary of the union of its primitives.
#pragma once

#include <optional>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/types.h>

#include "metrics/medial_tree.h"

namespace matstruct {

/// Points of the envelope. Sums of `weight * value` approximate integrals over the envelope.
struct EnvelopeSamples {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;    ///< unit, outward from the primitive that a point is on
  std::vector<double> weights;  ///< area that a point stands for; 0 where a primitive has no area
};

class Envelope {
 public:
  /// Takes about `samples` points of the envelope; input units. `tolerance`: a point less deep than this in a primitive
  /// still counts as a point of the envelope.
  Envelope(const MedialMesh& mesh, Index samples, double tolerance, const Context& context);

  const EnvelopeSamples& samples() const { return samples_; }

  /// Distance from `x` to the envelope. Exact for a point outside the union, and inside it where the nearest boundary
  /// point of the primitive in which `x` is deepest is on the envelope. Elsewhere the distance to the nearest point of
  /// the envelope that a local search from two starts and the nearest sample finds: never less than the true distance,
  /// whereas the depth in a primitive would be.
  double distance(const Vec3& x) const;

 private:
  std::optional<Vec3> walk_out(Vec3 y) const;
  Vec3 approach(const Vec3& x, Vec3 y) const;

  double tolerance_;
  MedialTree tree_;
  EnvelopeSamples samples_;
  MedialTree sample_tree_;  // the samples as balls of radius 0
};

}  // namespace matstruct
