#include "results.h"

#include <algorithm>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <matstruct/error.h>
#include <matstruct/io.h>

namespace matstruct::tool {

namespace fs = std::filesystem;

namespace {

fs::path beside(const fs::path& medial_mesh, const char* ending) {
  return medial_mesh.parent_path() / (medial_mesh.stem().string() + ending);
}

std::string facts_of(const fs::path& report_file, const MedialMesh& mesh) {
  std::string facts = fmt::format("{} spheres, {} faces", mesh.centers.size(), mesh.faces.size());
  std::ifstream file(report_file);
  if (!file) return facts;
  const auto report = nlohmann::json::parse(file, nullptr, false);
  const nlohmann::json::json_pointer place("/metrics/hausdorff_percent");
  const double percent = report.contains(place) && report[place].is_number() ? report[place].get<double>() : -1;
  if (percent >= 0) facts += fmt::format(", Hausdorff {:.2f} %", percent);
  return facts;
}

}  // namespace

std::vector<fs::path> results_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().extension() == ".ma") files.push_back(at->path());
  if (error) throw Error(fmt::format("{}: cannot be read: {}.", folder.string(), error.message()));
  if (files.empty())
    throw Error(fmt::format("{}: no results here; run 'matstruct compute' with -o first.", folder.string()));
  std::sort(files.begin(), files.end());
  return files;
}

PageContents read_result(const fs::path& medial_mesh, bool with_reconstruction) {
  PageContents contents;
  contents.name = medial_mesh.stem().string();
  contents.mesh = read_ma(medial_mesh);
  if (const fs::path solid = beside(medial_mesh, ".solid.ply"); fs::exists(solid)) contents.solid = read_surface(solid);
  if (const fs::path surface = beside(medial_mesh, ".surface.ply"); with_reconstruction && fs::exists(surface))
    contents.reconstruction = read_surface(surface);
  contents.facts = facts_of(beside(medial_mesh, ".report.json"), contents.mesh);
  return contents;
}

}  // namespace matstruct::tool
