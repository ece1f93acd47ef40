// Numbers whose type is named in the file, as in PLY and VTK.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "io/cursor.h"

namespace matstruct {

enum class Scalar { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat, kDouble };

/// The type of a PLY or VTK type name: "uchar", "uint8", "unsigned_char", ...; none if unknown.
std::optional<Scalar> scalar_of(std::string_view name);

/// Bytes of a binary value.
std::size_t size_of(Scalar type);

inline bool is_integer(Scalar type) {
  return type != Scalar::kFloat && type != Scalar::kDouble;
}

/// The least bytes that a value takes, in the cursor's mode.
inline std::size_t least_bytes(const Cursor& cursor, Scalar type) {
  return cursor.binary() ? size_of(type) : 2;
}

/// The next value, of text or binary according to the cursor's mode.
double read_real(Cursor& cursor, Scalar type, Item item);
/// The same for integers; fails if the type is not one, or the value is 2^63 or more.
std::int64_t read_integer(Cursor& cursor, Scalar type, Item item);

}  // namespace matstruct
