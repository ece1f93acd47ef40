// Binary glTF 2.0 (Khronos Group, 2017): a header, the scene as JSON, and the arrays as one buffer.
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <matstruct/io.h>

#include "base/index.h"
#include "io/bytes.h"

namespace matstruct {

namespace {

using Json = nlohmann::ordered_json;
using Color = std::array<std::uint8_t, 3>;

// The colours of the viewer.
constexpr std::array<Color, 15> kSheetColors{{{0x56, 0xb4, 0xe9},
                                              {0xe6, 0x9f, 0x00},
                                              {0x00, 0x9e, 0x73},
                                              {0xf0, 0xe4, 0x42},
                                              {0xcc, 0x79, 0xa7},
                                              {0x8d, 0xa0, 0xcb},
                                              {0xa6, 0xd8, 0x54},
                                              {0xe5, 0xc4, 0x94},
                                              {0x66, 0xc2, 0xa5},
                                              {0xbe, 0xba, 0xda},
                                              {0xfd, 0xb4, 0x62},
                                              {0x80, 0xb1, 0xd3},
                                              {0xb3, 0xde, 0x69},
                                              {0xfc, 0xcd, 0xe5},
                                              {0xd9, 0xd9, 0xd9}}};
constexpr Color kSeam{0xd6, 0x22, 0x2a}, kBoundary{0x5f, 0x6b, 0x78}, kCurve{0x8b, 0x2f, 0xc9},
    kJunction{0x17, 0x47, 0xd1};

// Numbers that the format gives to kinds.
constexpr int kFloat = 5126, kUnsignedInt = 5125, kVertices = 34962, kIndices = 34963;
enum Mode : int { kPoints = 0, kLines = 1, kTriangles = 4 };

class Scene {
 public:
  explicit Scene(const MedialMesh& mesh) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "matstruct"}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({{{"nodes", {0}}}});
    Vec3 low, high;
    if (!mesh.centers.empty()) low = high = mesh.centers.front();
    for (const Vec3& p : mesh.centers) low = min(low, p), high = max(high, p);
    const Vec3 middle = (low + high) / 2;
    // A quarter turn about x takes z to y. Translations come after rotations.
    json_["nodes"] = Json::array({{{"name", "medial mesh"},
                                   {"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}},
                                   {"translation", {middle.x, middle.z, -middle.y}}}});
    add_vertices(mesh, middle);
  }

  void add_node(const char* name, const Json& primitives) {
    if (primitives.empty()) return;
    json_["nodes"][0]["children"].push_back(json_["nodes"].size());
    json_["nodes"].push_back({{"name", name}, {"mesh", json_["meshes"].size()}});
    json_["meshes"].push_back({{"name", name}, {"primitives", primitives}});
  }
  Json primitive(Mode mode, const std::vector<Index>& ids, int material) {
    const std::size_t view = add_view(ids.size() * sizeof(Index), kIndices);
    for (const Index i : ids) append(buffer_, static_cast<std::uint32_t>(i));
    json_["accessors"].push_back(
        {{"bufferView", view}, {"componentType", kUnsignedInt}, {"count", ids.size()}, {"type", "SCALAR"}});
    return {{"attributes", {{"POSITION", 0}, {"_RADIUS", 1}}},
            {"indices", json_["accessors"].size() - 1},
            {"mode", int{mode}},
            {"material", material}};
  }
  int add_material(const char* name, const Color& color) {
    Json factor = Json::array();
    for (const std::uint8_t c : color) {  // from sRGB to the linear values of the format
      const double x = c / 255.0;
      factor.push_back(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
    }
    factor.push_back(1.0);
    json_["materials"].push_back(
        {{"name", name},
         {"doubleSided", true},
         {"pbrMetallicRoughness", {{"baseColorFactor", factor}, {"metallicFactor", 0}, {"roughnessFactor", 0.9}}}});
    return static_cast<int>(json_["materials"].size()) - 1;
  }

  std::string bytes() {
    json_["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
    std::string text = json_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string result;
    for (const std::size_t n : {std::size_t{0x46546c67}, std::size_t{2}, 28 + text.size() + buffer_.size(), text.size(),
                                std::size_t{0x4e4f534a}})
      append(result, static_cast<std::uint32_t>(n));
    result += text;
    append(result, static_cast<std::uint32_t>(buffer_.size()));
    append(result, std::uint32_t{0x004e4942});
    return result + buffer_;
  }

 private:
  std::size_t add_view(std::size_t length, int target) {
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", length}, {"target", target}});
    return json_["bufferViews"].size() - 1;
  }
  void add_vertices(const MedialMesh& mesh, const Vec3& middle) {
    const std::size_t n = mesh.centers.size();
    const std::size_t places = add_view(n * 3 * sizeof(float), kVertices);
    std::array<float, 3> low{}, high{};
    for (std::size_t v = 0; v < n; ++v) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto x = static_cast<float>((mesh.centers[v] - middle)[static_cast<int>(k)]);
        append(buffer_, x);
        low[k] = v == 0 ? x : std::min(low[k], x);
        high[k] = v == 0 ? x : std::max(high[k], x);
      }
    }
    const std::size_t radii = add_view(n * sizeof(float), kVertices);
    for (const double r : mesh.radii) append(buffer_, static_cast<float>(r));
    json_["accessors"] =
        Json::array({{{"bufferView", places},
                      {"componentType", kFloat},
                      {"count", n},
                      {"type", "VEC3"},
                      {"min", low},
                      {"max", high}},
                     {{"bufferView", radii}, {"componentType", kFloat}, {"count", n}, {"type", "SCALAR"}}});
  }

  Json json_;
  std::string buffer_;
};

std::vector<Index> segments(const std::vector<Curve>& curves) {
  std::vector<Index> ids;
  for (const Curve& curve : curves)
    for (std::size_t k = 0; k + 1 < curve.vertices.size(); ++k)
      ids.insert(ids.end(), {curve.vertices[k], curve.vertices[k + 1]});
  return ids;
}

}  // namespace

void write_glb(const MedialMesh& mesh, const Strata& strata, const std::filesystem::path& file) {
  Scene scene(mesh);
  std::vector<std::vector<Index>> sheets(uz(strata.sheets));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    std::vector<Index>& ids = sheets[uz(strata.sheet_of_face[f])];
    ids.insert(ids.end(), mesh.faces[f].begin(), mesh.faces[f].end());
  }
  std::vector<int> materials;
  for (std::size_t k = 0; k < std::min(sheets.size(), kSheetColors.size()); ++k)
    materials.push_back(scene.add_material(fmt::format("sheet colour {}", k).c_str(), kSheetColors[k]));
  Json primitives = Json::array();
  for (std::size_t s = 0; s < sheets.size(); ++s)
    primitives.push_back(scene.primitive(kTriangles, sheets[s], materials[s % kSheetColors.size()]));
  scene.add_node("sheets", primitives);

  const auto add = [&](const char* name, Mode mode, const std::vector<Index>& ids, const Color& color) {
    if (!ids.empty()) scene.add_node(name, Json::array({scene.primitive(mode, ids, scene.add_material(name, color))}));
  };
  add("seams", kLines, segments(strata.seams), kSeam);
  add("boundaries", kLines, segments(strata.boundaries), kBoundary);
  add("medial curves", kLines, segments(strata.curves), kCurve);
  add("junctions", kPoints, strata.junctions, kJunction);
  write_whole(file, scene.bytes());
}

}  // namespace matstruct
