// Wavefront OBJ with a group for each stratum.
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <matstruct/io.h>

#include "base/index.h"

namespace matstruct {

namespace {

void add_curves(std::string& text, const char* kind, const std::vector<Curve>& curves) {
  for (std::size_t k = 0; k < curves.size(); ++k) {
    text += fmt::format("g {}_{}\nl", kind, k);
    for (const Index v : curves[k].vertices) text += fmt::format(" {}", v + 1);
    text += '\n';
  }
}

std::vector<std::vector<Index>> faces_of_sheets(const Strata& strata) {
  std::vector<std::vector<Index>> faces(uz(strata.sheets));
  for (Index f = 0; f < count(strata.sheet_of_face); ++f) faces[uz(strata.sheet_of_face[uz(f)])].push_back(f);
  return faces;
}

}  // namespace

void write_obj(const MedialMesh& mesh, const Strata& strata, const std::filesystem::path& file) {
  std::string text = "# written by matstruct\n";
  for (const Vec3& p : mesh.centers) fmt::format_to(std::back_inserter(text), "v {} {} {}\n", p.x, p.y, p.z);
  const auto sheets = faces_of_sheets(strata);
  for (std::size_t s = 0; s < sheets.size(); ++s) {
    text += fmt::format("g sheet_{}\n", s);
    for (const Index f : sheets[s]) {
      const auto& [i, j, k] = mesh.faces[uz(f)];
      fmt::format_to(std::back_inserter(text), "f {} {} {}\n", i + 1, j + 1, k + 1);
    }
  }
  add_curves(text, "seam", strata.seams);
  add_curves(text, "boundary", strata.boundaries);
  add_curves(text, "curve", strata.curves);
  for (std::size_t k = 0; k < strata.junctions.size(); ++k)
    text += fmt::format("g junction_{}\np {}\n", k, strata.junctions[k] + 1);
  write_whole(file, text);
}

}  // namespace matstruct
