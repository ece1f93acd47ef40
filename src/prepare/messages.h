// How elements of the input are named in messages.
#pragma once

#include <string>

#include <fmt/format.h>

#include <matstruct/types.h>

namespace matstruct {

inline std::string place(const Vec3& p) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", p.x, p.y, p.z);
}

/// "1 vertex", "2 vertices".
inline std::string counted(std::size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

}  // namespace matstruct
