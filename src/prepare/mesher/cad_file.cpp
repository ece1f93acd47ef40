#include "prepare/mesher/cad_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

namespace matstruct::mesher {

namespace {

constexpr double kSewing = 1e-6;  // gap of edges that are sewn, in the file's units

void add_solids(const TopoDS_Shape& shape, const std::string& name, std::vector<CadSolid>& solids) {
  for (TopExp_Explorer e(shape, TopAbs_SOLID); e.More(); e.Next()) solids.push_back({name, e.Current()});
}

std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
  const TCollection_AsciiString text(name->Get(), '?');
  return text.ToCString();
}

// Walks down an assembly; the name of an instance goes before that of its part.
void walk(const TDF_Label& label, const TopLoc_Location& place, const std::string& instance,
          std::vector<CadSolid>& solids) {
  const std::string name = instance.empty() ? name_of(label) : instance;
  if (!XCAFDoc_ShapeTool::IsAssembly(label)) {
    add_solids(XCAFDoc_ShapeTool::GetShape(label).Moved(place), name, solids);
    return;
  }
  TDF_LabelSequence components;
  XCAFDoc_ShapeTool::GetComponents(label, components);
  for (const TDF_Label& component : components) {
    TDF_Label part;
    if (!XCAFDoc_ShapeTool::GetReferredShape(component, part)) continue;
    std::string part_name = name_of(part);
    walk(part, place * XCAFDoc_ShapeTool::GetLocation(component), part_name.empty() ? name_of(component) : part_name,
         solids);
  }
}

// OpenCASCADE converts lengths to millimetres unless told otherwise; results belong in the file's own unit.
void keep_unit(STEPControl_Reader& reader, std::string& note) {
  constexpr std::array<std::pair<const char*, const char*>, 9> kUnits{{{"millimetre", "MM"},
                                                                       {"metre", "M"},
                                                                       {"centimetre", "CM"},
                                                                       {"micrometre", "UM"},
                                                                       {"kilometre", "KM"},
                                                                       {"inch", "INCH"},
                                                                       {"foot", "FT"},
                                                                       {"mile", "MI"},
                                                                       {"mil", "MIL"}}};
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  if (lengths.IsEmpty()) return;
  std::string unit = lengths.First().ToCString();
  std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto* known =
      std::find_if(kUnits.begin(), kUnits.end(), [&](const auto& entry) { return unit == entry.first; });
  if (known != kUnits.end()) Interface_Static::SetCVal("xstep.cascade.unit", known->second);
  if (known == kUnits.end())
    note = "the file's unit of length, '" + unit + "', is not known: lengths are in millimetres.";
}

std::vector<CadSolid> read_step(const std::string& file, TopoDS_Compound& all, std::string& note) {
  STEPCAFControl_Reader reader;
  reader.SetColorMode(false);
  reader.SetLayerMode(false);
  reader.SetPropsMode(false);
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) throw std::runtime_error("it is no valid STEP file");
  keep_unit(reader.ChangeReader(), note);
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  if (!reader.Transfer(document)) throw std::runtime_error("it has no shapes, or they are damaged");
  TDF_LabelSequence labels;
  XCAFDoc_DocumentTool::ShapeTool(document->Main())->GetFreeShapes(labels);
  std::vector<CadSolid> solids;
  BRep_Builder builder;
  for (const TDF_Label& label : labels) {
    walk(label, TopLoc_Location(), "", solids);
    builder.Add(all, XCAFDoc_ShapeTool::GetShape(label));
  }
  return solids;
}

std::vector<CadSolid> read_brep(const std::string& file, TopoDS_Compound& all) {
  TopoDS_Shape shape;
  BRep_Builder builder;
  if (!BRepTools::Read(shape, file.c_str(), builder) || shape.IsNull())
    throw std::runtime_error("it is no valid BREP file");
  builder.Add(all, shape);
  std::vector<CadSolid> solids;
  add_solids(shape, "", solids);
  return solids;
}

std::vector<CadSolid> sew(const TopoDS_Compound& faces, std::string& note) {
  if (!TopExp_Explorer(faces, TopAbs_FACE).More()) throw std::runtime_error("it has no faces");
  BRepBuilderAPI_Sewing sewing(kSewing);
  sewing.Add(faces);
  sewing.Perform();
  std::vector<CadSolid> solids;
  for (TopExp_Explorer e(sewing.SewedShape(), TopAbs_SHELL); e.More(); e.Next())
    if (BRep_Tool::IsClosed(e.Current()))
      solids.push_back({"", BRepBuilderAPI_MakeSolid(TopoDS::Shell(e.Current())).Solid()});
  if (solids.empty()) solids.push_back({"", sewing.SewedShape()});
  note += "the file has faces but no solids: they were sewn together.";
  return solids;
}

}  // namespace

CadFile read_cad_file(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  CadFile cad;
  TopoDS_Compound all;
  BRep_Builder().MakeCompound(all);
  const bool brep = extension == ".brep" || extension == ".brp";
  cad.solids = brep ? read_brep(file, all) : read_step(file, all, cad.note);
  if (cad.solids.empty()) cad.solids = sew(all, cad.note);
  return cad;
}

}  // namespace matstruct::mesher
