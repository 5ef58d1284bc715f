// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/meshes/mesh_checks.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

#include "io/shared/byte_cursor.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";

/// Cuts the next word off a line; "" at its end.
std::string_view next_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

/// Cuts the next line off a text. A backslash at the end of a line joins the next one to it.
std::string next_line(std::string_view& text, int& lines) {
  std::string line;
  for (bool more = true; more && !text.empty();) {
    const std::size_t length = text.find('\n');
    std::string_view part = text.substr(0, length);
    text.remove_prefix(length == std::string_view::npos ? text.size() : length + 1);
    ++lines;
    if (part.ends_with('\r')) part.remove_suffix(1);
    more = part.ends_with('\\');
    if (more) part.remove_suffix(1);
    line.append(part).append(more ? " " : "");
  }
  return line;
}

/// How many of each there are, so far or in all.
struct ObjCounts {
  std::int64_t vertices = 0, texture_coordinates = 0, normals = 0;
};

class ObjCheck {
 public:
  ObjCheck(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  void run() {
    const ObjCounts all = count();
    ObjCounts so_far;
    visit([&](std::string_view key, std::string_view rest) {
      if (key == "v") check_vertex(rest);
      if (key == "f") check_face(rest, so_far, all);
      add(key, so_far);
    });
  }

 private:
  template <typename Use>
  void visit(Use&& use) {
    std::string_view text = text_;
    for (int lines = 0; !text.empty();) {
      line_ = lines + 1;
      const std::string line = next_line(text, lines);
      std::string_view rest = std::string_view(line).substr(0, line.find('#'));
      const std::string_view key = next_word(rest);
      use(key, rest);
    }
  }

  static void add(std::string_view key, ObjCounts& counts) {
    if (key == "v") ++counts.vertices;
    if (key == "vt") ++counts.texture_coordinates;
    if (key == "vn") ++counts.normals;
  }

  ObjCounts count() {
    ObjCounts all;
    visit([&](std::string_view key, std::string_view) { add(key, all); });
    return all;
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw IoError(fmt::format("{}:{}", file_, line_), problem);
  }

  void check_vertex(std::string_view rest) const {
    int numbers = 0;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      if (word.starts_with('+')) word.remove_prefix(1);
      double number = 0.0;
      const auto result = std::from_chars(word.data(), word.data() + word.size(), number);
      if (result.ec != std::errc() || result.ptr != word.data() + word.size() ||
          !std::isfinite(number) || !std::isfinite(static_cast<float>(number)))
        fail(fmt::format("found the coordinate '{}'; expected a finite number", word));
      ++numbers;
    }
    if (numbers < 3) fail(fmt::format("found a vertex of {} numbers; expected 3 or more", numbers));
  }

  /// One of the numbers of a corner "7/3/-1"; a negative one counts back from the last.
  void check_index(std::string_view& corner, std::string_view what, std::int64_t so_far,
                   std::int64_t all) const {
    std::int64_t index = 0;
    const auto result = std::from_chars(corner.data(), corner.data() + corner.size(), index);
    const bool whole = result.ec == std::errc() &&
                       (result.ptr == corner.data() + corner.size() || *result.ptr == '/');
    if (!whole)
      fail(fmt::format("found '{}' in a face; expected indices such as 7, 7/3 or 7/3/1", corner));
    if (index == 0 || index > all || index < -so_far)
      fail(fmt::format("found the {} index {}; expected 1 .. {}", what, index, all));
    corner.remove_prefix(static_cast<std::size_t>(result.ptr - corner.data()));
  }

  void check_face(std::string_view rest, const ObjCounts& so_far, const ObjCounts& all) const {
    int corners = 0;
    for (std::string_view corner = next_word(rest); !corner.empty(); corner = next_word(rest)) {
      check_index(corner, "vertex", so_far.vertices, all.vertices);
      const auto slash = [&corner] {
        const bool is = corner.starts_with('/');
        if (is) corner.remove_prefix(1);
        return is;
      };
      if (slash()) {
        if (!corner.starts_with('/'))
          check_index(corner, "texture coordinate", so_far.texture_coordinates,
                      all.texture_coordinates);
        if (slash()) check_index(corner, "normal", so_far.normals, all.normals);
      }
      if (!corner.empty())
        fail(fmt::format("found '{}' after a face's corner; expected a blank", corner));
      ++corners;
    }
    if (corners < 3) fail(fmt::format("found a face of {} corners; expected 3 or more", corners));
  }

  std::string_view text_;
  std::string file_;
  int line_ = 0;
};

}  // namespace

void check_obj(std::string_view text, std::string_view file) { ObjCheck(text, file).run(); }

void check_stl(std::span<const std::byte> content, std::string_view file) {
  constexpr std::size_t header_bytes = 84, triangle_bytes = 50;
  const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
  const bool may_be_text = text.starts_with("solid");
  if (content.size() >= header_bytes) {
    ByteCursor cursor(content, file);
    cursor.take(header_bytes - 4, "the header");
    const std::uint64_t triangles = cursor.take_u32_little("the count of triangles");
    const std::uint64_t expected = header_bytes + triangle_bytes * triangles;
    if (content.size() == expected) return;
    if (!may_be_text)
      throw IoError(file, fmt::format("found {} bytes; expected {} for the {} triangles announced",
                                      content.size(), expected, triangles));
  } else if (!may_be_text) {
    throw IoError(file, fmt::format("found {} bytes; expected 'solid' or a header of {} bytes",
                                    content.size(), header_bytes));
  }
  const std::size_t last_facet = text.rfind("endfacet");
  if (text.find("endsolid", last_facet == std::string_view::npos ? 0 : last_facet) ==
      std::string_view::npos)
    throw IoError(file, fmt::format("byte {}: the file ends here; expected endsolid", text.size()));
}

}  // namespace tofsmith
