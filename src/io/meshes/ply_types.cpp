// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/meshes/ply_types.hpp"

#include <algorithm>
#include <array>

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

std::string_view take_line(ByteCursor& cursor) {
  std::string_view line = cursor.take_until('\n', "a header line");
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
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

}  // namespace tofsmith
