// Random CAD parts for the soak test (bench/soak.py): plates, blocks, cylinders and L-profiles with holes, pockets,
// bosses, ribs, fillets and chamfers. Writes FOLDER/part-NNN.step and FOLDER/parts.json, which has the Betti numbers of
// each part as its boundary representation tells them: an oracle that no mesh was needed for.
//
//   cad_parts FOLDER NUMBER [SEED]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <random>
#include <string>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Tool.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Ax2.hxx>

namespace {

struct Counts {
  int faces = 0, b1 = 0, b2 = 0;
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }
  int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }

 private:
  std::mt19937 engine_;  // whose numbers, unlike those of distributions, are the same everywhere
};

int number(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return map.Extent();
}

// From vertices, edges and faces, of which one with n wires is a disk with n - 1 holes.
Counts counts_of(const TopoDS_Shape& shape) {
  TopTools_IndexedMapOfShape edges, faces;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  int euler = number(shape, TopAbs_VERTEX);
  for (int e = 1; e <= edges.Extent(); ++e)
    if (!BRep_Tool::Degenerated(TopoDS::Edge(edges(e)))) --euler;
  for (int f = 1; f <= faces.Extent(); ++f) euler += 2 - number(faces(f), TopAbs_WIRE);
  const int cavities = number(shape, TopAbs_SHELL) - 1;
  return {faces.Extent(), 1 + cavities - euler / 2, cavities};
}

gp_Ax2 axis(int direction, const gp_Pnt& at) {
  const gp_Dir directions[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return {at, directions[direction]};
}

TopoDS_Shape box(double x, double y, double z, double a, double b, double c) {
  return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), a, b, c).Shape();
}

struct Part {
  TopoDS_Shape shape;
  double size[3];
};

Part base(Random& random) {
  const double a = random.between(30, 100), b = random.between(20, 80), c = random.between(5, 50);
  switch (random.below(4)) {
    case 0:
      return {BRepPrimAPI_MakeCylinder(axis(2, {a / 2, a / 2, 0}), a / 2, c).Shape(), {a, a, c}};
    case 1:  // L-profile
      return {BRepAlgoAPI_Fuse(box(0, 0, 0, a, b, c / 3), box(0, 0, 0, a / 4, b, c)).Shape(), {a, b, c}};
    case 2:  // plate
      return {box(0, 0, 0, a, b, c / 8), {a, b, c / 8}};
    default:
      return {box(0, 0, 0, a, b, c), {a, b, c}};
  }
}

TopoDS_Shape with_fillet(const TopoDS_Shape& shape, double radius, bool chamfer, Random& random) {
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  const TopoDS_Edge edge = TopoDS::Edge(edges(1 + random.below(edges.Extent())));
  if (BRep_Tool::Degenerated(edge)) return shape;
  if (chamfer) {
    BRepFilletAPI_MakeChamfer make(shape);
    make.Add(radius, edge);
    return make.Shape();
  }
  BRepFilletAPI_MakeFillet make(shape);
  make.Add(radius, edge);
  return make.Shape();
}

TopoDS_Shape step(const Part& part, Random& random) {
  const double* s = part.size;
  const double least = std::min({s[0], s[1], s[2]});
  const gp_Pnt at(random.between(0.1, 0.9) * s[0], random.between(0.1, 0.9) * s[1], random.between(0.1, 0.9) * s[2]);
  const double radius = random.between(0.04, 0.2) * std::min(s[0], s[1]);
  const int direction = random.below(3);
  gp_Pnt below = at;
  below.SetCoord(direction + 1, -s[direction]);
  switch (random.below(8)) {
    case 0:
    case 1:  // hole through all
      return BRepAlgoAPI_Cut(part.shape,
                             BRepPrimAPI_MakeCylinder(axis(direction, below), radius, 3 * s[direction]).Shape());
    case 2:  // blind hole
      return BRepAlgoAPI_Cut(part.shape, BRepPrimAPI_MakeCylinder(axis(2, at), radius, 2 * s[2]).Shape());
    case 3:  // pocket
      return BRepAlgoAPI_Cut(part.shape, box(at.X(), at.Y(), at.Z(), random.between(0.1, 0.5) * s[0],
                                             random.between(0.1, 0.5) * s[1], 2 * s[2]));
    case 4:  // boss
      return BRepAlgoAPI_Fuse(part.shape, BRepPrimAPI_MakeCylinder(axis(2, {at.X(), at.Y(), s[2] / 2}), radius,
                                                                   random.between(0.6, 1.2) * s[2])
                                              .Shape());
    case 5:  // rib
      return BRepAlgoAPI_Fuse(
          part.shape, box(0, at.Y(), 0, s[0], random.between(0.05, 0.1) * s[1], random.between(1.1, 1.5) * s[2]));
    case 6:  // cavity
      return BRepAlgoAPI_Cut(part.shape, BRepPrimAPI_MakeSphere(at, random.between(0.1, 0.3) * least).Shape());
    default:
      return with_fillet(part.shape, random.between(0.03, 0.15) * least, random.below(3) == 0, random);
  }
}

bool good(const TopoDS_Shape& shape) {
  return !shape.IsNull() && number(shape, TopAbs_SOLID) == 1 && BRepCheck_Analyzer(shape).IsValid();
}

TopoDS_Shape solid_of(const TopoDS_Shape& shape) {
  return TopExp_Explorer(shape, TopAbs_SOLID).Current();
}

TopoDS_Shape make_part(Random& random) {
  Part part = base(random);
  const int steps = 2 + random.below(7);
  for (int k = 0; k < steps; ++k) {
    try {
      TopoDS_Shape next = step(part, random);
      if (!good(next)) continue;
      ShapeUpgrade_UnifySameDomain unify(next);
      unify.Build();
      if (good(unify.Shape())) part.shape = solid_of(unify.Shape());
    } catch (const Standard_Failure&) {
      continue;  // that fillet does not fit
    }
  }
  return solid_of(part.shape);
}

// Writes the part and reads it again, for what is tested is the file. Null if OpenCASCADE's own check finds what was
// read not valid, as happens with faces of several wires on a sphere: such a file bounds nothing.
TopoDS_Shape written(const TopoDS_Shape& part, const std::string& file) {
  STEPControl_Writer writer;
  writer.Transfer(part, STEPControl_AsIs);
  writer.Write(file.c_str());
  STEPControl_Reader reader;
  reader.ReadFile(file.c_str());
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  return good(shape) ? solid_of(shape) : TopoDS_Shape();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("usage: cad_parts FOLDER NUMBER [SEED]\n", stderr);
    return 2;
  }
  const std::string folder = argv[1];
  const unsigned seed = argc > 3 ? static_cast<unsigned>(std::atoi(argv[3])) : 1;
  std::ofstream list(folder + "/parts.json");
  list << "[";
  for (int i = 1; i <= std::atoi(argv[2]); ++i) {
    Random random(1000003u * seed + static_cast<unsigned>(i));
    char name[32];
    std::snprintf(name, sizeof name, "part-%03d.step", i);
    TopoDS_Shape part;
    while (part.IsNull()) part = written(make_part(random), folder + "/" + name);
    const Counts counts = counts_of(part);
    list << (i > 1 ? ",\n" : "\n") << "{\"file\": \"" << name << "\", \"faces\": " << counts.faces
         << ", \"betti\": [1, " << counts.b1 << ", " << counts.b2 << "]}";
  }
  list << "\n]\n";
  return list ? 0 : 1;
}
