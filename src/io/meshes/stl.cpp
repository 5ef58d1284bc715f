// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>

#include "core/shared/text_numbers.hpp"
#include "io/byte_cursor.hpp"
#include "io/meshes/polygon_soup.hpp"
#include "io/shared/byte_order.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

constexpr std::size_t header_bytes = 84, triangle_bytes = 50;

void add_corner(const std::array<float, 3>& position, PolygonSoup& soup) {
  soup.position_of.push_back(static_cast<std::uint32_t>(soup.positions.size()));
  soup.texture_of.push_back(PolygonSoup::none);
  soup.positions.push_back(position);
}

PolygonSoup read_binary(std::span<const std::byte> content) {
  PolygonSoup soup;
  for (std::size_t at = header_bytes; at < content.size(); at += triangle_bytes) {
    constexpr std::size_t normal_bytes = 12;
    const std::byte* from = content.data() + at + normal_bytes;
    for (int corner = 0; corner < 3; ++corner) {
      std::array<float, 3> position;
      for (float& number : position) {
        number = load_little_endian<float>(from);
        from += sizeof(float);
      }
      add_corner(position, soup);
    }
    soup.face_end.push_back(soup.position_of.size());
  }
  return soup;
}

class TextReader {
 public:
  TextReader(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  PolygonSoup read() {
    bool ended = false;
    for (std::string_view text = text_; !text.empty();) {
      ++line_;
      std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(text.size(), line.size() + 1));
      std::string key(next_word(line));
      std::ranges::transform(key, key.begin(), lower_case);
      if (key == "vertex") read_vertex(line);
      if (key == "endloop") end_face();
      if (corners_ > 0 && (key == "outer" || key == "endfacet" || key == "endsolid"))
        fail(fmt::format("found '{}'; expected endloop", key));
      if (key == "endsolid") ended = true;
      if (key == "facet") ended = false;
      constexpr std::string_view known[] = {"",        "solid",    "facet",    "outer",
                                            "endloop", "endfacet", "endsolid", "vertex"};
      if (std::ranges::find(known, key) == std::end(known))
        fail(
            fmt::format("found '{}'; expected facet, outer loop, vertex, endloop, endfacet or "
                        "endsolid",
                        key.substr(0, 40)));
    }
    if (!ended)
      throw IoError(file_,
                    fmt::format("byte {}: the file ends here; expected endsolid", text_.size()));
    return std::move(soup_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw IoError(fmt::format("{}:{}", file_, line_), problem);
  }

  void read_vertex(std::string_view rest) {
    std::array<float, 3> position{};
    for (float& number : position) {
      const std::string_view word = next_word(rest);
      std::string_view digits = word;
      if (digits.starts_with('+')) digits.remove_prefix(1);
      double value = 0.0;
      const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
      if (result.ec != std::errc() || result.ptr != digits.data() + digits.size())
        fail(fmt::format("found the coordinate '{}'; expected a number", word));
      number = static_cast<float>(value);
    }
    add_corner(position, soup_);
    ++corners_;
  }

  void end_face() {
    if (corners_ < 3) fail(fmt::format("found a loop of {} corners; expected 3", corners_));
    soup_.face_end.push_back(soup_.position_of.size());
    corners_ = 0;
  }

  std::string_view text_;
  std::string file_;
  int line_ = 0;
  int corners_ = 0;
  PolygonSoup soup_;
};

}  // namespace

PolygonSoup parse_stl(std::span<const std::byte> content, std::string_view file) {
  const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
  const bool may_be_text = text.starts_with("solid");
  if (content.size() >= header_bytes) {
    ByteCursor cursor(content, file);
    cursor.take(header_bytes - 4, "the header");
    const std::uint64_t triangles = cursor.take_u32_little("the count of triangles");
    const std::uint64_t expected = header_bytes + triangle_bytes * triangles;
    if (content.size() == expected) return read_binary(content);
    if (!may_be_text)
      throw IoError(file, fmt::format("found {} bytes; expected {} for the {} triangles announced",
                                      content.size(), expected, triangles));
  } else if (!may_be_text) {
    throw IoError(file, fmt::format("found {} bytes; expected 'solid' or a header of {} bytes",
                                    content.size(), header_bytes));
  }
  return TextReader(text, file).read();
}

}  // namespace tofsmith
