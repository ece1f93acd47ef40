// Which parts of the surface each power cell belongs to, told from volume samples: the contacts of its sphere.
//
// Two samples of one cell are in one cluster if they hang together on the surface within the cell's samples, without
// crossing a convex sharp edge; all samples on one concave line are one cluster. The sub-volumes of the solid below the
// clusters are what the cell meets, and their number is the contact order of its sphere. Deciding this by the cell's
// samples, not by the sphere's exact contacts, sees a seam or junction that passes through the cell beside the sphere.
#pragma once

#include <span>
#include <vector>

#include <matstruct/types.h>

#include "base/union_find.h"
#include "spheres/volume_samples.h"

namespace matstruct {

struct ContactCluster {
  Vec3 foot;                  ///< mean of the samples' feet
  Vec3 normal;                ///< mean of their normals, not unit: its length tells the spread, 1 on a plane
  double weight = 0;          ///< sum of the samples' weights
  Index triangle = kInvalid;  ///< that of the sample nearest to the mean foot
  Index line = kInvalid;      ///< concave feature line, if most of the weight is on it
};

struct CellContacts {
  std::vector<Index> start;  ///< #spheres + 1: clusters of sphere s are start[s] .. start[s + 1], heaviest first
  std::vector<ContactCluster> clusters;
  std::vector<Index> member_start;  ///< #clusters + 1: samples of cluster c are members[member_start[c]] .., ascending
  std::vector<Index> members;
  std::vector<Edge> links;  ///< pairs of clusters of two cells that lie side by side, both ways, sorted
};

struct ContactOptions {
  /// Samples on one patch whose normals differ by at most this belong to one contact wherever they are, radians: a
  /// sphere touches a patch in one place per direction. Joins what thin cells have too few samples to connect.
  double same_direction = 0.52;
  double least_share = 0.02;  ///< clusters with less of their cell's weight are left out: chance hits; in [0, 1)
};

/// Unites samples, named by their places `ids` among `samples`, on one patch whose normals differ by at most `angle`
/// (radians, > 0), and those on one line. Sorts the samples; compares them one by one only where many of two clusters
/// lie just further apart than that.
void join_directions(std::span<const VolumeSample> samples, std::span<const Index> ids, double angle, UnionFind& sets);

/// Clusters of the cells of spheres 0 .. `spheres` - 1, of which `owners` gives the one that owns each sample. Linear
/// in the links, and as join_directions() in the samples of each cell. A cell without samples has no clusters.
CellContacts cell_contacts(const VolumeSamples& samples, std::span<const Index> owners, Index spheres,
                           const ContactOptions& options);

/// Number of sub-volumes that the cell of `sphere` meets; 0 if it holds no sample.
Index contact_order(const CellContacts& contacts, Index sphere);

/// Whether all sub-volumes that `cell` meets go on into `other`; true for a cell without samples.
bool goes_on(const CellContacts& contacts, Index cell, Index other);
/// Whether the dual edge between two cells stays inside one sheet, seam or the like: the sub-volumes that go on from
/// one cell to the other are all of those of at least one of the two. An edge to a cell without samples is valid.
bool is_valid_edge(const CellContacts& contacts, const Edge& edge);
/// A face is valid if its three edges are.
bool is_valid_face(const CellContacts& contacts, const Triangle& face);

}  // namespace matstruct
