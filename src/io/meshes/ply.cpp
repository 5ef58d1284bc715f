// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "io/meshes/ply_header.hpp"
#include "io/shared/byte_order.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// The numbers of one line, as many as there are in `row`.
void take_ascii_row(ByteCursor& cursor, std::vector<double>& row) {
  const std::size_t start = cursor.position();
  std::string_view line = cursor.take_until('\n', "a vertex");
  const auto skip_spaces = [&line] {
    line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
  };
  for (double& number : row) {
    skip_spaces();
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
    if (error != std::errc())
      cursor.fail_at(start, fmt::format("expected a vertex of {} numbers", row.size()));
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  }
  skip_spaces();
  if (!line.empty())
    cursor.fail_at(
        start, fmt::format("found more than {} numbers; expected one vertex per line", row.size()));
}

/// Where the numbers of a row go.
class RowSorter {
 public:
  RowSorter(const PlyHeader& header, const ByteCursor& cursor) {
    const auto column = [&](std::string_view name) {
      const auto is_it = [&](const PlyProperty& property) { return property.name == name; };
      const auto found = std::find_if(header.properties.begin(), header.properties.end(), is_it);
      return static_cast<std::size_t>(found - header.properties.begin());
    };
    const std::size_t none = header.properties.size();
    position_ = {column("x"), column("y"), column("z")};
    colour_ = {column("red"), column("green"), column("blue")};
    for (const std::size_t axis : position_)
      if (axis == none) cursor.fail("the header ends here; expected properties x, y and z in it");
    has_colour_ = std::all_of(colour_.begin(), colour_.end(), [&](std::size_t c) {
      return c != none && header.properties[c].type == PlyType::uint8;
    });
    for (std::size_t c = 0; c < none; ++c) {
      const bool is_position = std::ranges::count(position_, c) > 0;
      const bool is_colour = has_colour_ && std::ranges::count(colour_, c) > 0;
      if (!is_position && !is_colour) scalars_.push_back(c);
    }
  }

  PointCloud empty_cloud(const PlyHeader& header) const {
    PointCloud cloud;
    cloud.points_m.reserve(header.vertices);
    for (const std::size_t c : scalars_) cloud.scalars.push_back({header.properties[c].name, {}});
    return cloud;
  }

  void add(const std::vector<double>& row, PointCloud& cloud) const {
    cloud.points_m.push_back({static_cast<float>(row[position_[0]]),
                              static_cast<float>(row[position_[1]]),
                              static_cast<float>(row[position_[2]])});
    for (std::size_t i = 0; i < scalars_.size(); ++i)
      cloud.scalars[i].values.push_back(static_cast<float>(row[scalars_[i]]));
    if (has_colour_)
      cloud.colours.push_back(
          {colour(row[colour_[0]]), colour(row[colour_[1]]), colour(row[colour_[2]])});
  }

 private:
  /// An ascii file may say any number.
  static std::uint8_t colour(double value) {
    return static_cast<std::uint8_t>(value > 0.0 ? std::min(value, 255.0) : 0.0);
  }

  std::array<std::size_t, 3> position_{}, colour_{};
  std::vector<std::size_t> scalars_;
  bool has_colour_ = false;
};

void check_size(const PlyHeader& header, const ByteCursor& cursor) {
  // A number and what parts it from the next take two characters.
  const std::size_t min_vertex_bytes =
      header.ascii ? 2 * header.properties.size() : header.row_bytes();
  const std::size_t there = cursor.rest().size();
  const bool fits = min_vertex_bytes > 0 && header.vertices <= there / min_vertex_bytes;
  if (!fits || (!header.ascii && header.vertices * min_vertex_bytes != there))
    cursor.fail(fmt::format("found {} bytes of data; expected {} vertices of {}{} bytes", there,
                            header.vertices, header.ascii ? "at least " : "", min_vertex_bytes));
}

bool is_word(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

void check(const PointCloud& cloud) {
  const auto same_length = [&](std::size_t length, const std::string& list) {
    require(length == cloud.points_m.size(), "number of " + list, length,
            fmt::format("must be that of points_m, {}", cloud.points_m.size()));
  };
  std::set<std::string> taken = {"x", "y", "z", "red", "green", "blue"};
  for (const PointScalar& scalar : cloud.scalars) {
    require(is_word(scalar.name), "scalar name", scalar.name,
            "must be letters, digits and underscores");
    require(taken.insert(scalar.name).second, "scalar name", scalar.name, "is taken already");
    same_length(scalar.values.size(), scalar.name);
  }
  if (!cloud.colours.empty()) same_length(cloud.colours.size(), "colours");
}

std::string header_text(const PointCloud& cloud) {
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n",
      cloud.points_m.size());
  for (const PointScalar& scalar : cloud.scalars)
    text += fmt::format("property float {}\n", scalar.name);
  if (!cloud.colours.empty())
    text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  return text + "end_header\n";
}

}  // namespace

PointCloud parse_ply(std::span<const std::byte> content, std::string_view file) {
  ByteCursor cursor(content, file);
  const PlyHeader header = parse_ply_header(cursor);
  const RowSorter sorter(header, cursor);
  check_size(header, cursor);

  PointCloud cloud = sorter.empty_cloud(header);
  std::vector<double> row(header.properties.size());
  for (std::size_t vertex = 0; vertex < header.vertices; ++vertex) {
    if (header.ascii) {
      take_ascii_row(cursor, row);
    } else {
      const std::byte* item = cursor.take(header.row_bytes(), "a vertex").data();
      for (std::size_t c = 0; c < row.size(); ++c) {
        row[c] = ply_number(item, header.properties[c].type);
        item += ply_item_size(header.properties[c].type);
      }
    }
    sorter.add(row, cloud);
  }
  if (!cursor.at_end()) cursor.fail("expected the file to end after the last vertex");
  return cloud;
}

PointCloud read_ply(const std::filesystem::path& path) {
  return parse_ply(read_binary_file(path), path.string());
}

std::vector<std::byte> serialize_ply(const PointCloud& cloud) {
  check(cloud);
  const std::string header = header_text(cloud);
  const std::size_t row_bytes =
      sizeof(float) * (3 + cloud.scalars.size()) + (cloud.colours.empty() ? 0 : 3);
  std::vector<std::byte> content(header.size() + row_bytes * cloud.points_m.size());
  std::ranges::copy(std::as_bytes(std::span(header)), content.begin());

  std::byte* at = content.data() + header.size();
  const auto put = [&at](float value) {
    store_little_endian(value, at);
    at += sizeof(float);
  };
  for (std::size_t i = 0; i < cloud.points_m.size(); ++i) {
    for (const float coordinate : cloud.points_m[i]) put(coordinate);
    for (const PointScalar& scalar : cloud.scalars) put(scalar.values[i]);
    if (!cloud.colours.empty())
      for (const std::uint8_t part : cloud.colours[i]) *at++ = static_cast<std::byte>(part);
  }
  return content;
}

void write_ply(const std::filesystem::path& path, const PointCloud& cloud, OutputPolicy policy) {
  write_file_atomically(path, serialize_ply(cloud), policy);
}

}  // namespace tofsmith
