// Writes data/assembly.step: in inches, a plate with a hole, twice, and a round pin, with their names.
//
//   cad_assembly FILE
#include <cstdio>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Ax2.hxx>

namespace {

TopLoc_Location moved(double x, double y, double z) {
  gp_Trsf move;
  move.SetTranslation(gp_Vec(x, y, z));
  return move;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: cad_assembly FILE\n", stderr);
    return 2;
  }
  Interface_Static::SetCVal("xstep.cascade.unit", "INCH");
  Interface_Static::SetCVal("write.step.unit", "INCH");
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const gp_Ax2 hole_axis(gp_Pnt(2, 1.5, -1), gp_Dir(0, 0, 1));
  const TDF_Label plate = shapes->AddShape(
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(4, 3, 0.5).Shape(), BRepPrimAPI_MakeCylinder(hole_axis, 0.5, 3).Shape()),
      false);
  const TDF_Label pin =
      shapes->AddShape(BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 0.45, 2).Shape(), false);
  TDataStd_Name::Set(plate, "plate");
  TDataStd_Name::Set(pin, "round pin");
  const TDF_Label assembly = shapes->NewShape();
  TDataStd_Name::Set(assembly, "assembly");
  shapes->AddComponent(assembly, plate, moved(0, 0, 0));
  shapes->AddComponent(assembly, plate, moved(0, 0, 1));
  shapes->AddComponent(assembly, pin, moved(2, 1.5, -0.25));
  shapes->UpdateAssemblies();
  STEPCAFControl_Writer writer;
  writer.SetColorMode(false);
  writer.Transfer(document, STEPControl_AsIs);
  return writer.Write(argv[1]) == IFSelect_RetDone ? 0 : 1;
}
