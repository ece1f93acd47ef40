// VTK XML PolyData: the arrays follow the XML as raw bytes, each behind its length.
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <matstruct/io.h>

#include "base/index.h"
#include "io/bytes.h"
#include "io/stratum_ids.h"

namespace matstruct {

namespace {

class Arrays {
 public:
  /// The element for an array, of which the values are kept for the end of the file.
  template <class T>
  std::string add(const char* type, const char* name, int components, const std::vector<T>& values) {
    const std::size_t offset = bytes_.size();
    append(bytes_, std::uint64_t{values.size() * sizeof(T)});
    for (const T& value : values) append(bytes_, value);
    return fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)"
                       "\n",
                       type, name, components, offset);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Cells as VTK wants them: corners of all, one after the other, and where each ends.
struct Cells {
  std::vector<std::int64_t> corners, ends;
  void add(const auto& ids) {
    corners.insert(corners.end(), ids.begin(), ids.end());
    ends.push_back(static_cast<std::int64_t>(corners.size()));
  }
  std::string element(const char* name, Arrays& arrays) const {
    return fmt::format("<{0}>\n{1}{2}</{0}>\n", name, arrays.add("Int64", "connectivity", 1, corners),
                       arrays.add("Int64", "offsets", 1, ends));
  }
};

}  // namespace

void write_vtp(const MedialMesh& mesh, const Strata& strata, const std::filesystem::path& file) {
  Cells lines, triangles;
  std::vector<Index> stratum, sheet;
  const StratumIds ids(strata);
  const auto add_lines = [&](const std::vector<Curve>& curves, Index first) {
    for (Index k = 0; k < count(curves); ++k) {
      lines.add(curves[uz(k)].vertices);
      stratum.push_back(first + k);
      sheet.push_back(kInvalid);
    }
  };
  add_lines(strata.seams, ids.seams);
  add_lines(strata.boundaries, ids.boundaries);
  add_lines(strata.curves, ids.curves);
  for (const Triangle& face : mesh.faces) triangles.add(face);
  stratum.insert(stratum.end(), strata.sheet_of_face.begin(), strata.sheet_of_face.end());
  sheet.insert(sheet.end(), strata.sheet_of_face.begin(), strata.sheet_of_face.end());

  std::vector<std::uint8_t> types;
  for (const SphereType type : mesh.types) types.push_back(static_cast<std::uint8_t>(type));
  std::vector<double> places;
  for (const Vec3& p : mesh.centers) places.insert(places.end(), {p.x, p.y, p.z});

  Arrays arrays;
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n",
      mesh.centers.size(), lines.ends.size(), triangles.ends.size());
  text += "<PointData Scalars=\"radius\">\n" + arrays.add("Float64", "radius", 1, mesh.radii) +
          arrays.add("UInt8", "type", 1, types) + arrays.add("Int32", "stratum", 1, stratum_of_vertices(mesh, strata)) +
          "</PointData>\n";
  text += "<CellData Scalars=\"sheet\">\n" + arrays.add("Int32", "stratum", 1, stratum) +
          arrays.add("Int32", "sheet", 1, sheet) + "</CellData>\n";
  text += "<Points>\n" + arrays.add("Float64", "Points", 3, places) + "</Points>\n";
  text += lines.element("Lines", arrays);
  text += triangles.element("Polys", arrays);
  text += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  write_whole(file, text + arrays.bytes() + "\n</AppendedData>\n</VTKFile>\n");
}

}  // namespace matstruct
