// Gmsh .msh, versions 2.2 and 4.1, text and binary (Gmsh reference manual, "MSH file format"). The sections needed are
// $MeshFormat, $Nodes and $Elements; others are passed over.
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/cursor.h"
#include "io/mixed_mesh.h"
#include "io/parsers.h"

namespace matstruct {

namespace {

enum class Use { kSkip, kPolygon, kTetrahedron, kRefuse };

struct ElementType {
  const char* name;
  std::size_t nodes;
  Use use;
};

/// Indexed by Gmsh's number of the element type, from 1.
constexpr std::array<ElementType, 31> kElementTypes{{
    {"2-node line", 2, Use::kSkip},
    {"3-node triangle", 3, Use::kPolygon},
    {"4-node quadrangle", 4, Use::kPolygon},
    {"4-node tetrahedron", 4, Use::kTetrahedron},
    {"hexahedron", 8, Use::kRefuse},
    {"prism", 6, Use::kRefuse},
    {"pyramid", 5, Use::kRefuse},
    {"second-order line", 3, Use::kRefuse},
    {"second-order triangle", 6, Use::kRefuse},
    {"second-order quadrangle", 9, Use::kRefuse},
    {"second-order tetrahedron", 10, Use::kRefuse},
    {"second-order hexahedron", 27, Use::kRefuse},
    {"second-order prism", 18, Use::kRefuse},
    {"second-order pyramid", 14, Use::kRefuse},
    {"point", 1, Use::kSkip},
    {"second-order quadrangle", 8, Use::kRefuse},
    {"second-order hexahedron", 20, Use::kRefuse},
    {"second-order prism", 15, Use::kRefuse},
    {"second-order pyramid", 13, Use::kRefuse},
    {"third-order triangle", 9, Use::kRefuse},
    {"third-order triangle", 10, Use::kRefuse},
    {"fourth-order triangle", 12, Use::kRefuse},
    {"fourth-order triangle", 15, Use::kRefuse},
    {"fifth-order triangle", 15, Use::kRefuse},
    {"fifth-order triangle", 21, Use::kRefuse},
    {"third-order line", 4, Use::kRefuse},
    {"fourth-order line", 5, Use::kRefuse},
    {"fifth-order line", 6, Use::kRefuse},
    {"third-order tetrahedron", 20, Use::kRefuse},
    {"fourth-order tetrahedron", 35, Use::kRefuse},
    {"fifth-order tetrahedron", 56, Use::kRefuse},
}};

constexpr std::size_t kMostNodes = 4;  // of the element types that are not refused

/// The description of an element type that can be read; fails for the others.
const ElementType& element_type(std::int64_t type, const Cursor& cursor) {
  if (type < 1 || type > static_cast<std::int64_t>(kElementTypes.size()))
    cursor.fail(fmt::format("the element type {} is not known", type), "export first-order tetrahedra");
  const ElementType& known = kElementTypes[static_cast<std::size_t>(type - 1)];
  if (known.use == Use::kRefuse)
    cursor.fail(fmt::format("elements of type {} ({}) are not handled", type, known.name),
                "export a mesh of first-order tetrahedra");
  return known;
}

/// From the node tags of the file, which may have gaps, to indices.
class NodeTags {
 public:
  void reserve(std::size_t n) { order_.reserve(n); }
  void add(std::int64_t tag) { order_.emplace_back(tag, static_cast<Index>(order_.size())); }

  /// To be called when all are added; fails if two nodes have the same tag.
  void finish(const Cursor& cursor) {
    std::ranges::sort(order_);
    const auto equal = [](const auto& a, const auto& b) { return a.first == b.first; };
    const auto twice = std::ranges::adjacent_find(order_, equal);
    if (twice != order_.end())
      cursor.fail(fmt::format("two nodes have the number {}", twice->first), "export the file again");
  }

  Index index(std::int64_t tag, Item element, const Cursor& cursor) const {
    // Most files number their nodes without gaps. Unsigned, because the difference of two wild tags may overflow.
    const std::uint64_t least = order_.empty() ? 0 : static_cast<std::uint64_t>(order_.front().first);
    const std::uint64_t guess = static_cast<std::uint64_t>(tag) - least;
    if (guess < order_.size() && order_[guess].first == tag) return order_[guess].second;
    const auto found = std::ranges::lower_bound(order_, tag, {}, &std::pair<std::int64_t, Index>::first);
    if (found == order_.end() || found->first != tag)
      cursor.fail(fmt::format("{} refers to node {}, but the file has no node of that number (it has {} nodes)",
                              element.text(), tag, order_.size()),
                  "correct it or export the file again");
    return found->second;
  }

 private:
  std::vector<std::pair<std::int64_t, Index>> order_;
};

struct Reader {
  Cursor cursor;
  MixedMesh mesh;
  NodeTags tags;
  bool binary = false;
  std::endian order = std::endian::native;
  bool has_nodes = false, has_elements = false;

