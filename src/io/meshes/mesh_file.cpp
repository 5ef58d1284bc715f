// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "core/shared/text_numbers.hpp"
#include "io/byte_cursor.hpp"
#include "io/meshes/polygon_soup.hpp"
#include "io/shared/byte_order.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

std::string mesh_extension(const std::filesystem::path& path) {
  return known_extension(path, {".obj", ".ply", ".stl"});
}

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
      const std::optional<double> value = number_in(word);
      if (!value) fail(fmt::format("found the coordinate '{}'; expected a number", word));
      number = static_cast<float>(*value);
    }
    add_corner(position, soup_);
    ++corners_;
  }

  void end_face() {
    if (corners_ < 3) fail(fmt::format("found a loop of {} corners; expected 3 or more", corners_));
    soup_.face_end.push_back(soup_.position_of.size());
    corners_ = 0;
  }

  std::string_view text_;
  std::string file_;
  int line_ = 0;
  int corners_ = 0;
  PolygonSoup soup_;
};

/// Reads a binary file, or text that ends with endsolid.
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

/// A backslash at the end of a line continues it.
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

struct ObjCounts {
  std::int64_t vertices = 0, texture_coordinates = 0, normals = 0;
};

/// Requires vertices with at least three finite numbers, and faces with at least three corners and
/// existing indices. Skips other lines.
class ObjReader {
 public:
  ObjReader(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  PolygonSoup read() {
    const ObjCounts all = count();
    ObjCounts so_far;
    visit([&](std::string_view key, std::string_view rest) {
      if (key == "v") read_vertex(rest);
      if (key == "vt") read_texture(rest);
      if (key == "f") read_face(rest, so_far, all);
      add(key, so_far);
    });
    return std::move(soup_);
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

  /// Requires at least `least` numbers and stores as many as fit into `first`.
  template <std::size_t n>
  void read_numbers(std::string_view rest, std::string_view what, std::size_t least,
                    std::array<float, n>& first) const {
    std::size_t numbers = 0;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      const std::optional<double> number = number_in(word);
      if (!number || !std::isfinite(static_cast<float>(*number)))
        fail(fmt::format("found the coordinate '{}'; expected a finite number", word));
      if (numbers < n) first[numbers] = static_cast<float>(*number);
      ++numbers;
    }
    if (numbers < least)
      fail(fmt::format("found a {} of {} numbers; expected {} or more", what, numbers, least));
  }

  void read_vertex(std::string_view rest) {
    read_numbers(rest, "vertex", 3, soup_.positions.emplace_back());
  }

  void read_texture(std::string_view rest) {
    read_numbers(rest, "texture coordinate", 1, soup_.textures.emplace_back());
  }

  /// Parses one index of a corner "7/3/-1". Returns it counted from 0; negative indices count back
  /// from the last element.
  std::uint32_t take_index(std::string_view& corner, std::string_view what, std::int64_t so_far,
                           std::int64_t all) const {
    std::int64_t index = 0;
    const auto result = std::from_chars(corner.data(), corner.data() + corner.size(), index);
    const bool whole = result.ec == std::errc() &&
                       (result.ptr == corner.data() + corner.size() || *result.ptr == '/');
    if (!whole)
      fail(fmt::format("found '{}' in a face; expected indices such as 7, 7/3 or 7/3/1", corner));
    if (index == 0 || index > all || index < -so_far)
      fail(fmt::format("found the {} index {}; expected 1 to {}", what, index, all));
    corner.remove_prefix(static_cast<std::size_t>(result.ptr - corner.data()));
    return static_cast<std::uint32_t>(index > 0 ? index - 1 : so_far + index);
  }

  void read_face(std::string_view rest, const ObjCounts& so_far, const ObjCounts& all) {
    int corners = 0;
    for (std::string_view corner = next_word(rest); !corner.empty(); corner = next_word(rest)) {
      soup_.position_of.push_back(take_index(corner, "vertex", so_far.vertices, all.vertices));
      std::uint32_t texture = PolygonSoup::none;
      const auto slash = [&corner] {
        const bool is = corner.starts_with('/');
        if (is) corner.remove_prefix(1);
        return is;
      };
      if (slash()) {
        if (!corner.starts_with('/'))
          texture = take_index(corner, "texture coordinate", so_far.texture_coordinates,
                               all.texture_coordinates);
        if (slash()) take_index(corner, "normal", so_far.normals, all.normals);
      }
      if (!corner.empty())
        fail(fmt::format("found '{}' after a face's corner; expected a space", corner));
      soup_.texture_of.push_back(texture);
      ++corners;
    }
    if (corners < 3) fail(fmt::format("found a face of {} corners; expected 3 or more", corners));
    soup_.face_end.push_back(soup_.position_of.size());
  }

  std::string_view text_;
  std::string file_;
  int line_ = 0;
  PolygonSoup soup_;
};

}  // namespace

bool is_mesh_file(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".obj" || extension == ".ply" || extension == ".stl";
}

TriangleMesh parse_mesh(std::span<const std::byte> content, std::string_view file) {
  const std::string name(file);
  const std::string extension = mesh_extension(name);
  if (content.empty()) throw IoError(name, "found an empty file; expected a mesh");
  const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
  if (extension == ".obj") return triangles_of(ObjReader(text, name).read(), name);
  return triangles_of(
      extension == ".ply" ? parse_ply_mesh(content, name) : parse_stl(content, name), name);
}

TriangleMesh read_mesh(const std::filesystem::path& path) {
  mesh_extension(path);
  return parse_mesh(read_binary_file(path, max_mesh_file_bytes), path.string());
}

}  // namespace tofsmith
