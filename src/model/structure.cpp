#include <matstruct/structure.h>

#include <algorithm>
#include <limits>

#include "base/index.h"

namespace matstruct {

namespace {

void make_set(std::vector<Index>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

bool on_sharp_line(const MedialMesh& mesh, Index v) {
  return mesh.types[uz(v)] == SphereType::kSharpEdge || mesh.types[uz(v)] == SphereType::kCorner;
}

SheetStratum measured_sheet(const MedialMesh& mesh, std::vector<Index> faces) {
  SheetStratum sheet;
  sheet.min_radius = std::numeric_limits<double>::infinity();
  double moment = 0, sum = 0;
  for (const Index f : faces) {
    const auto& [a, b, c] = mesh.faces[uz(f)];
    const Vec3& origin = mesh.centers[uz(a)];
    const double area = 0.5 * norm(cross(mesh.centers[uz(b)] - origin, mesh.centers[uz(c)] - origin));
    const double radius = (mesh.radii[uz(a)] + mesh.radii[uz(b)] + mesh.radii[uz(c)]) / 3;
    sheet.area += area;
    moment += area * radius;
    sum += radius;
    for (const Index v : mesh.faces[uz(f)]) {
      sheet.min_radius = std::min(sheet.min_radius, mesh.radii[uz(v)]);
      sheet.max_radius = std::max(sheet.max_radius, mesh.radii[uz(v)]);
    }
  }
  sheet.mean_radius = sheet.area > 0 ? moment / sheet.area : sum / static_cast<double>(faces.size());
  sheet.faces = std::move(faces);
  return sheet;
}

std::vector<CurveStratum> measured_curves(const MedialMesh& mesh, const std::vector<Curve>& curves, bool boundaries) {
  std::vector<CurveStratum> result;
  for (const Curve& curve : curves) {
    CurveStratum c{
        .vertices = curve.vertices, .sheets = curve.sheets, .length = length_of(mesh, curve), .closed = curve.closed()};
    c.sharp = boundaries &&
              std::all_of(c.vertices.begin(), c.vertices.end(), [&](Index v) { return on_sharp_line(mesh, v); });
    result.push_back(std::move(c));
  }
  return result;
}

/// Fills in which strata touch each other.
class Connector {
 public:
  Connector(const MedialMesh& mesh, Structure& structure)
      : mesh_(mesh), s_(structure), point_(mesh.centers.size(), {kInvalid, kInvalid}) {
    for (Index k = 0; k < count(s_.junctions); ++k) point_[uz(s_.junctions[uz(k)].vertex)][0] = k;
    for (Index k = 0; k < count(s_.corners); ++k) point_[uz(s_.corners[uz(k)].vertex)][1] = k;
  }

  void run() {
    connect_curves(s_.seams, s_.first_seam(), &PointStratum::seams);
    connect_curves(s_.boundaries, s_.first_boundary(), &PointStratum::boundaries);
    connect_curves(s_.curves, s_.first_curve(), &PointStratum::curves);
    connect_borders();
    connect_ends_in_sheets();
    for (auto* points : {&s_.junctions, &s_.corners})
      for (PointStratum& p : *points)
        for (auto* list : {&p.seams, &p.boundaries, &p.curves}) make_set(*list);
    for (SheetStratum& sheet : s_.sheets)
      for (auto* list : {&sheet.seams, &sheet.boundaries, &sheet.junctions}) make_set(*list);
    std::sort(s_.adjacency.begin(), s_.adjacency.end());
    s_.adjacency.erase(std::unique(s_.adjacency.begin(), s_.adjacency.end()), s_.adjacency.end());
  }

 private:
  Index junction_at(Index v) const { return point_[uz(v)][0]; }
  Index corner_at(Index v) const { return point_[uz(v)][1]; }

  Index end_at(Index v) const {
    if (corner_at(v) != kInvalid) return s_.first_corner() + corner_at(v);
    return junction_at(v) == kInvalid ? kInvalid : s_.first_junction() + junction_at(v);
  }

  void connect_curves(std::vector<CurveStratum>& curves, Index first, std::vector<Index> PointStratum::*list) {
    for (Index k = 0; k < count(curves); ++k) {
      CurveStratum& curve = curves[uz(k)];
      curve.ends = {end_at(curve.vertices.front()), end_at(curve.vertices.back())};
      for (const Index v : curve.vertices) {
        if (const Index j = junction_at(v); j != kInvalid) {
          (s_.junctions[uz(j)].*list).push_back(k);
          s_.adjacency.push_back({s_.first_junction() + j, first + k});
        }
        if (const Index c = corner_at(v); c != kInvalid) {
          (s_.corners[uz(c)].*list).push_back(k);
          s_.adjacency.push_back({s_.first_corner() + c, first + k});
        }
      }
    }
  }

  // Seams and boundaries, and junctions on them, belong to the sheets around them.
  void connect_borders() {
    const auto connect = [&](const std::vector<CurveStratum>& curves, Index first,
                             std::vector<Index> SheetStratum::*list) {
      for (Index k = 0; k < count(curves); ++k)
        for (const Index sheet : curves[uz(k)].sheets) {
          (s_.sheets[uz(sheet)].*list).push_back(k);
          s_.adjacency.push_back({first + k, sheet});
        }
    };
    connect(s_.seams, s_.first_seam(), &SheetStratum::seams);
    connect(s_.boundaries, s_.first_boundary(), &SheetStratum::boundaries);
    for (Index f = 0; f < count(mesh_.faces); ++f)
      for (const Index v : mesh_.faces[uz(f)])
        if (const Index j = junction_at(v); j != kInvalid)
          s_.sheets[uz(s_.sheet_of_face[uz(f)])].junctions.push_back(j);
  }

  void connect_ends_in_sheets() {
    std::vector<std::vector<Index>> ending(mesh_.centers.size());  // medial curves by their ends
    for (Index k = 0; k < count(s_.curves); ++k)
      for (const Index v : {s_.curves[uz(k)].vertices.front(), s_.curves[uz(k)].vertices.back()})
        ending[uz(v)].push_back(k);
    for (Index f = 0; f < count(mesh_.faces); ++f)
      for (const Index v : mesh_.faces[uz(f)])
        for (const Index k : ending[uz(v)]) s_.adjacency.push_back({s_.first_curve() + k, s_.sheet_of_face[uz(f)]});
  }

  const MedialMesh& mesh_;
  Structure& s_;
  std::vector<std::array<Index, 2>> point_;  // per vertex: its junction, its corner
};

}  // namespace

Structure structure_of(const MedialMesh& mesh) {
  const Strata strata = trace_strata(mesh);
  Structure structure;
  structure.sheet_of_face = strata.sheet_of_face;
  std::vector<std::vector<Index>> faces(uz(strata.sheets));
  for (Index f = 0; f < count(mesh.faces); ++f) faces[uz(strata.sheet_of_face[uz(f)])].push_back(f);
  for (auto& list : faces) structure.sheets.push_back(measured_sheet(mesh, std::move(list)));
  structure.seams = measured_curves(mesh, strata.seams, false);
  structure.boundaries = measured_curves(mesh, strata.boundaries, true);
  structure.curves = measured_curves(mesh, strata.curves, false);
  for (const Index v : strata.junctions) structure.junctions.push_back({v, {}, {}, {}});
  for (Index v = 0; v < count(mesh.types); ++v)
    if (mesh.types[uz(v)] == SphereType::kCorner) structure.corners.push_back({v, {}, {}, {}});
  Connector(mesh, structure).run();
  return structure;
}

std::vector<SphereType> types_by_structure(const MedialMesh& mesh, const Structure& structure) {
  std::vector<SphereType> types = mesh.types;
  const auto put = [&](Index v, SphereType type) {
    if (!on_sharp_line(mesh, v)) types[uz(v)] = type;
  };
  for (Index v = 0; v < count(types); ++v) put(v, SphereType::kSheet);
  for (const CurveStratum& seam : structure.seams)
    for (const Index v : seam.vertices) put(v, SphereType::kSeam);
  for (const PointStratum& junction : structure.junctions) put(junction.vertex, SphereType::kJunction);
  return types;
}

}  // namespace matstruct
