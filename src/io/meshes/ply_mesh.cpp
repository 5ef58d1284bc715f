// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_cursor.hpp"
#include "io/meshes/polygon_soup.hpp"
#include "io/shared/byte_order.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct TypeName {
  std::string_view name;
  PlyType type;
};

constexpr std::array<TypeName, 16> type_names = {{{"char", PlyType::int8},
                                                  {"int8", PlyType::int8},
                                                  {"uchar", PlyType::uint8},
                                                  {"uint8", PlyType::uint8},
                                                  {"short", PlyType::int16},
                                                  {"int16", PlyType::int16},
                                                  {"ushort", PlyType::uint16},
                                                  {"uint16", PlyType::uint16},
                                                  {"int", PlyType::int32},
                                                  {"int32", PlyType::int32},
                                                  {"uint", PlyType::uint32},
                                                  {"uint32", PlyType::uint32},
                                                  {"float", PlyType::float32},
                                                  {"float32", PlyType::float32},
                                                  {"double", PlyType::float64},
                                                  {"float64", PlyType::float64}}};

/// Returns the type named "uchar", "float32" etc., if any.
std::optional<PlyType> ply_type_of(std::string_view word) {
  const auto found = std::find_if(type_names.begin(), type_names.end(),
                                  [&](const TypeName& known) { return known.name == word; });
  if (found == type_names.end()) return std::nullopt;
  return found->type;
}

std::vector<std::string_view> words_of_ply(std::string_view line) {
  constexpr std::string_view blanks = " \t\r";
  std::vector<std::string_view> words;
  for (std::size_t start = 0;
       (start = line.find_first_not_of(blanks, start)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, start), line.size());
    words.push_back(line.substr(start, end - start));
    start = end;
  }
  return words;
}

std::size_t ply_item_size(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 1;
}

/// Reads little-endian order.
double ply_number(const std::byte* item, PlyType type) {
  switch (type) {
    case PlyType::int8:
      return load_little_endian<std::int8_t>(item);
    case PlyType::uint8:
      return load_little_endian<std::uint8_t>(item);
    case PlyType::int16:
      return load_little_endian<std::int16_t>(item);
    case PlyType::uint16:
      return load_little_endian<std::uint16_t>(item);
    case PlyType::int32:
      return load_little_endian<std::int32_t>(item);
    case PlyType::uint32:
      return load_little_endian<std::uint32_t>(item);
    case PlyType::float32:
      return load_little_endian<float>(item);
    case PlyType::float64:
      return load_little_endian<double>(item);
  }
  return 0.0;
}

bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

bool is_index(double number) {
  return number >= -0x1p31 && number < 0x1p32 && number == std::floor(number);
}

enum class PlyFormat { ascii, little_endian, big_endian };

struct Property {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count;  ///< of the count of a list; none: not a list
};

struct Element {
  std::string name;
  std::uint64_t rows = 0;
  std::vector<Property> properties;
};

struct Header {
  std::optional<PlyFormat> format;
  std::vector<Element> elements;
};

class HeaderReader {
 public:
  explicit HeaderReader(ByteCursor& cursor) : cursor_(cursor) {}

