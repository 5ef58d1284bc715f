// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <vector>

#include "io/meshes/mesh_checks.hpp"
#include "io/meshes/ply_header.hpp"
#include "io/shared/byte_cursor.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

enum class PlyFormat { ascii, little_endian, big_endian };

struct Property {
  PlyType type = PlyType::float32;
  std::optional<PlyType> count;  ///< of a list
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

/// The header of a PLY file with any elements and lists, line by line.
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
    return words_of_ply_line(cursor_);
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
    if (element.rows > cursor_.rest().size())  // every row takes a byte or more
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
    if (words.size() == 3) return {type(words[1]), std::nullopt};
    if (words.size() != 5 || words[1] != "list")
      fail("expected 'property', a type and a name, or 'property list', two types and a name");
    const Property list{type(words[3]), type(words[2])};
    if (!is_integer(*list.count)) fail("expected an integer type for the length of a list");
    return list;
  }

  ByteCursor& cursor_;
  Header header_;
  std::size_t start_ = 0;
};

/// The length of a list in a binary file.
std::int64_t take_count(ByteCursor& cursor, PlyType type, PlyFormat format) {
  const auto bytes = cursor.take(ply_item_size(type), "the length of a list");
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::size_t at = format == PlyFormat::little_endian ? bytes.size() - 1 - i : i;
    value = value << 8 | std::to_integer<std::uint64_t>(bytes[at]);
  }
  const bool is_signed = type == PlyType::int8 || type == PlyType::int16 || type == PlyType::int32;
  if (is_signed && value >> (8 * bytes.size() - 1)) return -1;
  return static_cast<std::int64_t>(value);
}

void walk_binary_row(ByteCursor& cursor, const Element& element, PlyFormat format) {
  for (const Property& property : element.properties) {
    const std::size_t start = cursor.position();
    const std::int64_t count = property.count ? take_count(cursor, *property.count, format) : 1;
    if (count < 0) cursor.fail_at(start, "found a list of negative length");
    cursor.take(static_cast<std::size_t>(count) * ply_item_size(property.type), element.name);
  }
}

void walk_text_row(ByteCursor& cursor, const Element& element) {
  const std::size_t start = cursor.position();
  if (cursor.at_end()) cursor.fail(fmt::format("the file ends here; expected {}", element.name));
  std::string_view text(reinterpret_cast<const char*>(cursor.rest().data()), cursor.rest().size());
  if (text.find('\n') == std::string_view::npos) {  // the last line may do without its end
    text = cursor.take_text(text.size(), element.name);
  } else {
    text = cursor.take_until('\n', element.name);
  }
  const std::vector<std::string_view> words = words_of_ply(text);
  std::uint64_t expected = 0;
  for (const Property& property : element.properties) {
    if (!property.count) {
      ++expected;
      continue;
    }
    std::uint32_t count = 0;
    if (expected < words.size()) {
      const std::string_view word = words[expected];
      const auto result = std::from_chars(word.data(), word.data() + word.size(), count);
      if (result.ec != std::errc() || result.ptr != word.data() + word.size())
        cursor.fail_at(start, fmt::format("found '{}'; expected the length of a list", word));
    }
    expected += 1 + count;
  }
  if (words.size() != expected)
    cursor.fail_at(start, fmt::format("found {} values for one {}; expected {}", words.size(),
                                      element.name, expected));
}

}  // namespace

void check_ply(std::span<const std::byte> content, std::string_view file) {
  ByteCursor cursor(content, file);
  const Header header = HeaderReader(cursor).read();
  for (const Element& element : header.elements)
    for (std::uint64_t row = 0; row < element.rows; ++row)
      if (header.format == PlyFormat::ascii)
        walk_text_row(cursor, element);
      else
        walk_binary_row(cursor, element, *header.format);
  const auto is_blank = [](std::byte b) {
    return b == std::byte{'\n'} || b == std::byte{'\r'} || b == std::byte{' '};
  };
  if (!std::all_of(cursor.rest().begin(), cursor.rest().end(), is_blank))
    cursor.fail(fmt::format("found {} bytes more than the header announces", cursor.rest().size()));
}

}  // namespace tofsmith
