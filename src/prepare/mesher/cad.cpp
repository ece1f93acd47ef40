// CAD solids as conforming triangulations. OpenCASCADE triangulates face by face, with the same nodes on both sides of
// an edge; faces are put together by the topology of the CAD model, not by coordinates, so that no tolerance is needed.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepLProp_SLProps.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>

#include "prepare/mesher/cad_file.h"
#include "prepare/mesher/tasks.h"

namespace matstruct::mesher {

namespace {

constexpr double kAngularDeflection = 20;  // degrees: holes much smaller than the part stay round
constexpr int kMostRefinements = 3;
constexpr double kGreatestStep = 0.3;  // of the deflection from one refinement to the next
constexpr double kProgress = 0.8;      // of the deviation that a refinement has to make to be worth another

using Segment = std::array<int, 2>;  // lower id first

double distance(const gp_Pnt& p, const gp_Pnt& a, const gp_Pnt& b) {
  const gp_Vec along(a, b);
  const double length2 = along.SquareMagnitude();
  const double at = length2 > 0 ? std::clamp(gp_Vec(a, p).Dot(along) / length2, 0.0, 1.0) : 0;
  return p.Distance(a.Translated(along * at));
}

double distance(const gp_Pnt& p, const std::array<gp_Pnt, 3>& t) {
  const gp_Vec normal = gp_Vec(t[0], t[1]).Crossed(gp_Vec(t[0], t[2]));
  bool above = normal.SquareMagnitude() > 0;
  double result = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const gp_Pnt &a = t[k], &b = t[(k + 1) % 3];
    result = std::min(result, distance(p, a, b));
    above = above && normal.Dot(gp_Vec(a, b).Crossed(gp_Vec(a, p))) >= 0;
  }
  return above ? std::min(result, std::abs(gp_Vec(t[0], p).Dot(normal)) / normal.Magnitude()) : result;
}

class SolidMesh {
 public:
  explicit SolidMesh(const TopoDS_Shape& solid) {
    for (TopExp_Explorer e(solid, TopAbs_FACE); e.More(); e.Next()) add_face(TopoDS::Face(e.Current()));
    unify();
    if (volume() < 0) turn();
  }

  double diagonal() const {
    Bnd_Box box;
    for (const gp_Pnt& p : points_) box.Add(p);
    return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
  }

  // Greatest distance measured between the triangles or segments and their surfaces and curves.
  double deviation() const { return deviation_; }

  bool empty() const { return triangles_.empty(); }

  void write(Answer& answer) const {
    for (const gp_Pnt& p : points_) answer.points.insert(answer.points.end(), {p.X(), p.Y(), p.Z()});
    for (const auto& t : triangles_) answer.corners.insert(answer.corners.end(), t.corners.begin(), t.corners.end());
    std::map<Segment, Sides> sides;
    for (const MeshTriangle& t : triangles_)
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = t.corners[k], b = t.corners[(k + 1) % 3];
        sides[{std::min(a, b), std::max(a, b)}][a < b ? 0 : 1] = &t;
      }
    std::int32_t segments = 0;
    for (const auto& [segment, uses] : uses_) {
      const auto side = sides.find(segment);
      if (side == sides.end()) continue;
      answer.segments.insert(answer.segments.end(), segment.begin(), segment.end());
      answer.dihedrals.push_back(dihedral(segment, uses, side->second));
      ++segments;
    }
    answer.solid_points.push_back(static_cast<std::int32_t>(points_.size()));
    answer.solid_triangles.push_back(static_cast<std::int32_t>(triangles_.size()));
    answer.solid_segments.push_back(segments);
    answer.deviations.push_back(deviation_ / std::max(diagonal(), std::numeric_limits<double>::min()));
  }

 private:
  struct MeshTriangle {
    std::array<int, 3> corners;
    int face;
  };
  using Sides = std::array<const MeshTriangle*, 2>;  // triangles that run up and down an edge, null if there is none
  struct Use {
    int face;
    gp_Vec normal;  // outward normal of the face there; zero if it has none
  };