  Header read() {
    if (next() != std::vector<std::string_view>{"ply"}) fail("expected 'ply' alone on the line");
    for (;;) {
      const auto words = next();
      const std::string_view key = words.empty() ? "" : words[0];
      if (key == "comment" || key == "obj_info") continue;
      if (key == "end_header") break;
      if (key == "format")
        header_.format = format(words);
      else if (key == "element")
        header_.elements.push_back(element(words));
      else if (key == "property" && !header_.elements.empty())
        header_.elements.back().properties.push_back(property(words));
      else
        fail("expected 'format', 'element', its 'property' lines, 'comment' or 'end_header'");
    }
    if (!header_.format) cursor_.fail("the header ends here; expected 'format' in it");
    for (const Element& element : header_.elements)
      if (element.properties.empty())
        cursor_.fail(fmt::format("the element {} has no properties", element.name));
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(std::string_view problem) const { cursor_.fail_at(start_, problem); }

  std::vector<std::string_view> next() {
    start_ = cursor_.position();
    return words_of_ply(cursor_.take_until('\n', "a header line"));
  }

  PlyFormat format(const std::vector<std::string_view>& words) const {
    if (words.size() == 3 && words[2] == "1.0") {
      if (words[1] == "ascii") return PlyFormat::ascii;
      if (words[1] == "binary_little_endian") return PlyFormat::little_endian;
      if (words[1] == "binary_big_endian") return PlyFormat::big_endian;
    }
    fail("expected 'format', one of ascii, binary_little_endian, binary_big_endian, and 1.0");
  }

  Element element(const std::vector<std::string_view>& words) const {
    if (words.size() != 3) fail("expected 'element', a name and a count");
    Element element{std::string(words[1]), 0, {}};
    for (const Element& other : header_.elements)
      if (other.name == element.name)
        fail(fmt::format("found a second element '{}'; expected each once", element.name));
    const char* end = words[2].data() + words[2].size();
    const auto result = std::from_chars(words[2].data(), end, element.rows);
    if (result.ec != std::errc() || result.ptr != end) fail("expected a count, an integer >= 0");
    if (element.rows > cursor_.rest().size())  // every row has at least one byte
      fail(fmt::format("found {} rows announced, but the file has only {} bytes more", element.rows,
                       cursor_.rest().size()));
    return element;
  }

  PlyType type(std::string_view word) const {
    if (const auto known = ply_type_of(word)) return *known;
    fail(
        fmt::format("found the type '{}'; expected char, uchar, short, ushort, int, uint, float "
                    "or double",
                    word));
  }

  Property property(const std::vector<std::string_view>& words) const {
    if (words.size() == 3) return {std::string(words[2]), type(words[1]), std::nullopt};
    if (words.size() != 5 || words[1] != "list")
      fail("expected 'property', a type and a name, or 'property list', two types and a name");
    const Property list{std::string(words[4]), type(words[3]), type(words[2])};
    if (!is_integer(*list.count)) fail("expected an integer type for the length of a list");
    return list;
  }

  ByteCursor& cursor_;
  Header header_;
  std::size_t start_ = 0;
};

class SoupFiller {
 public:
  /// @throws IoError if vertices have no positions
  SoupFiller(const Header& header, const ByteCursor& cursor) {
    for (const Element& element : header.elements) {
      if (element.name != "vertex") continue;
      const auto column = [&](std::initializer_list<std::string_view> names) {
        for (std::size_t p = 0; p < element.properties.size(); ++p)
          if (!element.properties[p].count &&
              std::ranges::find(names, element.properties[p].name) != names.end())
            return p;
        return none;
      };
      place_ = {column({"x"}), column({"y"}), column({"z"}), column({"u", "s", "texture_u"}),
                column({"v", "t", "texture_v"})};
    }
    if (std::ranges::find(place_.begin(), place_.begin() + 3, none) != place_.begin() + 3)
      cursor.fail("the header ends here; expected vertices with x, y and z in it");
  }

  void begin_row(const Element& element) {
    in_vertices_ = element.name == "vertex";
    in_faces_ = element.name == "face";
    if (!in_vertices_) return;
    soup_.positions.emplace_back();
    if (with_texture()) soup_.textures.emplace_back();
  }

  void take(const Property& property, std::size_t column, double number) {
    if (in_vertices_) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (place_[axis] == column) soup_.positions.back()[axis] = static_cast<float>(number);
      for (std::size_t axis = 0; axis < 2 && with_texture(); ++axis)
        if (place_[3 + axis] == column) soup_.textures.back()[axis] = static_cast<float>(number);
    } else if (in_faces_ && is_corner_list(property)) {
      soup_.position_of.push_back(static_cast<std::uint32_t>(static_cast<std::int64_t>(number)));
      soup_.texture_of.push_back(with_texture() ? soup_.position_of.back() : PolygonSoup::none);
    }
  }

  void end_list(const Property& property) {
    if (in_faces_ && is_corner_list(property)) soup_.face_end.push_back(soup_.position_of.size());
  }

  PolygonSoup soup() && { return std::move(soup_); }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  static bool is_corner_list(const Property& property) {
    return property.count && is_integer(property.type) &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
  }
  bool with_texture() const { return place_[3] != none && place_[4] != none; }

  std::array<std::size_t, 5> place_ = {none, none, none, none, none};  // x, y, z, u, v
  bool in_vertices_ = false, in_faces_ = false;
  PolygonSoup soup_;
};

