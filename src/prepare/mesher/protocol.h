// What the library and its mesher process tell each other, as arrays in the machine's own byte order: both ends are
// always of one build. The request comes on standard input, the answer goes to standard output.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace matstruct::mesher {

/// Gmsh's numbers (option Mesh.Algorithm3D).
enum class Algorithm : std::int32_t { kDelaunay = 1, kHxt = 10 };

struct Request {
  std::vector<double> points;         ///< 3 x #V
  std::vector<std::int32_t> corners;  ///< 3 x #T: vertices of the triangles
  std::vector<std::int32_t> shells;   ///< #T: shell of each triangle, 0..n-1
  std::vector<std::int32_t> solids;   ///< for each solid: number of its shells, then the shells, the outer one first
  Algorithm algorithm = Algorithm::kHxt;
};

struct Answer {
  std::string error;                  ///< empty if it worked
  std::vector<double> points;         ///< 3 x #V: those of the request, in the same order, then added ones
  std::vector<std::int32_t> corners;  ///< 4 x #tets
};

template <class T>
bool write_array(std::FILE* file, const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::uint64_t n = values.size();
  return std::fwrite(&n, sizeof n, 1, file) == 1 && std::fwrite(values.data(), sizeof(T), n, file) == n;
}

template <class T>
bool read_array(std::FILE* file, std::vector<T>& values) {
  std::uint64_t n = 0;
  if (std::fread(&n, sizeof n, 1, file) != 1) return false;
  constexpr std::uint64_t kChunk = 1 << 20;  // a damaged length must not allocate the world
  for (values.clear(); values.size() < n;) {
    const std::size_t old = values.size();
    values.resize(std::min<std::uint64_t>(n, old + kChunk));
    if (std::fread(values.data() + old, sizeof(T), values.size() - old, file) != values.size() - old) return false;
  }
  return true;
}

inline bool write(std::FILE* file, const Request& request) {
  return write_array(file, request.points) && write_array(file, request.corners) && write_array(file, request.shells) &&
         write_array(file, request.solids) && write_array(file, std::vector{request.algorithm}) &&
         std::fflush(file) == 0;
}

inline std::optional<Request> read_request(std::FILE* file) {
  Request request;
  std::vector<Algorithm> algorithm;
  if (!read_array(file, request.points) || !read_array(file, request.corners) || !read_array(file, request.shells) ||
      !read_array(file, request.solids) || !read_array(file, algorithm) || algorithm.size() != 1)
    return std::nullopt;
  request.algorithm = algorithm.front();
  return request;
}

inline bool write(std::FILE* file, const Answer& answer) {
  return write_array(file, std::vector<char>(answer.error.begin(), answer.error.end())) &&
         write_array(file, answer.points) && write_array(file, answer.corners) && std::fflush(file) == 0;
}

inline std::optional<Answer> read_answer(std::FILE* file) {
  Answer answer;
  std::vector<char> error;
  if (!read_array(file, error) || !read_array(file, answer.points) || !read_array(file, answer.corners))
    return std::nullopt;
  answer.error.assign(error.begin(), error.end());
  return answer;
}

}  // namespace matstruct::mesher