  int add_point(const gp_Pnt& p) {
    points_.push_back(p);
    parent_.push_back(static_cast<int>(parent_.size()));
    return parent_.back();
  }

  int find(int id) {
    while (parent_[static_cast<std::size_t>(id)] != id) id = parent_[static_cast<std::size_t>(id)];
    return id;
  }

  // The points of an edge in order of its parameter; made when its first face is added. Edges share their ends.
  std::vector<int>& edge_points(const TopoDS_Edge& edge, const std::vector<gp_Pnt>& places) {
    std::vector<int>& ids = edges_[edge_index_.Add(edge)];
    if (!ids.empty() && ids.size() != places.size())
      throw std::runtime_error("OpenCASCADE made triangulations of two faces that do not fit together");
    if (!ids.empty()) return ids;
    const auto end_point = [&](const TopoDS_Vertex& vertex, const gp_Pnt& place) {
      if (vertex.IsNull()) return add_point(place);
      const auto [entry, is_new] = vertices_.try_emplace(vertex_index_.Add(vertex), 0);
      if (is_new) entry->second = add_point(place);
      return entry->second;
    };
    TopoDS_Vertex first, last;
    TopExp::Vertices(edge, first, last);
    ids.push_back(end_point(first, places.front()));
    for (std::size_t k = 1; k + 1 < places.size(); ++k)
      ids.push_back(BRep_Tool::Degenerated(edge) ? ids.front() : add_point(places[k]));
    const bool closed_without_vertex = last.IsNull() && BRep_Tool::IsClosed(edge);
    ids.push_back(closed_without_vertex ? ids.front() : end_point(last, places.back()));
    return ids;
  }

