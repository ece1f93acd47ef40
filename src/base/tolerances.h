// The one place of every tolerance. Lengths are relative to the bounding-box diagonal of the solid. Nothing here
// decides how the diagram or the medial mesh is connected: that is the exact predicates' work.
#pragma once

namespace matstruct::tolerance {

/// Sphere shrinking stops when the next radius is nearer to the present one than this (relative to the diagonal).
inline constexpr double kShrinkStep = 1e-12;
/// Radius of the first ball of sphere shrinking, in diagonals: larger than any medial sphere.
inline constexpr double kShrinkStart = 1.0;
/// A ball of sphere shrinking that has stopped at a smooth contact is good if its radius exceeds the distance of its
/// centre to the surface by less than this part.
inline constexpr double kSmoothGap = 1e-4;
/// A ball smaller than this (in diagonals) is no medial sphere but noise of the pin.
inline constexpr double kSmallestRadius = 1e-5;
/// Spheres of radius 0 on sharp lines and corners weigh as if their radius were this (in diagonals): where a medial
/// sphere touches the very end of a line, the two would tie.
inline constexpr double kFeatureReach = 2e-6;
/// Planes are parallel, or at right angles, if the sine (the cosine) of their angle is below this.
inline constexpr double kParallel = 1e-6;
/// The frame follows the planes of a solid if those of one direction have this share of its area.
inline constexpr double kPlanarShare = 0.01;
/// Internal coordinates are multiples of this (2^-28, in diagonals): far above the rounding of a file that was turned
/// or moved, far below what the contacts of a sphere may differ by. Results are moved back to the unrounded surface.
inline constexpr double kGrid = 0x1p-28;
/// A surface with a triangle lower than this (in grid widths) is not rounded, since the triangle might turn over.
inline constexpr double kGridHeights = 16;
/// A triangle lower than this (in diagonals), with a corner between the others, has no plane: it is removed. The height
/// of kGridHeights grid widths.
inline constexpr double kCap = kGridHeights * kGrid;
/// Triangles lie in one plane, and edges on one straight line, if the sine of their angle is below this; a triangle
/// also has to be within this of the plane (in diagonals). Far above the rounding of doubles, far below any meant
/// angle.
inline constexpr double kFlat = 1e-8;
/// Facets that turn by less than this, in degrees, are of one plane as far as the height of facets goes: rounding of
/// their vertices.
inline constexpr double kFlatTurn = 0.01;
/// The area of a flat region that was triangulated anew, and the volume of a solid that was filled anew, may differ by
/// this part. Far more than kFlat adds up to, far less than any part that was lost.
inline constexpr double kSameMeasure = 1e-6;
/// Two vertices of a surface file nearer than this (in diagonals) may be welded if that closes the surface.
inline constexpr double kWeld = 1e-7;
/// Seconds that a child process may take, and all those of one surface together.
inline constexpr double kMesherSeconds = 100;
/// Grids (in diagonals) to which a surface may be snapped if the mesher fails on what resolving its intersections left.
inline constexpr double kFineSnap = 1e-9, kCoarseSnap = 1e-6;
/// A sharp edge of a repaired surface is the input's if it lies within this of it (in diagonals).
inline constexpr double kSameEdge = 1e-4;
/// Below this sine of its angle a triangle corner is a needle, whose normal is computed in rational arithmetic.
inline constexpr double kNeedle = 1e-6;
/// A vertex of a clipped piece whose interpolated place may be off by more than this (in diagonals) is located anew,
/// exactly if need be. Bounds are far above errors: volumes stay good to kTilingVolume. Signs do not depend on it.
inline constexpr double kClippedVertex = 1e-12;
/// Bound of the sum of cell volumes against the volume of the solid (relative to the volume).
inline constexpr double kTilingVolume = 1e-9;
/// Angle in degrees by which a feature line may turn at a vertex before the vertex counts as a corner. Not 45: a
/// regular octagon turns by exactly that, and rounding would decide.
inline constexpr double kCornerTurn = 50;
/// A chain of sharp edges that is shorter than this (in diagonals), ends freely and turns by hardly more than the limit
/// of the angle is noise.
inline constexpr double kWeakLine = 0.1;
/// Bumps higher than this share of the spacing are shape even if the noise of the surface is as high: spheres can
/// follow them.
inline constexpr double kNoise = 0.6;
/// Edges that turn by less than this many times the limit of the angle are weak: there may be a line or not.
inline constexpr double kStrongTurn = 1.5;
/// A box is left out of a closest-point search if its squared distance exceeds the best one by more than this factor.
inline constexpr double kPruneSlack = 1 + 1e-12;
/// Boxes of that search are grown by this times the greatest coordinate: more than the rounding of a distance.
inline constexpr double kDistanceRounding = 1e-14;
/// A point less deep than this inside a medial primitive (in diagonals) is on the envelope for the metrics: rounding.
inline constexpr double kOnEnvelope = 1e-10;
/// A foot nearer to a concave sharp edge than this (in diagonals) lies on it: rounding of a closest-point query.
inline constexpr double kOnLine = 1e-10;
/// Samples nearer to the surface than this (in diagonals) take the face's normal: the direction to the foot is
/// rounding.
inline constexpr double kSampleDepth = 1e-3;

/// A ball touches what is nearer to its sphere than this (in diagonals).
inline constexpr double kTouch = 1e-8;
/// A sphere is tangent to its contacts if their distances from the centre differ by less than this (in diagonals).
inline constexpr double kTangent = 1e-9;
/// Contacts of a symmetric part, whose distances are equal but for the rounding of its file, differ by less than this
/// (in diagonals).
inline constexpr double kSameDistance = 1e-6;

/// The ball in the middle of an edge or face may hold a part of the surface this deep, in lengths of the edge, and
/// still count as one of the sheet.
inline constexpr double kInSheet = 1e-3;
/// Step and number of steps (the paper's) by which a sphere's centre is shifted away from its first contact, in radii,
/// until a second one shows. They bound the error of a sphere that still counts as medial.
inline constexpr double kContactShift = 0.01;
inline constexpr int kContactShifts = 10;
/// Halvings of the step with which a contact appears, so that it is the first one near seams.
inline constexpr int kContactHalvings = 8;
/// Neighbours of a seam or junction sphere from which its contacts are told are not farther from it than this (in its
/// radii): a longer edge is subdivided. What is farther away may touch other parts of the solid. Beside a seam that is
/// shorter they are not farther than it is long, but not nearer than what the shifts can tell apart.
inline constexpr double kNeighbourReach = 0.25, kLeastReach = 1e-3;
/// Angle in degrees by which the nearest surface point has to turn, seen from a shifted centre, to count as a second
/// contact though the surface joins the two: at a smooth end of a sheet it turns by at least 24 within all shifts.
inline constexpr double kContactTurn = 20;

}  // namespace matstruct::tolerance
