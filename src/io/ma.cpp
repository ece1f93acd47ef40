// The .ma format of medial meshes: `nv ne nf`, then lines `v x y z r [type]`, `e i j`, `f i j k`. More columns, as some
// earlier programs write, are passed over.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <matstruct/io.h>

#include "base/index.h"
#include "io/cursor.h"
#include "io/parsers.h"

namespace matstruct {

namespace {

constexpr int kTypes = 5;  // of SphereType

/// Shortest decimal form that reads back to the same bits.
void append(std::string& text, double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  text += ' ';
  text.append(buffer, result.ptr);
}

/// Earlier programs number the types in other ways: what is not one of ours counts as not classified.
SphereType read_sphere_type(Cursor& line, Item item) {
  if (line.at_end()) return SphereType::kSheet;
  const double type = line.real(item);
  return type >= 0 && type < kTypes && type == std::floor(type) ? static_cast<SphereType>(type) : SphereType::kSheet;
}

void read_sphere(Cursor& line, MedialMesh& mesh) {
  const Item item{"vertex", count(mesh.centers)};
  mesh.centers.push_back(line.point(item));
  const double radius = line.real(item);
  if (!(radius >= 0) || !std::isfinite(radius))
    line.fail(fmt::format("the radius of {} is {}", item.text(), radius), "a radius is finite and not negative");
  mesh.radii.push_back(radius);
  mesh.types.push_back(read_sphere_type(line, item));
}

/// Reads the vertices of an edge or face, in ascending order.
template <class Simplex>
Simplex read_simplex(Cursor& line, Item item, std::size_t vertices) {
  Simplex simplex;
  for (Index& i : simplex) i = line.check_index(line.integer(item), vertices, 0, item);
  std::ranges::sort(simplex);
  if (std::ranges::adjacent_find(simplex) != simplex.end())
    line.fail(fmt::format("{} has the same vertex twice", item.text()), "remove it or compute the file again");
  return simplex;
}

template <class Simplex>
void sort_unique(std::vector<Simplex>& simplices) {
  std::ranges::sort(simplices);
  simplices.erase(std::unique(simplices.begin(), simplices.end()), simplices.end());
}

/// What MedialMesh promises: sorted, unique, every edge of every face present.
void complete(MedialMesh& mesh) {
  sort_unique(mesh.faces);
  for (const auto& [a, b, c] : mesh.faces) mesh.edges.insert(mesh.edges.end(), {{a, b}, {a, c}, {b, c}});
  sort_unique(mesh.edges);
}

/// The next line with something on it, which has to begin with `keyword`.
Cursor record(Cursor& cursor, std::string_view keyword, Item item) {
  if (cursor.at_end()) cursor.fail_truncated(item);
  Cursor line = cursor.line();
  line.expect(keyword);
  return line;
}

}  // namespace

MedialMesh parse_ma(std::string_view bytes, const std::string& name) {
  Cursor cursor(bytes, name, '#');
  const std::int64_t nv = cursor.integer({"the number of vertices"});
  const std::int64_t ne = cursor.integer({"the number of edges"});
  const std::int64_t nf = cursor.integer({"the number of faces"});
  const std::size_t vertices = cursor.check_count(nv, 10, "vertices");
  const std::size_t edges = cursor.check_count(ne, 6, "edges");
  const std::size_t faces = cursor.check_count(nf, 8, "faces");
  MedialMesh mesh;
  const auto id = [](std::size_t i) { return static_cast<std::int64_t>(i); };
  for (std::size_t i = 0; i < vertices; ++i) {
    Cursor line = record(cursor, "v", {"vertex", id(i)});
    read_sphere(line, mesh);
  }
  for (std::size_t i = 0; i < edges; ++i) {
    Cursor line = record(cursor, "e", {"edge", id(i)});
    mesh.edges.push_back(read_simplex<Edge>(line, {"edge", id(i)}, vertices));
  }
  for (std::size_t i = 0; i < faces; ++i) {
    Cursor line = record(cursor, "f", {"face", id(i)});
    mesh.faces.push_back(read_simplex<Triangle>(line, {"face", id(i)}, vertices));
  }
  if (!cursor.at_end())
    cursor.fail(fmt::format("there is more after the {} vertices, {} edges and {} faces announced", nv, ne, nf),
                "correct the counts in the first line");
  complete(mesh);
  return mesh;
}

void write_ma(const MedialMesh& mesh, const std::filesystem::path& file) {
  std::string text = fmt::format("{} {} {}\n", mesh.centers.size(), mesh.edges.size(), mesh.faces.size());
  for (std::size_t i = 0; i < mesh.centers.size(); ++i) {
    text += 'v';
    for (int k = 0; k < 3; ++k) append(text, mesh.centers[i][k]);
    append(text, mesh.radii[i]);
    text += fmt::format(" {}\n", static_cast<int>(mesh.types[i]));
  }
  for (const auto& [i, j] : mesh.edges) text += fmt::format("e {} {}\n", i, j);
  for (const auto& [i, j, k] : mesh.faces) text += fmt::format("f {} {} {}\n", i, j, k);
  write_whole(file, text);
}

}  // namespace matstruct