  void add_face(const TopoDS_Face& face) {
    TopLoc_Location place;
    const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, place);
    if (mesh.IsNull()) throw std::runtime_error("OpenCASCADE could not triangulate a face");
    const gp_Trsf move = place.Transformation();
    const int face_id = faces_++;
    std::vector<int> id(static_cast<std::size_t>(mesh->NbNodes()) + 1, -1);
    for (TopExp_Explorer e(face, TopAbs_EDGE); e.More(); e.Next())
      add_edge(face, face_id, TopoDS::Edge(e.Current()), mesh, place, id);
    for (int n = 1; n <= mesh->NbNodes(); ++n)
      if (int& i = id[static_cast<std::size_t>(n)]; i < 0) i = add_point(mesh->Node(n).Transformed(move));
    const bool turned = (face.Orientation() == TopAbs_REVERSED) != move.IsNegative();
    for (int t = 1; t <= mesh->NbTriangles(); ++t) {
      std::array<int, 3> n{};
      mesh->Triangle(t).Get(n[0], n[1], n[2]);
      if (turned) std::swap(n[1], n[2]);
      measure(face, *mesh, n, move);
      triangles_.push_back(
          {{id[static_cast<std::size_t>(n[0])], id[static_cast<std::size_t>(n[1])], id[static_cast<std::size_t>(n[2])]},
           face_id});
    }
  }

  void add_edge(const TopoDS_Face& face, int face_id, const TopoDS_Edge& edge, const Handle(Poly_Triangulation) & mesh,
                const TopLoc_Location& place, std::vector<int>& id) {
    const Handle(Poly_PolygonOnTriangulation) polygon = BRep_Tool::PolygonOnTriangulation(edge, mesh, place);
    if (polygon.IsNull()) throw std::runtime_error("OpenCASCADE left an edge out of a triangulation");
    std::vector<gp_Pnt> places;
    for (int k = 1; k <= polygon->NbNodes(); ++k)
      places.push_back(mesh->Node(polygon->Node(k)).Transformed(place.Transformation()));
    const std::vector<int>& ids = edge_points(edge, places);
    for (std::size_t k = 0; k < ids.size(); ++k) {
      int& known = id[static_cast<std::size_t>(polygon->Node(static_cast<int>(k) + 1))];
      if (known >= 0)
        parent_[static_cast<std::size_t>(std::max(find(known), find(ids[k])))] = std::min(find(known), find(ids[k]));
      known = ids[k];
    }
    if (BRep_Tool::Degenerated(edge) || !polygon->HasParameters()) return;
    BRepAdaptor_Curve curve(edge);
    double from = 0, to = 0;
    const Handle(Geom2d_Curve) on_surface = BRep_Tool::CurveOnSurface(edge, face, from, to);
    for (std::size_t k = 0; k + 1 < ids.size(); ++k) {
      const double middle =
          (polygon->Parameter(static_cast<int>(k) + 1) + polygon->Parameter(static_cast<int>(k) + 2)) / 2;
      const gp_Pnt on_curve = curve.Value(middle);
      deviation_ = std::max(deviation_, distance(on_curve, places[k], places[k + 1]));
      const Segment segment{std::min(ids[k], ids[k + 1]), std::max(ids[k], ids[k + 1])};
      uses_[segment].push_back({face_id, on_surface.IsNull() ? gp_Vec() : normal(face, on_surface->Value(middle))});
    }
  }

  static gp_Vec normal(const TopoDS_Face& face, const gp_Pnt2d& at) {
    BRepLProp_SLProps properties(BRepAdaptor_Surface(face, false), at.X(), at.Y(), 1, 1e-12);
    if (!properties.IsNormalDefined()) return {};
    gp_Vec result(properties.Normal());
    TopLoc_Location place = face.Location();
    if ((face.Orientation() == TopAbs_REVERSED) != place.Transformation().IsNegative()) result.Reverse();
    return result;
  }

  void measure(const TopoDS_Face& face, const Poly_Triangulation& mesh, const std::array<int, 3>& n,
               const gp_Trsf& move) {
    if (!mesh.HasUVNodes()) return;
    const gp_Pnt a = mesh.Node(n[0]).Transformed(move), b = mesh.Node(n[1]).Transformed(move),
                 c = mesh.Node(n[2]).Transformed(move);
    const gp_XY middle = (mesh.UVNode(n[0]).XY() + mesh.UVNode(n[1]).XY() + mesh.UVNode(n[2]).XY()) / 3;
    if (measured_.IsNull() || !measured_.IsSame(face)) {
      measured_ = face;
      surface_.Initialize(face, false);
    }
    if (distance(surface_.Value(middle.X(), middle.Y()), {a, b, c}) <= deviation_) return;
    // Parameters may belong to different periods of the surface: what would be a new maximum is measured properly.
    const gp_Pnt centre((a.XYZ() + b.XYZ() + c.XYZ()) / 3);
    GeomAPI_ProjectPointOnSurf projection(centre, BRep_Tool::Surface(face));
    if (projection.NbPoints() > 0) deviation_ = std::max(deviation_, projection.LowerDistance());
  }

  // Points that turned out to be one get one id; triangles without area, as at the poles of a sphere, go.
  void unify() {
    std::vector<int> place(points_.size(), -1);
    std::vector<gp_Pnt> kept;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (find(static_cast<int>(i)) == static_cast<int>(i)) {
        place[i] = static_cast<int>(kept.size());
        kept.push_back(points_[i]);
      }
    const auto renamed = [&](int id) { return place[static_cast<std::size_t>(find(id))]; };
    for (MeshTriangle& t : triangles_)
      for (int& corner : t.corners) corner = renamed(corner);
    std::erase_if(triangles_, [](const MeshTriangle& t) {
      return t.corners[0] == t.corners[1] || t.corners[1] == t.corners[2] || t.corners[2] == t.corners[0];
    });
    std::map<Segment, std::vector<Use>> uses;
    for (const auto& [segment, list] : uses_) {
      const int a = renamed(segment[0]), b = renamed(segment[1]);
      auto& joined = uses[{std::min(a, b), std::max(a, b)}];
      joined.insert(joined.end(), list.begin(), list.end());
    }
    uses_ = std::move(uses);
    points_ = std::move(kept);
  }

  double volume() const {
    double six_volumes = 0;
    for (const MeshTriangle& t : triangles_) {
      const auto p = [&](std::size_t k) {
        return points_[static_cast<std::size_t>(t.corners[k])].XYZ() - points_[0].XYZ();
      };
      six_volumes += p(0).Dot(p(1).Crossed(p(2)));
    }
    return six_volumes / 6;
  }

  // For solids that are inside out in the file.
  void turn() {
    for (MeshTriangle& t : triangles_) std::swap(t.corners[1], t.corners[2]);
    for (auto& [segment, uses] : uses_)
      for (Use& use : uses) use.normal.Reverse();
  }

  gp_Vec normal(const MeshTriangle& t) const {
    const auto p = [&](std::size_t k) { return points_[static_cast<std::size_t>(t.corners[k])]; };
    return gp_Vec(p(0), p(1)).Crossed(gp_Vec(p(0), p(2)));
  }

  // The interior angle between the CAD faces at a piece of an edge, from their normals, or from the triangles' where
  // there are none. The triangle that runs up lies on the left of the edge seen from outside.
  double dihedral(const Segment& segment, const std::vector<Use>& uses, const Sides& sides) const {
    if (!sides[0] || !sides[1]) return std::numbers::pi;
    gp_Vec left = normal(*sides[0]), right = normal(*sides[1]);
    if (uses.size() == 2 && uses[0].normal.Magnitude() > 0 && uses[1].normal.Magnitude() > 0) {
      const bool in_order = uses[0].face == sides[0]->face;
      left = uses[in_order ? 0 : 1].normal;
      right = uses[in_order ? 1 : 0].normal;
    }
    if (left.Magnitude() <= gp::Resolution() || right.Magnitude() <= gp::Resolution()) return std::numbers::pi;
    const gp_Vec along(points_[static_cast<std::size_t>(segment[0])], points_[static_cast<std::size_t>(segment[1])]);
    const double turn = left.Angle(right);
    return left.Crossed(right).Dot(along) > 0 ? std::numbers::pi - turn : std::numbers::pi + turn;
  }

  std::vector<gp_Pnt> points_;
  std::vector<int> parent_;
  std::vector<MeshTriangle> triangles_;
  std::map<Segment, std::vector<Use>> uses_;  // of the pieces of CAD edges
  int faces_ = 0;
  double deviation_ = 0;
  TopTools_IndexedMapOfShape edge_index_, vertex_index_;
  std::map<int, std::vector<int>> edges_;
  std::map<int, int> vertices_;
  TopoDS_Face measured_;  // the face that surface_ is for
  BRepAdaptor_Surface surface_;
};