  /// Switches to the values of a section; the section's words are text always.
  void begin_values() {
    if (binary) cursor.set_binary(order);
  }
  void end_section(const char* end) {
    cursor.set_text();
    cursor.expect(end);
  }
  /// The least size of a record of `integers` 4-byte and `sizes` 8-byte values, in bytes.
  std::size_t least_bytes(std::size_t integers, std::size_t sizes) const {
    return binary ? 4 * integers + 8 * sizes : 2 * (integers + sizes);
  }

  void add_element(const ElementType& type, std::int64_t tag, bool sizes);
};

/// Reads the node tags of one element and adds it to the mesh. In 4.1 (`sizes`) tags take 8 bytes.
void Reader::add_element(const ElementType& type, std::int64_t tag, bool sizes) {
  const Item item{"element", tag};
  std::array<Index, kMostNodes> corners{};
  for (std::size_t k = 0; k < type.nodes; ++k)
    corners[k] = tags.index(sizes ? cursor.size(item) : cursor.integer(item), item, cursor);
  if (type.use == Use::kTetrahedron) add_tetrahedron(corners, item, cursor, mesh.tets);
  if (type.use == Use::kPolygon) add_polygon({corners.data(), type.nodes}, item, cursor, mesh.triangles);
}

// Version 2.2: the count is text also in binary files; values are 4-byte integers and doubles.

void read_nodes_2(Reader& in) {
  const std::int64_t announced = in.cursor.integer({"the number of nodes"});
  in.cursor.line();
  in.begin_values();
  const std::size_t n = in.cursor.check_count(announced, in.least_bytes(1, 3), "nodes");
  in.mesh.vertices.reserve(n);
  in.tags.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t tag = in.cursor.integer({"node"});
    in.tags.add(tag);
    in.mesh.vertices.push_back(in.cursor.point({"node", tag}));
  }
}

void read_elements_2_text(Reader& in, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t tag = in.cursor.integer({"element"});
    const ElementType& type = element_type(in.cursor.integer({"the type of element", tag}), in.cursor);
    const std::int64_t extra = in.cursor.integer({"the number of tags of element", tag});
    const std::size_t tags = in.cursor.check_count(extra, in.least_bytes(1, 0), "element tags");
    for (std::size_t k = 0; k < tags; ++k) in.cursor.integer({"the tags of element", tag});
    in.add_element(type, tag, false);
  }
}

/// Binary elements come in blocks of one type.
void read_elements_2_binary(Reader& in, std::size_t n) {
  for (std::size_t done = 0; done < n;) {
    const ElementType& type = element_type(in.cursor.integer({"an element type"}), in.cursor);
    const std::int64_t block = in.cursor.integer({"an element block"});
    const std::int64_t extra = in.cursor.integer({"an element block"});
    const std::size_t tags = in.cursor.check_count(extra, 4, "element tags");
    const std::size_t size = in.cursor.check_count(block, 4 * (1 + tags + type.nodes), "elements");
    if (size == 0 || size > n - done)
      in.cursor.fail(fmt::format("a block of {} elements does not fit the {} announced", size, n),
                     "the file is damaged, export it again");
    for (std::size_t i = 0; i < size; ++i) {
      const std::int64_t tag = in.cursor.integer({"element"});
      in.cursor.skip(4 * tags, {"element", tag});
      in.add_element(type, tag, false);
    }
    done += size;
  }
}

void read_elements_2(Reader& in) {
  const std::int64_t announced = in.cursor.integer({"the number of elements"});
  in.cursor.line();
  in.begin_values();
  const std::size_t n = in.cursor.check_count(announced, in.least_bytes(2, 0), "elements");
  in.binary ? read_elements_2_binary(in, n) : read_elements_2_text(in, n);
}

// Version 4.1: nodes and elements come in blocks, one per entity of the geometry; counts and tags take 8 bytes.

struct BlockCounts {
  std::size_t blocks;
  std::size_t total;
};

BlockCounts read_block_counts(Reader& in, const char* plural) {
  in.cursor.line();
  in.begin_values();
  const std::int64_t blocks = in.cursor.size({"the number of blocks"});
  const std::int64_t total = in.cursor.size({"the number of elements or nodes"});
  in.cursor.size({"the least tag"});
  in.cursor.size({"the greatest tag"});
  return {in.cursor.check_count(blocks, in.least_bytes(3, 1), "blocks"),
          in.cursor.check_count(total, in.least_bytes(0, 2), plural)};
}

/// The size of a block of `left` things still to come.
std::size_t read_block_size(Reader& in, std::size_t bytes_each, std::size_t left, const char* plural) {
  const std::size_t n = in.cursor.check_count(in.cursor.size({"the size of a block"}), bytes_each, plural);
  if (n > left)
    in.cursor.fail(fmt::format("a block has {} {}, more than the {} still announced", n, plural, left),
                   "the file is damaged, export it again");
  return n;
}

void check_all_came(const Reader& in, std::size_t left, const char* plural) {
  if (left > 0)
    in.cursor.fail(fmt::format("the blocks hold {} {} fewer than announced", left, plural),
                   "the file is damaged, export it again");
}

