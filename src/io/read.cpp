// From a path to a model: the whole file in memory, then the parser of its extension.
#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <matstruct/error.h>
#include <matstruct/io.h>

#include "io/file_kind.h"
#include "io/parsers.h"

namespace matstruct {

namespace {

/// With this bound every count of elements fits an Index: an element takes two bytes at least.
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 32;

std::uintmax_t readable_size(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw Error(fmt::format("{}: the file does not exist; check its name.", name));
  if (!std::filesystem::is_regular_file(status))
    throw Error(fmt::format("{}: this is a folder or a device, not a file; name a model file.", name));
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw Error(fmt::format("{}: the file cannot be read ({}).", name, error.message()));
  if (size == 0) throw Error(fmt::format("{}: the file is empty; export it again.", name));
  if (size > kMostBytes)
    throw Error(fmt::format("{}: the file has {} bytes, more than the 4 GiB that can be handled; simplify the model.",
                            name, size));
  return size;
}

std::string read_bytes(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::uintmax_t size = readable_size(file);
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw Error(fmt::format("{}: the file cannot be read ({}); check its permissions.", name,
                            std::generic_category().message(errno != 0 ? errno : EIO)));
  return bytes;
}

struct Format {
  std::string_view extension;
  bool surface;  // else tetrahedra, or either
  Model (*parse)(std::string_view, const std::string&);
};

template <TriSurface (*kParse)(std::string_view, const std::string&)>
Model surface(std::string_view bytes, const std::string& name) {
  return kParse(bytes, name);
}

constexpr std::array<Format, 8> kFormats{{{".msh", false, parse_msh},
                                          {".mesh", false, parse_medit},
                                          {".vtk", false, parse_vtk},
                                          {".vtu", false, parse_vtu},
                                          {".stl", true, surface<parse_stl>},
                                          {".obj", true, surface<parse_obj>},
                                          {".off", true, surface<parse_off>},
                                          {".ply", true, surface<parse_ply>}}};

}  // namespace

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

bool is_surface_file(const std::filesystem::path& file) {
  const auto format = std::ranges::find(kFormats, lower_extension(file), &Format::extension);
  return format != kFormats.end() && format->surface;
}

void check_readable(const std::filesystem::path& file) {
  readable_size(file);
  if (!std::ifstream(file))
    throw Error(fmt::format("{}: the file cannot be read; check its permissions.", file.string()));
}

Model read_model(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  const auto format = std::ranges::find(kFormats, extension, &Format::extension);
  if (format == kFormats.end())
    throw Error(
        fmt::format("{}: files of the kind '{}' are not read; convert it to .msh, .mesh, .vtk or .vtu "
                    "(tetrahedra), .stl, .obj, .off or .ply (closed surface), or .step or .brep (CAD).",
                    file.string(), extension));
  return format->parse(read_bytes(file), file.string());
}

TetMesh read_tet_mesh(const std::filesystem::path& file) {
  Model model = read_model(file);
  if (auto* solid = std::get_if<TetMesh>(&model)) return std::move(*solid);
  throw Error(fmt::format("{}: the file holds a surface, no tetrahedra; tetrahedralise it first.", file.string()));
}

TriSurface read_surface(const std::filesystem::path& file) {
  Model model = read_model(file);
  if (auto* surface = std::get_if<TriSurface>(&model)) return std::move(*surface);
  throw Error(fmt::format("{}: the file holds a solid of tetrahedra where a surface is needed; export its boundary.",
                          file.string()));
}

MedialMesh read_ma(const std::filesystem::path& file) {
  return parse_ma(read_bytes(file), file.string());
}

}  // namespace matstruct