SolidMesh triangulate(const TopoDS_Shape& solid, double deflection) {
  Bnd_Box box;
  BRepBndLib::Add(solid, box);
  if (box.IsVoid()) throw std::runtime_error("a solid is empty");
  double wanted = deflection * std::sqrt(box.SquareExtent());
  std::optional<SolidMesh> best;
  for (int round = 0; round <= kMostRefinements; ++round) {
    BRepTools::Clean(solid);
    BRepMesh_IncrementalMesh(solid, wanted, false, kAngularDeflection * std::numbers::pi / 180, false);
    SolidMesh mesh(solid);
    const bool better = !best || mesh.deviation() < kProgress * best->deviation();
    if (better) best = std::move(mesh);
    const double allowed = deflection * best->diagonal();
    if (!better || best->deviation() <= allowed) break;
    wanted = std::min(wanted, allowed) * std::max(kGreatestStep, allowed / best->deviation());
  }
  return std::move(*best);
}

}  // namespace

Answer read_cad(const Request& request) try {
  Answer answer;
  const CadFile cad = read_cad_file(request.file);
  answer.note = cad.note;
  for (const CadSolid& solid : cad.solids) {
    triangulate(solid.shape, request.size).write(answer);
    if (!BRepCheck_Analyzer(solid.shape).IsValid())
      answer.note.append(answer.note.empty() ? "" : " ")
          .append("the solid '")
          .append(solid.name)
          .append("' of the file is not valid by OpenCASCADE's own check; export it again if the result is wrong.");
    answer.names.push_back(solid.name);
  }
  return answer;
} catch (const Standard_Failure& failure) {
  const char* message = failure.GetMessageString();
  throw std::runtime_error(std::string("OpenCASCADE failed") +
                           (message && *message ? std::string(": ") + message : ""));
}

}  // namespace matstruct::mesher
