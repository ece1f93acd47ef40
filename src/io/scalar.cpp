#include "io/scalar.h"

#include <array>
#include <limits>

#include <fmt/format.h>

namespace matstruct {

namespace {

struct Name {
  std::string_view name;
  Scalar type;
};

constexpr std::array<Name, 27> kNames{{{"char", Scalar::kInt8},           {"int8", Scalar::kInt8},
                                       {"uchar", Scalar::kUint8},         {"uint8", Scalar::kUint8},
                                       {"unsigned_char", Scalar::kUint8}, {"short", Scalar::kInt16},
                                       {"int16", Scalar::kInt16},         {"ushort", Scalar::kUint16},
                                       {"uint16", Scalar::kUint16},       {"unsigned_short", Scalar::kUint16},
                                       {"int", Scalar::kInt32},           {"int32", Scalar::kInt32},
                                       {"uint", Scalar::kUint32},         {"uint32", Scalar::kUint32},
                                       {"unsigned_int", Scalar::kUint32}, {"long", Scalar::kInt64},
                                       {"int64", Scalar::kInt64},         {"vtktypeint64", Scalar::kInt64},
                                       {"vtkidtype", Scalar::kInt32},     {"unsigned_long", Scalar::kUint64},
                                       {"uint64", Scalar::kUint64},       {"vtktypeuint64", Scalar::kUint64},
                                       {"float", Scalar::kFloat},         {"float32", Scalar::kFloat},
                                       {"double", Scalar::kDouble},       {"float64", Scalar::kDouble},
                                       {"real", Scalar::kDouble}}};

}  // namespace

std::optional<Scalar> scalar_of(std::string_view name) {
  for (const Name& known : kNames)
    if (known.name == name) return known.type;
  return std::nullopt;
}

std::size_t size_of(Scalar type) {
  constexpr std::array<std::size_t, 10> kSizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::int64_t read_integer(Cursor& cursor, Scalar type, Item item) {
  if (!is_integer(type))
    cursor.fail(fmt::format("{} is given as a real number, not a whole one", item.text()), "export the file again");
  if (!cursor.binary()) return cursor.integer(item);
  switch (type) {
    case Scalar::kInt8:
      return cursor.raw<std::int8_t>(item);
    case Scalar::kUint8:
      return cursor.raw<std::uint8_t>(item);
    case Scalar::kInt16:
      return cursor.raw<std::int16_t>(item);
    case Scalar::kUint16:
      return cursor.raw<std::uint16_t>(item);
    case Scalar::kInt32:
      return cursor.raw<std::int32_t>(item);
    case Scalar::kUint32:
      return cursor.raw<std::uint32_t>(item);
    case Scalar::kInt64:
      return cursor.raw<std::int64_t>(item);
    default:
      return cursor.size(item);
  }
}

double read_real(Cursor& cursor, Scalar type, Item item) {
  if (!cursor.binary() || type == Scalar::kDouble) return cursor.real(item);
  if (type == Scalar::kFloat) return static_cast<double>(cursor.raw<float>(item));
  return static_cast<double>(read_integer(cursor, type, item));
}

}  // namespace matstruct
