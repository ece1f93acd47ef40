#include "page.h"

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <matstruct/error.h>
#include <matstruct/strata.h>

#include "base/index.h"

namespace matstruct::tool {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kPageVariable = "MATSTRUCT_VIEWER";
constexpr std::string_view kMarker = "/*data*/";

std::string base64(std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (k + i < bytes.size() ? std::to_integer<std::uint32_t>(bytes[k + i]) : 0);
    for (std::size_t i = 0; i < 4; ++i) text += k + i <= bytes.size() ? kDigits[group >> (18 - 6 * i) & 63] : '=';
  }
  return text;
}

// Little-endian, as on every machine that this program is built for.
template <class T>
Json array(const char* kind, const std::vector<T>& values) {
  return {{"kind", kind}, {"base64", base64(std::as_bytes(std::span(values)))}};
}

Json positions(const std::vector<Vec3>& points, const Vec3& origin) {
  std::vector<float> values;
  for (const Vec3& p : points)
    for (const double x : {p.x - origin.x, p.y - origin.y, p.z - origin.z}) values.push_back(static_cast<float>(x));
  return array("f32", values);
}

template <std::size_t N>
Json ids(const std::vector<std::array<Index, N>>& simplices) {
  std::vector<Index> values;
  for (const auto& s : simplices) values.insert(values.end(), s.begin(), s.end());
  return array("i32", values);
}

void add_curves(Json& arrays, const std::string& name, const std::vector<Curve>& curves) {
  std::vector<Index> start{0}, vertices;
  for (const Curve& c : curves) {
    vertices.insert(vertices.end(), c.vertices.begin(), c.vertices.end());
    start.push_back(count(vertices));
  }
  arrays[name + "Start"] = array("i32", start);
  arrays[name + "Vertices"] = array("i32", vertices);
}

Vec3 middle_of(const std::vector<Vec3>& points) {
  if (points.empty()) return {};
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) {
    low = min(low, p);
    high = max(high, p);
  }
  return 0.5 * (low + high);
}

Json data_of(const PageContents& contents) {
  const MedialMesh& mesh = contents.mesh;
  const Strata strata = trace_strata(mesh);
  const Vec3 origin = middle_of(contents.solid.vertices.empty() ? mesh.centers : contents.solid.vertices);
  std::vector<float> radii(mesh.radii.begin(), mesh.radii.end());
  std::vector<std::uint8_t> types;
  for (const SphereType t : mesh.types) types.push_back(static_cast<std::uint8_t>(t));
  Json arrays;
  arrays["solidPositions"] = positions(contents.solid.vertices, origin);
  arrays["solidTriangles"] = ids(contents.solid.triangles);
  if (contents.reconstruction) {
    arrays["surfacePositions"] = positions(contents.reconstruction->vertices, origin);
    arrays["surfaceTriangles"] = ids(contents.reconstruction->triangles);
  }
  arrays["centers"] = positions(mesh.centers, origin);
  arrays["radii"] = array("f32", radii);
  arrays["types"] = array("u8", types);
  arrays["faces"] = ids(mesh.faces);
  arrays["sheetOfFace"] = array("i32", strata.sheet_of_face);
  add_curves(arrays, "seam", strata.seams);
  add_curves(arrays, "boundary", strata.boundaries);
  add_curves(arrays, "curve", strata.curves);
  arrays["junctions"] = array("i32", strata.junctions);
  return {{"name", contents.name},
          {"facts", contents.facts},
          {"origin", {origin.x, origin.y, origin.z}},
          {"sheets", strata.sheets},
          {"arrays", arrays}};
}

}  // namespace

std::string viewer_template() {
  std::error_code ignored;
  const fs::path own = fs::canonical("/proc/self/exe", ignored).parent_path();
  std::vector<fs::path> places{own / "viewer.html", own / "../share/matstruct/viewer.html"};
  if (const char* given = std::getenv(kPageVariable)) places = {given};
  for (const fs::path& place : places) {
    std::ifstream file(place, std::ios::binary);
    if (!file) continue;
    std::string page{std::istreambuf_iterator<char>(file), {}};
    if (page.find(kMarker) == std::string::npos)
      throw Error(fmt::format("{}: not a template of the viewer; build it anew.", place.string()));
    return page;
  }
  throw Error(
      fmt::format("the viewer was not found at {}; build matstruct with npm, or set {} to the path of viewer.html.",
                  places.front().string(), kPageVariable));
}

std::string viewer_page(std::string page_template, const PageContents& contents) {
  // A "<" in a name must not end the element that holds the data; names need not be UTF-8.
  std::string data = data_of(contents).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = data.find('<', at)) != std::string::npos;) data.replace(at, 1, "\\u003c");
  return page_template.replace(page_template.find(kMarker), kMarker.size(), data);
}

}  // namespace matstruct::tool