double take_number(ByteCursor& cursor, PlyType type, bool big_endian, std::string_view what) {
  std::array<std::byte, 8> bytes{};
  const std::size_t size = ply_item_size(type);
  std::ranges::copy(cursor.take(size, what), bytes.begin());
  if (big_endian) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
  return ply_number(bytes.data(), type);
}

void read_binary_row(ByteCursor& cursor, const Element& element, bool big_endian,
                     SoupFiller& filler) {
  for (std::size_t column = 0; column < element.properties.size(); ++column) {
    const Property& property = element.properties[column];
    const std::size_t start = cursor.position();
    const double count =
        property.count ? take_number(cursor, *property.count, big_endian, "the length of a list")
                       : 1.0;
    if (count < 0) cursor.fail_at(start, "found a list of negative length");
    if (count > static_cast<double>(cursor.rest().size()))  // every item has at least one byte
      cursor.fail_at(start, fmt::format("found a list of {} numbers, but the file has only {} "
                                        "bytes more",
                                        count, cursor.rest().size()));
    for (double i = 0; i < count; ++i)
      filler.take(property, column, take_number(cursor, property.type, big_endian, element.name));
    filler.end_list(property);
  }
}

void read_text_row(ByteCursor& cursor, const Element& element, SoupFiller& filler) {
  const std::size_t start = cursor.position();
  if (cursor.at_end()) cursor.fail(fmt::format("the file ends here; expected {}", element.name));
  std::string_view text(reinterpret_cast<const char*>(cursor.rest().data()), cursor.rest().size());
  if (text.find('\n') == std::string_view::npos) {  // the last line may lack its newline
    text = cursor.take_text(text.size(), element.name);
  } else {
    text = cursor.take_until('\n', element.name);
  }
  const std::vector<std::string_view> words = words_of_ply(text);
  std::size_t next = 0;
  const auto take = [&](std::string_view what) {
    double number = 0.0;
    if (next >= words.size()) {
      ++next;
      return number;
    }
    const std::string_view word = words[next++];
    const auto result = std::from_chars(word.data(), word.data() + word.size(), number);
    if (result.ec != std::errc() || result.ptr != word.data() + word.size())
      cursor.fail_at(start, fmt::format("found '{}'; expected {}", word, what));
    return number;
  };
  for (std::size_t column = 0; column < element.properties.size(); ++column) {
    const Property& property = element.properties[column];
    double count = 1.0;
    if (property.count) {
      count = take("the length of a list");
      if (!(count >= 0.0 && count <= static_cast<double>(text.size())))
        cursor.fail_at(start, fmt::format("found the length {} of a list; expected as many values "
                                          "as the line has",
                                          count));
    }
    for (double i = 0; i < count; ++i) {
      const double number = take("a number");
      if (property.count && is_integer(property.type) && !is_index(number))
        cursor.fail_at(start, fmt::format("found {} in a list of whole numbers; expected a whole "
                                          "number that 32 bits hold",
                                          number));
      filler.take(property, column, number);
    }
    filler.end_list(property);
  }
  if (words.size() != next)
    cursor.fail_at(start, fmt::format("found {} values for one {}; expected {}", words.size(),
                                      element.name, next));
}

}  // namespace

PolygonSoup parse_ply_mesh(std::span<const std::byte> content, std::string_view file) {
  ByteCursor cursor(content, file);
  const Header header = HeaderReader(cursor).read();
  SoupFiller filler(header, cursor);
  for (const Element& element : header.elements)
    for (std::uint64_t row = 0; row < element.rows; ++row) {
      filler.begin_row(element);
      if (header.format == PlyFormat::ascii)
        read_text_row(cursor, element, filler);
      else
        read_binary_row(cursor, element, header.format == PlyFormat::big_endian, filler);
    }
  const auto is_blank = [](std::byte b) {
    return b == std::byte{'\n'} || b == std::byte{'\r'} || b == std::byte{' '};
  };
  if (!std::all_of(cursor.rest().begin(), cursor.rest().end(), is_blank))
    cursor.fail(fmt::format("found {} bytes more than the header announces", cursor.rest().size()));
  return std::move(filler).soup();
}

}  // namespace tofsmith
