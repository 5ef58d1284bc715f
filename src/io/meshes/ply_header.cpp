// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/meshes/ply_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "io/shared/byte_order.hpp"

namespace tofsmith {
namespace {

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

constexpr std::size_t max_properties = 256;

std::string_view take_line(ByteCursor& cursor) {
  std::string_view line = cursor.take_until('\n', "a header line");
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

using Words = std::vector<std::string_view>;

bool is_ascii(const ByteCursor& cursor, std::size_t start, const Words& words) {
  if (words.size() != 3 || words[2] != "1.0" ||
      (words[1] != "ascii" && words[1] != "binary_little_endian"))
    cursor.fail_at(start, "expected 'format ascii 1.0' or 'format binary_little_endian 1.0'");
  return words[1] == "ascii";
}

std::size_t vertex_count(const ByteCursor& cursor, std::size_t start, const Words& words) {
  if (words.size() != 3 || words[1] != "vertex")
    cursor.fail_at(start, "expected 'element vertex' and a count, and no other element");
  std::size_t count = 0;
  const char* end = words[2].data() + words[2].size();
  const auto result = std::from_chars(words[2].data(), end, count);
  if (result.ec != std::errc() || result.ptr != end)
    cursor.fail_at(start, "expected a count of vertices, an integer >= 0");
  return count;
}

PlyProperty property(const ByteCursor& cursor, std::size_t start, const Words& words) {
  if (words.size() > 1 && words[1] == "list")
    cursor.fail_at(start, "found a list; expected points with one number per property");
  if (words.size() != 3) cursor.fail_at(start, "expected 'property', a type and a name");
  const auto type = ply_type_of(words[1]);
  if (!type)
    cursor.fail_at(start,
                   "expected one of the types char, uchar, short, ushort, int, uint, float, "
                   "double");
  return {std::string(words[2]), *type};
}

}  // namespace

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

std::vector<std::string_view> words_of_ply_line(ByteCursor& cursor) {
  return words_of_ply(take_line(cursor));
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

std::size_t PlyHeader::row_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties) bytes += ply_item_size(property.type);
  return bytes;
}

PlyHeader parse_ply_header(ByteCursor& cursor) {
  if (cursor.rest().size() >= 3 && cursor.take_text(3, "the PLY magic") != "ply")
    cursor.fail_at(0, "found no PLY magic; expected a PLY file");
  if (!take_line(cursor).empty()) cursor.fail_at(0, "expected 'ply' alone on the first line");

  PlyHeader header;
  bool has_format = false, has_vertices = false;
  for (;;) {
    const std::size_t start = cursor.position();
    const Words words = words_of_ply_line(cursor);
    const std::string_view key = words.empty() ? "" : words[0];
    if (key == "comment" || key == "obj_info") continue;
    if (key == "end_header") break;
    if (key == "format" && !has_format) {
      header.ascii = is_ascii(cursor, start, words);
      has_format = true;
    } else if (key == "element" && !has_vertices) {
      header.vertices = vertex_count(cursor, start, words);
      has_vertices = true;
    } else if (key == "element") {
      cursor.fail_at(start, "found a second element; expected vertices only");
    } else if (key == "property" && has_vertices) {
      header.properties.push_back(property(cursor, start, words));
      if (header.properties.size() > max_properties)
        cursor.fail_at(start, fmt::format("expected at most {} properties", max_properties));
    } else {
      cursor.fail_at(start,
                     "expected one 'format', one 'element vertex', its 'property' lines, "
                     "'comment' or 'end_header'");
    }
  }
  if (!has_format || !has_vertices)
    cursor.fail("the header ends here; expected 'format' and 'element vertex' in it");
  return header;
}

}  // namespace tofsmith
