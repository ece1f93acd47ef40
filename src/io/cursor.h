// A bounds-checked walk over the bytes of one file: words and numbers of text, binary values of either byte order, and
// errors that say where. Every reader is written on it, so that no reader can run past the end of its file.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include <matstruct/types.h>

namespace matstruct {

inline bool is_blank(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Of ASCII letters, whatever the locale.
inline char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// What is being read, for messages: "vertex 12", or just "the number of vertices" when it has no id.
struct Item {
  const char* kind;
  std::int64_t id = -1;
  std::string text() const;
};

/// Text is blank-separated words; where a comment character is set, it and the rest of its line count as blank. The
/// value functions (integer, size, real, point) read binary values instead after set_binary().
class Cursor {
 public:
  /// Keeps views of both arguments. `comment` is '\0' for formats without comments.
  Cursor(std::string_view bytes, std::string_view name, char comment = '\0')
      : bytes_(bytes), name_(name), end_(bytes.size()), comment_(comment) {}

  /// From now on values are binary, in the byte order given, and errors give byte offsets, not lines.
  void set_binary(std::endian order);
  void set_text() { binary_ = false; }
  bool binary() const { return binary_; }

  std::size_t offset() const { return position_; }
  std::size_t remaining() const { return end_ - position_; }
  /// Errors from now on point at byte `offset`.
  void mark_at(std::size_t offset) { mark_ = offset; }

  // Words of text, whatever the mode.

  /// True if only blanks and comments are left.
  bool at_end();
  /// The next word; fails at the end.
  std::string_view word(Item item);
  /// The next word without passing it; empty at the end.
  std::string_view peek();
  /// Passes the next word if it is this one (ASCII letters of either case).
  bool accept(std::string_view keyword);
  /// Passes this word (either case) or fails.
  void expect(std::string_view keyword);
  /// A cursor over the rest of this line, without its comment; this cursor moves to the next line.
  Cursor line();
  /// A cursor over the bytes [begin, end) of the file, called `part` in errors; what it says of lines is of the file.
  Cursor within(std::size_t begin, std::size_t end, const char* part) const;
  /// All that is left, as bytes.
  std::string_view rest() const { return bytes_.substr(position_, remaining()); }
  /// Moves forward by `n` bytes; fails if there are fewer.
  void skip(std::size_t n, Item item);
  /// Moves behind the next occurrence of `text`; fails if there is none.
  void skip_past(std::string_view text);

  // Values, of text or binary according to the mode. In text an integer of any size is read by either.

  std::int64_t integer(Item item);  ///< binary: 4 bytes, signed
  std::int64_t size(Item item);     ///< binary: 8 bytes, unsigned, at most 2^63 - 1
  double real(Item item);           ///< binary: 8 bytes; may be NaN or infinite
  Vec3 point(Item item);            ///< three reals; fails unless all are finite
  /// A binary value; fails if fewer bytes are left.
  template <class T>
  T raw(Item item);

  /// Fails if `n` is negative, does not fit an Index, or if `n` elements of at least `bytes_each` bytes are more than
  /// the bytes left can hold; to be called before any allocation. A number in text takes at least two bytes.
  std::size_t check_count(std::int64_t n, std::size_t bytes_each, const char* plural) const;
  /// `i` as an index into `n` vertices that the file, or a part of it, numbers from `first`; fails if it is out of
  /// range.
  Index check_index(std::int64_t i, std::size_t n, std::int64_t first, Item item, const char* part = "file") const;
  /// Fails unless all three coordinates are finite.
  void check_finite(const Vec3& p, Item item) const;

  /// Throws Error: "<name>, <place of the last word or value>: <problem>; <remedy>."
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const;
  /// fail() for a file that ends within `item`.
  [[noreturn]] void fail_truncated(Item item) const;

 private:
  void skip_blanks();
  std::size_t word_end() const;
  std::int64_t text_integer(Item item);
  double text_real(Item item);

  std::string_view bytes_;
  std::string_view name_;
  std::size_t position_ = 0;
  std::size_t mark_ = 0;  ///< start of the last word or value, where errors point
  std::size_t end_;
  const char* part_ = "line";  ///< what ends at end_, if the file does not
  char comment_;
  bool binary_ = false;
  bool swap_ = false;
};

/// A word of the file as shown in messages: short, printable, in quotes.
std::string shown(std::string_view word);

template <class T>
T Cursor::raw(Item item) {
  if (remaining() < sizeof(T)) fail_truncated(item);
  mark_ = position_;
  char buffer[sizeof(T)];
  for (std::size_t k = 0; k < sizeof(T); ++k) buffer[swap_ ? sizeof(T) - 1 - k : k] = bytes_[position_ + k];
  position_ += sizeof(T);
  T value;
  std::memcpy(&value, buffer, sizeof(T));
  return value;
}

}  // namespace matstruct
