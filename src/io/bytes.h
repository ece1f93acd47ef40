// Binary values, little endian whatever the machine.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include <matstruct/vec3.h>

namespace matstruct {

template <class T>
void append(std::string& bytes, T value) {
  char buffer[sizeof(T)];
  std::memcpy(buffer, &value, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(buffer, buffer + sizeof(T));
  bytes.append(buffer, sizeof(T));
}

inline void append(std::string& bytes, const Vec3& p) {
  for (int k = 0; k < 3; ++k) append(bytes, p[k]);
}

}  // namespace matstruct
