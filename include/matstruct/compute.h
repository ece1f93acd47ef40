// The main job: from a solid to its medial mesh, with a report of what was found to hold.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <matstruct/context.h>
#include <matstruct/error.h>
#include <matstruct/options.h>
#include <matstruct/solid.h>
#include <matstruct/structure.h>
#include <matstruct/types.h>

namespace matstruct {

/// Cost of one stage of a computation.
struct StageCost {
  std::string name;
  double seconds = 0;          ///< wall clock
  double peak_memory_mib = 0;  ///< of the whole process so far
};

/// What a computation did and what holds of its result. Lengths in input units; docs/design/metrics.md has the
/// measures.
struct Report {
  Options options;
  struct Input {
    std::string file;  ///< empty if the solid did not come from a file
    Index tets = 0, surface_triangles = 0;
    double diagonal = 0, volume = 0;
    Betti betti;                   ///< of the solid, by homology of its tetrahedra
    std::string part;              ///< name of the solid in an assembly
    Repair repair;                 ///< what was done to get a solid from the file
    double deviation_percent = 0;  ///< of the tessellation of a CAD model, measured
    double seconds = 0;            ///< reading and tetrahedralising the file
  } input;
  struct Topology {
    Betti betti;  ///< of the medial mesh, by homology of its simplices
    bool equal = false;
  } topology;
  struct Thin {
    Index tetrahedra = 0;
    Index pockets = 0;  ///< closed pockets of the mesh beyond the solid's cavities
    bool holds = false;
  } thin;
  struct Tiling {
    double volume_error = 0;   ///< |sum of the cells' volumes - the solid's volume| / the solid's volume
    bool euler_equal = false;  ///< that of the complex of all cells and that of the solid
    bool holds = false;
  } tiling;
  struct Features {
    Index lines = 0, lines_preserved = 0;  ///< convex sharp lines
    Index corners = 0;                     ///< spheres at ends of convex lines
    bool holds = false;                    ///< all lines preserved, and all their edges in the mesh
  } features;
  struct Preservation {
    Index rounds = 0, inserted = 0;  ///< rounds and spheres inserted, up to the state that was kept
    Index violations_left = 0;  ///< cells, facets and edges that are not contractible, guards that cannot be removed
    bool holds = false;  ///< no violation left; sufficient for the topology, not necessary: no guarantee by itself
  } preservation;
  struct Particles {
    Index rounds = 0;        ///< rounds of particles whose state was kept
    bool converged = false;  ///< the number of spheres at seams and junctions settled before the cap of rounds
  } particles;
  /// The strata, and how their connectivity agrees with the contacts of the spheres, counted anew. A sphere is tangent
  /// where its contacts are equally far but for 1e-6 of the diagonal.
  struct Strata {
    Index sheets = 0, seams = 0, boundaries = 0, curves = 0;
    Index junctions = 0;  ///< of radius > 0, as in structure_counts(): corners where two seams end are left out
    Index seam_spheres = 0, seam_spheres_tangent = 0;          ///< of type kSeam; those with three contacts or more
    Index junction_spheres = 0, junction_spheres_tangent = 0;  ///< of type kJunction; those with four or more
    Index stray_seam_spheres = 0;                              ///< of type kSheet with three contacts or more
    double worst_tangency = 0;  ///< greatest |radius - distance to the surface|, all spheres, in diagonals
  } structure;
  struct Metrics {
    double triangle_quality = 0;  ///< in [0, 1]
    /// In % of the bounding box's diagonal.
    double surface_to_envelope_percent = 0, envelope_to_surface_percent = 0, hausdorff_percent = 0;
    double medialness_mean_percent = 0, medialness_max_percent = 0;
    double mser = 0;  ///< share of seam and junction spheres that are not what they claim, in [0, 1]
    Index spikes = 0;
    double spike_share = 0;  ///< of the sheet spheres
  } metrics;
  std::vector<StageCost> stages;  ///< of compute(), in their order; reading and tetrahedralising come before
  double seconds = 0;             ///< of compute(), wall clock
  double peak_memory_mib = 0;
  std::vector<std::string> warnings;
  bool guarantees_hold = false;  ///< topology, thinness, tiling and features all hold
};

struct Result {
  MedialMesh mesh;          ///< its types agree with `structure`: types_by_structure()
  Structure structure;      ///< of `mesh`
  VertexContacts contacts;  ///< of the vertices of `mesh`
  TriSurface surface;       ///< boundary of the solid
  Report report;
};

/// The mesh of a file's only solid, as read_solids() makes it with default options; its warnings go into the context.
/// Throws Error like it, also for assemblies.
TetMesh read_solid(const std::filesystem::path& file, Context& context);

/// The medial mesh of a solid, in its units. options.threads replaces context.threads; warnings of the context, earlier
/// ones included, go into the report. Throws Error if the solid or an option is refused, Cancelled if the context says
/// so. A guarantee that fails is no exception but said in the report. The same input, options and seed give the same
/// result whatever the number of threads.
Result compute(const TetMesh& solid, const Options& options, Context& context);
/// The same with the solid's known sharp lines; what is said of how it was read goes into the report.
Result compute(const Solid& solid, const Options& options, Context& context);

/// The text of NAME.report.json: names as in Report; Betti numbers as [b0, b1, b2].
std::string report_json(const Result& result);

/// The text of NAME.structure.json; docs/structure-schema.md tells what is in it.
std::string structure_json(const Result& result);

}  // namespace matstruct
