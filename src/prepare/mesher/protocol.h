// What the library and its mesher process tell each other, as arrays in the machine's own byte order: both ends are
// always of one build. Standard input of the mesher is a socket (SOCK_SEQPACKET). For every task it receives a packet
// with two files, one with the Request and one for the Answer, and sends back the status, as of waitpid(), of the copy
// of itself that did the task.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace matstruct::mesher {

enum class Task : std::int32_t {
  kFill,           ///< closed surface -> tetrahedra
  kCad,            ///< CAD file -> triangles of its solids
  kResolve,        ///< any triangles -> boundary of what they enclose, without intersections
  kIntersections,  ///< any triangles -> where they meet
  kFillHoles,
  kWrap,  ///< any triangles -> closed surface around them
};

/// Gmsh's numbers (option Mesh.Algorithm3D).
enum class Algorithm : std::int32_t { kDelaunay = 1, kHxt = 10 };

struct Request {
  Task task = Task::kFill;
  std::vector<double> points;         ///< 3 x #V
  std::vector<std::int32_t> corners;  ///< 3 x #T: vertices of the triangles
  // kFill
  std::vector<std::int32_t> shells;  ///< #T: shell of each triangle, 0..n-1
  std::vector<std::int32_t> solids;  ///< for each solid: number of its shells, then the shells, the outer one first
  Algorithm algorithm = Algorithm::kHxt;
  // Others
  std::string file;  ///< kCad
  /// kFill: greatest length of edges inside, 0 for none; kCad: greatest distance of triangles from the surface, in
  /// diagonals; kResolve: see there; kFillHoles: greatest diameter of a hole; kWrap: least diameter of an opening that
  /// is entered.
  double size = 0;
};

struct Answer {
  std::string error;                  ///< empty if it worked
  std::vector<double> points;         ///< 3 x #V; kFill: those of the request, in the same order, then added ones
  std::vector<std::int32_t> corners;  ///< 4 x #tets (kFill) or 3 x #triangles (others)
  // kCad: one mesh per solid; `points` and `corners` hold them one after the other, corners counted within the solid.
  std::vector<std::string> names;                           ///< of each solid, may be empty
  std::vector<std::int32_t> solid_points, solid_triangles;  ///< number of each solid
  std::vector<std::int32_t> solid_segments;
  std::vector<std::int32_t> segments;  ///< 2 x #segments: pieces of CAD edges, points within the solid
  std::vector<double> dihedrals;       ///< #segments: interior angle of the CAD faces there, radians
  std::vector<double> deviations;      ///< of each solid: measured distance of triangles and surface, in diagonals
  std::int64_t changed = 0;  ///< kResolve, kIntersections: pairs of triangles that meet; kFillHoles: holes filled
  std::string note;          ///< a sentence to pass on, may be empty
};

template <class T>
bool write_array(std::FILE* file, const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::uint64_t n = values.size();
  // fwrite() of nothing may still not be given the null pointer of an empty vector.
  return std::fwrite(&n, sizeof n, 1, file) == 1 && (n == 0 || std::fwrite(values.data(), sizeof(T), n, file) == n);
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

/// Both directions in one: each field is listed once, so that writer and reader cannot disagree.
class Writer {
 public:
  explicit Writer(std::FILE* file) : file_(file) {}
  bool good() const { return good_; }
  template <class T>
  void operator()(std::vector<T>& values) {
    good_ = good_ && write_array(file_, values);
  }
  void operator()(std::string& text) {
    std::vector<char> bytes(text.begin(), text.end());
    (*this)(bytes);
  }
  void operator()(std::vector<std::string>& texts) {
    std::vector<char> lengths(texts.size());
    (*this)(lengths);
    for (std::string& text : texts) (*this)(text);
  }
  template <class T>
  void operator()(T& value) {
    std::vector<T> one{value};
    (*this)(one);
  }

 private:
  std::FILE* file_;
  bool good_ = true;
};

class Reader {
 public:
  explicit Reader(std::FILE* file) : file_(file) {}
  bool good() const { return good_; }
  template <class T>
  void operator()(std::vector<T>& values) {
    good_ = good_ && read_array(file_, values);
  }
  void operator()(std::string& text) {
    std::vector<char> bytes;
    (*this)(bytes);
    text.assign(bytes.begin(), bytes.end());
  }
  void operator()(std::vector<std::string>& texts) {
    std::vector<char> lengths;
    (*this)(lengths);
    texts.resize(good_ ? lengths.size() : 0);
    for (std::string& text : texts) (*this)(text);
  }
  template <class T>
  void operator()(T& value) {
    std::vector<T> one;
    (*this)(one);
    good_ = good_ && one.size() == 1;
    if (good_) value = one.front();
  }

 private:
  std::FILE* file_;
  bool good_ = true;
};

template <class Visitor>
void visit(Request& r, Visitor& field) {
  field(r.task), field(r.points), field(r.corners), field(r.shells), field(r.solids), field(r.algorithm), field(r.file),
      field(r.size);
}

template <class Visitor>
void visit(Answer& a, Visitor& field) {
  field(a.error), field(a.points), field(a.corners), field(a.names), field(a.solid_points), field(a.solid_triangles),
      field(a.solid_segments), field(a.segments), field(a.dihedrals), field(a.deviations), field(a.changed),
      field(a.note);
}

template <class Message>
bool write(std::FILE* file, Message message) {
  Writer writer(file);
  visit(message, writer);
  return writer.good() && std::fflush(file) == 0;
}

template <class Message>
std::optional<Message> read(std::FILE* file) {
  Message message;
  Reader reader(file);
  visit(message, reader);
  return reader.good() ? std::optional(std::move(message)) : std::nullopt;
}

}  // namespace matstruct::mesher
