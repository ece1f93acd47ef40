#include "io/cursor.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

#include <fmt/format.h>

#include <matstruct/error.h>

namespace matstruct {

namespace {

constexpr const char* kExportAgain = "correct it or export the file again";

bool same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return lower_case(x) == lower_case(y); });
}

/// std::from_chars says "out of range" both for 1e999 and for 1e-999; a stream tells them apart: infinity and 0.
double beyond_range(std::string_view word) {
  std::istringstream in{std::string(word)};
  in.imbue(std::locale::classic());
  double value = 0;
  in >> value;
  return in ? value : std::copysign(std::numeric_limits<double>::infinity(), value);
}

/// Number words may begin with '+', which std::from_chars does not take.
std::string_view without_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

}  // namespace

std::string Item::text() const {
  return id < 0 ? std::string(kind) : fmt::format("{} {}", kind, id);
}

std::string shown(std::string_view word) {
  constexpr std::size_t kShown = 40;
  std::string text;
  for (const char c : word.substr(0, kShown)) text += c >= ' ' && c <= '~' ? c : '?';
  return fmt::format("'{}{}'", text, word.size() > kShown ? "..." : "");
}

void Cursor::set_binary(std::endian order) {
  binary_ = true;
  swap_ = order != std::endian::native;
}

void Cursor::skip_blanks() {
  while (position_ < end_) {
    if (is_blank(bytes_[position_])) {
      ++position_;
    } else if (comment_ != '\0' && bytes_[position_] == comment_) {
      position_ = std::min(bytes_.find('\n', position_), end_);
    } else {
      return;
    }
  }
}

std::size_t Cursor::word_end() const {
  std::size_t end = position_;
  while (end < end_ && !is_blank(bytes_[end]) && (comment_ == '\0' || bytes_[end] != comment_)) ++end;
  return end;
}

bool Cursor::at_end() {
  skip_blanks();
  return position_ == end_;
}

std::string_view Cursor::peek() {
  skip_blanks();
  return bytes_.substr(position_, word_end() - position_);
}

std::string_view Cursor::word(Item item) {
  const std::string_view found = peek();
  if (found.empty()) fail_truncated(item);
  mark_ = position_;
  position_ += found.size();
  return found;
}

bool Cursor::accept(std::string_view keyword) {
  const std::string_view found = peek();
  if (!same_word(found, keyword)) return false;
  mark_ = position_;
  position_ += found.size();
  return true;
}

void Cursor::expect(std::string_view keyword) {
  if (accept(keyword)) return;
  const std::string_view found = peek();
  mark_ = position_;
  if (found.empty())
    fail(fmt::format("the file ends where '{}' is expected: it is truncated", keyword), "copy or export it again");
  fail(fmt::format("expected '{}' but found {}", keyword, shown(found)), kExportAgain);
}

Cursor Cursor::line() {
  Cursor line = *this;
  const std::size_t newline = std::min(bytes_.find('\n', position_), end_);
  line.end_ = newline;
  line.mark_ = position_;
  mark_ = position_;
  position_ = std::min(newline + 1, end_);
  return line;
}

Cursor Cursor::within(std::size_t begin, std::size_t end, const char* part) const {
  Cursor inner = *this;
  inner.position_ = begin;
  inner.mark_ = begin;
  inner.end_ = end;
  inner.part_ = part;
  return inner;
}

void Cursor::skip(std::size_t n, Item item) {
  if (remaining() < n) fail_truncated(item);
  mark_ = position_;
  position_ += n;
}

void Cursor::skip_past(std::string_view text) {
  const std::size_t found = bytes_.substr(0, end_).find(text, position_);
  if (found == std::string_view::npos)
    fail(fmt::format("the file ends without '{}': it is truncated", text), "copy or export it again");
  position_ = found + text.size();
}

std::int64_t Cursor::integer(Item item) {
  return binary_ ? raw<std::int32_t>(item) : text_integer(item);
}

std::int64_t Cursor::size(Item item) {
  if (!binary_) return text_integer(item);
  const auto value = raw<std::uint64_t>(item);
  if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    fail(fmt::format("{} is {}, which is too large", item.text(), value), "the file is damaged, export it again");
  return static_cast<std::int64_t>(value);
}

double Cursor::real(Item item) {
  return binary_ ? raw<double>(item) : text_real(item);
}

Vec3 Cursor::point(Item item) {
  Vec3 p;
  for (int k = 0; k < 3; ++k) p[k] = real(item);
  check_finite(p, item);
  return p;
}

std::int64_t Cursor::text_integer(Item item) {
  const std::string_view found = word(item);
  const std::string_view digits = without_plus(found);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size())
    fail(fmt::format("expected a whole number for {} but found {}", item.text(), shown(found)), kExportAgain);
  return value;
}

double Cursor::text_real(Item item) {
  const std::string_view found = word(item);
  const std::string_view digits = without_plus(found);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::invalid_argument || end != digits.data() + digits.size())
    fail(fmt::format("expected a number for {} but found {}", item.text(), shown(found)), kExportAgain);
  return error == std::errc::result_out_of_range ? beyond_range(digits) : value;
}

std::size_t Cursor::check_count(std::int64_t n, std::size_t bytes_each, const char* plural) const {
  if (n < 0) fail(fmt::format("the number of {} is {}", plural, n), "the file is damaged, export it again");
  if (n > std::numeric_limits<Index>::max())
    fail(fmt::format("{} {} are more than the {} that can be handled", n, plural, std::numeric_limits<Index>::max()),
         "simplify the model");
  // The last number of a text file needs no blank after it, hence one byte more.
  if (static_cast<std::size_t>(n) > (remaining() + 1) / bytes_each)
    fail(fmt::format("{} {} are announced but only {} bytes follow", n, plural, remaining()),
         "the file is truncated or damaged, copy or export it again");
  return static_cast<std::size_t>(n);
}

Index Cursor::check_index(std::int64_t i, std::size_t n, std::int64_t first, Item item, const char* part) const {
  if (i < first || i - first >= static_cast<std::int64_t>(n))
    fail(fmt::format("{} refers to vertex {}, but the {} has {} vertices, numbered from {}", item.text(), i, part, n,
                     first),
         kExportAgain);
  return static_cast<Index>(i - first);
}

void Cursor::check_finite(const Vec3& p, Item item) const {
  for (int k = 0; k < 3; ++k)
    if (!std::isfinite(p[k]))
      fail(fmt::format("the {} coordinate of {} is {}, not a finite number", "xyz"[k], item.text(), p[k]),
           kExportAgain);
}

void Cursor::fail(const std::string& problem, const std::string& remedy) const {
  const auto lines = std::ranges::count(bytes_.substr(0, mark_), '\n');
  const std::string place = binary_ ? fmt::format("byte {}", mark_) : fmt::format("line {}", lines + 1);
  throw Error(fmt::format("{}, {}: {}; {}.", name_, place, problem, remedy));
}

void Cursor::fail_truncated(Item item) const {
  Cursor here = *this;
  here.mark_ = position_;
  if (end_ < bytes_.size())
    here.fail(fmt::format("the {} ends before {} is complete", part_, item.text()), kExportAgain);
  here.fail(fmt::format("the file ends before {} is complete: it is truncated", item.text()),
            "copy or export it again");
}

}  // namespace matstruct