void read_nodes_4(Reader& in) {
  const auto [blocks, total] = read_block_counts(in, "nodes");
  in.mesh.vertices.reserve(total);
  in.tags.reserve(total);
  std::size_t left = total;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::int64_t dimension = in.cursor.integer({"the dimension of a node block"});
    in.cursor.integer({"the entity of a node block"});
    const std::int64_t parametric = in.cursor.integer({"the parametric flag of a node block"});
    if (dimension < 0 || dimension > 3 || parametric < 0 || parametric > 1)
      in.cursor.fail("a node block has an impossible header", "the file is damaged, export it again");
    const auto parameters = static_cast<std::size_t>(parametric * dimension);
    const std::size_t n = read_block_size(in, in.least_bytes(0, 4 + parameters), left, "nodes");
    std::vector<std::int64_t> tags(n);
    for (std::int64_t& tag : tags) in.tags.add(tag = in.cursor.size({"a node number"}));
    for (const std::int64_t tag : tags) {
      in.mesh.vertices.push_back(in.cursor.point({"node", tag}));
      for (std::size_t k = 0; k < parameters; ++k) in.cursor.real({"the parameters of node", tag});
    }
    left -= n;
  }
  check_all_came(in, left, "nodes");
}

void read_elements_4(Reader& in) {
  const auto [blocks, total] = read_block_counts(in, "elements");
  std::size_t left = total;
  for (std::size_t b = 0; b < blocks; ++b) {
    in.cursor.integer({"the dimension of an element block"});
    in.cursor.integer({"the entity of an element block"});
    const ElementType& type = element_type(in.cursor.integer({"an element type"}), in.cursor);
    const std::size_t n = read_block_size(in, in.least_bytes(0, 1 + type.nodes), left, "elements");
    for (std::size_t i = 0; i < n; ++i) in.add_element(type, in.cursor.size({"an element number"}), true);
    left -= n;
  }
  check_all_came(in, left, "elements");
}

/// Returns true for version 4.1, false for 2.x.
bool read_format(Reader& in) {
  Cursor& cursor = in.cursor;
  if (!cursor.accept("$MeshFormat"))
    cursor.fail(
        "the file does not begin with $MeshFormat, so it is not a Gmsh mesh (version 1 and .msh files of other "
        "programs are not read)",
        "save it from Gmsh as version 4.1 or 2.2");
  const std::string_view version = cursor.word({"the format version"});
  const bool is_2 = version == "2" || version.substr(0, 2) == "2.";
  if (!is_2 && version != "4.1")
    cursor.fail(fmt::format("version {} of the Gmsh format is not handled", shown(version)),
                "save it as version 4.1 or 2.2");
  const std::int64_t type = cursor.integer({"the file type"});
  if (type != 0 && type != 1)
    cursor.fail(fmt::format("the file type is {}, neither 0 (text) nor 1 (binary)", type), "export it again");
  in.binary = type == 1;
  const std::int64_t width = cursor.integer({"the data size"});
  if (in.binary && width != 8)
    cursor.fail(fmt::format("binary values of {} bytes are not handled", width), "save it with 8-byte values");
  cursor.line();
  if (in.binary) {
    cursor.set_binary(std::endian::native);
    const auto one = cursor.raw<std::uint32_t>({"the byte order mark"});
    if (one != 1 && one != 0x01000000)
      cursor.fail("the byte order mark is neither 1 nor 1 swapped", "the file is damaged, export it again");
    const bool little = std::endian::native == std::endian::little;
    in.order = (one == 1) == little ? std::endian::little : std::endian::big;
  }
  in.end_section("$EndMeshFormat");
  return !is_2;
}

void read_section(Reader& in, std::string_view section, bool is_4) {
  if (section == "$Nodes") {
    if (in.has_nodes) in.cursor.fail("there is a second section of nodes", "export the file again");
    in.has_nodes = true;
    is_4 ? read_nodes_4(in) : read_nodes_2(in);
    in.tags.finish(in.cursor);
    in.end_section("$EndNodes");
  } else if (section == "$Elements") {
    if (!in.has_nodes) in.cursor.fail("the elements come before the nodes", "export the file again");
    in.has_elements = true;
    is_4 ? read_elements_4(in) : read_elements_2(in);
    in.end_section("$EndElements");
  } else if (section.size() > 1 && section[0] == '$') {
    in.cursor.skip_past(fmt::format("$End{}", section.substr(1)));
  } else {
    in.cursor.fail(fmt::format("expected a section such as $Nodes but found {}", shown(section)),
                   "correct it or export the file again");
  }
}

}  // namespace

Model parse_msh(std::string_view bytes, const std::string& name) {
  Reader in{.cursor = Cursor(bytes, name), .mesh = {}, .tags = {}};
  const bool is_4 = read_format(in);
  while (!in.cursor.at_end()) read_section(in, in.cursor.word({"a section"}), is_4);
  if (!in.has_nodes) in.cursor.fail("the file has no $Nodes section", "it may be truncated, export it again");
  if (!in.has_elements) in.cursor.fail("the file has no $Elements section", "it may be truncated, export it again");
  return solid_or_surface(std::move(in.mesh), name);
}

}  // namespace matstruct
