#include "io/vtk_arrays.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <vector>

#include <fmt/format.h>
#include <zlib.h>

#include "io/scalar.h"

namespace matstruct {

namespace {

/// 0 to 63, or -1.
int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// The bytes stored, taken from front to back.
class Source {
 public:
  Source(VtkStored stored, std::string_view name, const Cursor& cursor)
      : stored_(stored), name_(name), cursor_(cursor) {}

  /// The next `n` bytes; `what` they are, for messages.
  std::string take(std::size_t n, const char* what) {
    // A bound for base64, too, before anything is allocated: four characters are three bytes.
    if (n > most_left())
      fail(fmt::format("has {} of {} bytes, but only {} are stored", what, n, most_left()), kDamaged);
    if (!stored_.base64) {
      position_ += n;
      return std::string(stored_.bytes.substr(position_ - n, n));
    }
    std::string bytes;
    bytes.reserve(n);
    while (bytes.size() < n) {
      if (pending_.empty() && !decode_group())
        fail(fmt::format("has {} of {} bytes, but only {} are stored", what, n, bytes.size()), kDamaged);
      const std::size_t taken = std::min(pending_.size(), n - bytes.size());
      bytes += pending_.substr(0, taken);
      pending_.remove_prefix(taken);
    }
    return bytes;
  }

  /// An upper bound of the bytes left.
  std::size_t most_left() const {
    const std::size_t left = stored_.bytes.size() - position_;
    return stored_.base64 ? left / 4 * 3 + pending_.size() : left;
  }

  bool at_end() {
    if (!stored_.base64) return position_ == stored_.bytes.size();
    return pending_.empty() && !decode_group();
  }

  [[noreturn]] void fail(const std::string& problem, const char* remedy) const {
    cursor_.fail(fmt::format("the array {} {}", shown(name_), problem), remedy);
  }

 private:
  bool next_character(char& c) {
    while (position_ < stored_.bytes.size() && is_blank(stored_.bytes[position_])) ++position_;
    if (position_ == stored_.bytes.size()) return false;
    c = stored_.bytes[position_++];
    return true;
  }

  /// Four characters become three bytes, or fewer if they end with '='. That may happen in the middle, since writers
  /// encode the lengths by themselves. False at the end.
  bool decode_group() {
    std::uint32_t bits = 0;
    std::size_t digits = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      char c = '\0';
      if (!next_character(c)) {
        if (k == 0) return false;
        fail("ends within a group of four base64 characters", kDamaged);
      }
      const int digit = base64_digit(c);
      if (digit < 0 && (c != '=' || k < 2))
        fail(fmt::format("has the character {} in its base64 data", shown({&c, 1})), kDamaged);
      if (digit >= 0 && digits < k) fail("has a base64 character behind '='", kDamaged);
      if (digit >= 0) ++digits;
      bits = bits << 6 | static_cast<std::uint32_t>(std::max(digit, 0));
    }
    for (std::size_t k = 0; k < 3; ++k) group_[k] = static_cast<char>(bits >> (16 - 8 * k) & 0xff);
    pending_ = std::string_view(group_.data(), digits - 1);
    return true;
  }

  VtkStored stored_;
  std::string_view name_;
  const Cursor& cursor_;
  std::size_t position_ = 0;
  std::array<char, 3> group_{};
  std::string_view pending_;  ///< decoded but not taken, a part of group_
};

/// The lengths that come before the data.
std::vector<std::size_t> take_sizes(Source& source, std::size_t n, const VtkStorage& storage) {
  const Scalar type = storage.long_sizes ? Scalar::kUint64 : Scalar::kUint32;
  const std::string bytes = source.take(n * size_of(type), "a header");
  std::vector<std::size_t> sizes;
  for (std::size_t i = 0; i < n; ++i) {
    std::uint64_t size = 0;
    for (std::size_t k = 0; k < size_of(type); ++k) {
      const std::size_t byte = storage.order == std::endian::big ? k : size_of(type) - 1 - k;
      size = size << 8 | static_cast<unsigned char>(bytes[i * size_of(type) + byte]);
    }
    sizes.push_back(size);
  }
  return sizes;
}

void check_length(const Source& source, std::size_t stored, std::size_t needed) {
  if (stored != needed)
    source.fail(fmt::format("has {} bytes where its values take {}", stored, needed), "export the file again");
}

struct Block {
  std::size_t stored = 0, inflated = 0;  ///< bytes
};

/// The table: number of blocks, size of a block, size of the last one if it is shorter (else 0), then the deflated size
/// of each. No more blocks, and no longer ones, are accepted than `n` bytes need: arrays may be named many times, so
/// that their cost has to be bounded by what is announced, not by the file.
std::vector<Block> take_table(Source& source, const VtkStorage& storage, std::size_t n) {
  const std::vector<std::size_t> head = take_sizes(source, 3, storage);
  const std::size_t blocks = head[0], size = head[1], last = head[2];
  const std::size_t full = blocks - (last == 0 ? 0 : 1);
  // Division, since the product of what the file says may overflow.
  const bool fits = blocks > 0 && last <= n &&
                    (full == 0 ? last == n : size > 0 && (n - last) % size == 0 && (n - last) / size == full);
  if (!fits)
    source.fail(fmt::format("has {} blocks of {} bytes (the last of {}) where its values take {} bytes", blocks, size,
                            last == 0 ? size : last, n),
                "export the file again");
  if (n / kMostInflation > source.most_left() || blocks > source.most_left())
    source.fail(
        fmt::format("has {} blocks of {} bytes in all, but only {} bytes are stored", blocks, n, source.most_left()),
        kDamaged);
  const std::vector<std::size_t> stored = take_sizes(source, blocks, storage);
  std::vector<Block> table;
  for (std::size_t b = 0; b < blocks; ++b) {
    table.push_back({stored[b], b < full ? size : last});
    constexpr std::size_t kOverhead = 1000;  // zlib itself adds a few bytes to what it cannot make shorter
    if (stored[b] / 2 > table[b].inflated + kOverhead)
      source.fail(
          fmt::format("has a block {} of {} bytes, said to take {} when deflated", b, table[b].inflated, stored[b]),
          kDamaged);
  }
  return table;
}

std::string inflate_blocks(Source& source, const VtkStorage& storage, std::size_t n) {
  const std::vector<Block> table = take_table(source, storage, n);
  std::string values(n, '\0');
  std::size_t done = 0;
  for (std::size_t b = 0; b < table.size(); ++b) {
    const std::string block = source.take(table[b].stored, "a deflated block");
    uLongf inflated = table[b].inflated;  // zlib writes no more than this
    const int status = uncompress(reinterpret_cast<Bytef*>(values.data() + done), &inflated,
                                  reinterpret_cast<const Bytef*>(block.data()), block.size());
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    if (status != Z_OK || inflated != table[b].inflated)
      source.fail(fmt::format("has a block {} that zlib cannot inflate to {} bytes", b, table[b].inflated), kDamaged);
    done += inflated;
  }
  return values;
}

}  // namespace

std::string decode_vtk_array(VtkStored stored, const VtkStorage& storage, std::size_t n, std::string_view name,
                             const Cursor& cursor) {
  Source source(stored, name, cursor);
  std::string values;
  if (storage.deflated) {
    values = inflate_blocks(source, storage, n);
  } else {
    check_length(source, take_sizes(source, 1, storage)[0], n);
    values = source.take(n, "data");
  }
  if (stored.alone && !source.at_end()) source.fail("goes on behind its announced length", "export the file again");
  return values;
}

}  // namespace matstruct
