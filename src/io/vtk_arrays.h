// The binary arrays of VTK's XML files: bytes as they are or in base64, behind their length, or in blocks deflated by
// zlib behind a table of the blocks' sizes.
#pragma once

#include <bit>
#include <cstddef>
#include <string>
#include <string_view>

#include "io/cursor.h"

namespace matstruct {

/// What could be done about a file that lacks bytes.
inline constexpr const char* kDamaged = "the file is truncated or damaged, copy or export it again";

/// How all binary arrays of a file are stored.
struct VtkStorage {
  std::endian order = std::endian::little;
  bool long_sizes = false;  ///< lengths take 8 bytes instead of 4
  bool deflated = false;
};

/// Where an array is stored: its data begin with the first byte (raw) or character (base64).
struct VtkStored {
  std::string_view bytes;
  bool base64 = false;
  bool alone = false;  ///< nothing else may follow the array in `bytes`
};

/// The `n` bytes of an array, in the file's byte order. Fails at the cursor's mark, with the array's name, if it is cut
/// off, malformed, or of another length; `n` > 0. Memory and time are O(n), and memory at most kMostInflation times the
/// bytes stored.
std::string decode_vtk_array(VtkStored stored, const VtkStorage& storage, std::size_t n, std::string_view name,
                             const Cursor& cursor);

/// Most bytes that zlib makes of one ("Maximum Compression Factor" of its technical details).
inline constexpr std::size_t kMostInflation = 1032;

}  // namespace matstruct
