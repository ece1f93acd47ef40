// What the tests of the io layer share: temporary folders, model files made by tools/make_bad_files.py, and
// comparisons.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <matstruct/error.h>
#include <matstruct/types.h>

#include "base/index.h"
#include "io/parsers.h"
#include "temp_folder.h"

namespace matstruct::testing {

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Runs tools/make_bad_files.py; false if there is no python3.
inline bool make_files(const std::filesystem::path& folder, const std::string& options = "") {
  const std::string script = MATSTRUCT_SOURCE "/tools/make_bad_files.py";
  return std::system(("python3 '" + script + "' " + options + " '" + folder.string() + "'").c_str()) == 0;
}

/// The message of the Error that `call` throws; empty if it throws none.
template <class Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

inline std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// A mesh as a set of elements, each given by its corners' coordinates and rotated or sorted to one form, so that
/// meshes can be compared whatever the order of vertices and elements.
using Corners = std::vector<std::array<double, 3>>;

template <class Element>
std::vector<Corners> corners_of(const std::vector<Vec3>& vertices, const std::vector<Element>& elements) {
  std::vector<Corners> all;
  for (const Element& element : elements) {
    Corners corners;
    for (const Index i : element) corners.push_back({vertices[uz(i)].x, vertices[uz(i)].y, vertices[uz(i)].z});
    all.push_back(corners);
  }
  return all;
}

/// Triangles keep their orientation.
inline std::vector<Corners> canonical(const TriSurface& surface) {
  std::vector<Corners> all = corners_of(surface.vertices, surface.triangles);
  for (Corners& t : all) std::ranges::rotate(t, std::ranges::min_element(t));
  std::ranges::sort(all);
  return all;
}

inline std::vector<Corners> canonical(const TetMesh& mesh) {
  std::vector<Corners> all = corners_of(mesh.vertices, mesh.tets);
  for (Corners& t : all) std::ranges::sort(t);
  std::ranges::sort(all);
  return all;
}

/// Fails the test unless the model is what io.h promises: finite coordinates, indices in range, some elements.
template <class Element>
void expect_valid(const std::vector<Vec3>& vertices, const std::vector<Element>& elements) {
  EXPECT_FALSE(elements.empty());
  for (const Vec3& p : vertices) EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  for (const Element& element : elements)
    for (const Index i : element) EXPECT_TRUE(i >= 0 && i < count(vertices));
}

inline void expect_valid(const Model& model) {
  if (const auto* solid = std::get_if<TetMesh>(&model))
    expect_valid(solid->vertices, solid->tets);
  else
    expect_valid(std::get<TriSurface>(model).vertices, std::get<TriSurface>(model).triangles);
}

/// The corners of the unit cube, x fastest, as the files of make_bad_files.py have them.
inline std::vector<Vec3> cube_vertices() {
  std::vector<Vec3> vertices;
  for (int i = 0; i < 8; ++i) vertices.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
  return vertices;
}

/// Outward triangles, two for each side.
inline TriSurface cube_surface() {
  return {cube_vertices(),
          {{0, 2, 3},
           {0, 3, 1},
           {4, 5, 7},
           {4, 7, 6},
           {0, 1, 5},
           {0, 5, 4},
           {2, 6, 7},
           {2, 7, 3},
           {0, 4, 6},
           {0, 6, 2},
           {1, 3, 7},
           {1, 7, 5}}};
}

/// Six tetrahedra around the diagonal from 0 to 7.
inline TetMesh cube_solid() {
  return {cube_vertices(), {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};
}

}  // namespace matstruct::testing
