// STL, text and binary. The format repeats the vertices of every triangle; equal ones become one vertex.
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/index.h"
#include "io/cursor.h"
#include "io/mixed_mesh.h"
#include "io/parsers.h"

namespace matstruct {

namespace {

constexpr std::size_t kHeader = 80, kCount = 4, kNormal = 12, kFacet = 50;

struct PointHash {
  std::size_t operator()(const Vec3& p) const {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(p[k])) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

/// Gives equal points one id, in the order of their first appearance.
class Welder {
 public:
  explicit Welder(std::vector<Vec3>& vertices) : vertices_(vertices) {}

  Index id(const Vec3& point) {
    const Vec3 p = point + Vec3{};  // turns -0 into 0, which is equal but has other bits
    const auto [entry, is_new] = ids_.try_emplace(p, count(vertices_));
    if (is_new) vertices_.push_back(p);
    return entry->second;
  }

 private:
  std::vector<Vec3>& vertices_;
  std::unordered_map<Vec3, Index, PointHash> ids_;
};

std::uint32_t announced_facets(std::string_view bytes, std::string_view name) {
  Cursor cursor(bytes, name);
  cursor.set_binary(std::endian::little);
  cursor.skip(kHeader, {"the header"});
  return cursor.raw<std::uint32_t>({"the number of facets"});
}

/// A binary file may begin with "solid" as well, so its exact size decides first; then bytes that no text has.
bool is_binary(std::string_view bytes, std::string_view name) {
  if (bytes.size() >= kHeader + kCount &&
      bytes.size() == kHeader + kCount + kFacet * std::size_t{announced_facets(bytes, name)})
    return true;
  Cursor cursor(bytes, name);
  const bool solid = cursor.accept("solid");
  return !solid || bytes.find('\0') != std::string_view::npos;
}

void read_binary(std::string_view bytes, const std::string& name, MixedMesh& mesh) {
  Cursor cursor(bytes, name);
  cursor.set_binary(std::endian::little);
  if (bytes.size() < kHeader + kCount)
    cursor.fail(fmt::format("the {} bytes of the file are no STL: too short for the binary form, and the text form "
                            "begins with 'solid'",
                            bytes.size()),
                "export it again");
  const std::size_t n = announced_facets(bytes, name);
  cursor.skip(kHeader + kCount, {"the header"});
  if (cursor.remaining() != n * kFacet)
    cursor.fail(fmt::format("{} facets of {} bytes are announced but {} bytes follow, so this is not a complete binary "
                            "STL (and no text STL, which begins with 'solid')",
                            n, kFacet, cursor.remaining()),
                "copy or export it again");
  Welder welder(mesh.vertices);
  mesh.triangles.reserve(n);
  for (std::size_t i = 1; i <= n; ++i) {
    const Item item{"facet", static_cast<std::int64_t>(i)};
    cursor.skip(kNormal, item);
    Triangle t;
    for (Index& corner : t) {
      Vec3 p;
      for (int k = 0; k < 3; ++k) p[k] = static_cast<double>(cursor.raw<float>(item));
      cursor.check_finite(p, item);
      corner = welder.id(p);
    }
    cursor.skip(2, item);
    add_polygon(t, item, cursor, mesh.triangles);
  }
}

void read_facet(Cursor& cursor, Item item, Welder& welder, std::vector<Triangle>& triangles) {
  cursor.expect("normal");
  for (int k = 0; k < 3; ++k) cursor.word(item);  // not needed, and "nan" in the files of some programs
  cursor.expect("outer");
  cursor.expect("loop");
  Triangle t;
  for (Index& corner : t) {
    cursor.expect("vertex");
    corner = welder.id(cursor.point(item));
  }
  cursor.expect("endloop");
  cursor.expect("endfacet");
  add_polygon(t, item, cursor, triangles);
}

/// One or more solids, each "solid <name>" to "endsolid <name>".
void read_text(std::string_view bytes, const std::string& name, MixedMesh& mesh) {
  Cursor cursor(bytes, name);
  Welder welder(mesh.vertices);
  Item facet{"facet", 0};
  while (!cursor.at_end()) {
    cursor.expect("solid");
    cursor.line();
    while (!cursor.accept("endsolid")) {
      ++facet.id;
      if (cursor.at_end()) cursor.fail("the file ends without 'endsolid': it is truncated", "copy or export it again");
      cursor.expect("facet");
      read_facet(cursor, facet, welder, mesh.triangles);
    }
    cursor.line();
  }
}

}  // namespace

TriSurface parse_stl(std::string_view bytes, const std::string& name) {
  MixedMesh mesh;
  is_binary(bytes, name) ? read_binary(bytes, name, mesh) : read_text(bytes, name, mesh);
  return surface_of(std::move(mesh), name);
}

}  // namespace matstruct
