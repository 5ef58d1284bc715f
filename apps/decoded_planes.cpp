// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decoded_planes.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "tofsmith/core/parallel.hpp"

namespace tofsmith::apps {

namespace {

struct FloatPlane {
  std::string_view name;
  Image<float> DepthImage::*plane;
};
constexpr std::array float_planes = {
    FloatPlane{"depth", &DepthImage::depth_m},
    FloatPlane{"signal", &DepthImage::signal_e_per_s},
    FloatPlane{"ambient", &DepthImage::ambient_e_per_s},
    FloatPlane{"confidence", &DepthImage::confidence},
    FloatPlane{"deviation", &DepthImage::predicted_standard_deviation_m},
};

template <typename Value>
Image<float> as_floats(const Image<Value>& image) {
  Image<float> floats(image.height, image.width);
  std::ranges::transform(image.pixels, floats.pixels.begin(),
                         [](Value value) { return static_cast<float>(value); });
  return floats;
}

template <typename Value>
std::span<const std::byte> first_items(const Image<Value>& image, int rows) {
  const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(image.width);
  return std::as_bytes(std::span(image.pixels).first(count));
}

}  // namespace

std::vector<std::string> plane_names(bool multipath) {
  std::vector<std::string> names = {"depth",      "signal",    "ambient",
                                    "confidence", "deviation", "status"};
  if (multipath) names.insert(names.end(), {"delay", "ratio", "returns"});
  return names;
}

bool is_multipath_plane(std::string_view name) {
  return name == "delay" || name == "ratio" || name == "returns";
}

std::vector<std::string> all_plane_names() {
  std::vector<std::string> names = plane_names(true);
  names.emplace_back("bin");
  return names;
}

NpyType type_of_plane(std::string_view name) {
  if (name == "status" || name == "returns") return NpyType::uint8;
  return name == "bin" ? NpyType::int32 : NpyType::float32;
}

std::size_t bytes_per_pixel(const std::vector<std::string>& names) {
  std::size_t bytes = 0;
  for (const std::string& name : names) bytes += item_size(type_of_plane(name));
  return bytes;
}

DecodedPlanes::DecodedPlanes(const std::vector<std::string>& names, int height, int width)
    : height_(height), width_(width) {
  for (const std::string& name : names)
    if (name == "status")
      image_.status = {height, width};
    else if (name == "returns")
      returns_ = {height, width};
    else if (name == "bin")
      bin_ = {height, width};
    else
      *float_plane(name) = {height, width};
}

DecodedPlanes::DecodedPlanes(DepthImage image)
    : height_(image.height()), width_(image.width()), image_(std::move(image)) {}

/// Where a plane of floats is; null for status, returns and bin.
Image<float>* DecodedPlanes::float_plane(std::string_view name) {
  if (name == "delay") return &delay_m_;
  if (name == "ratio") return &ratio_;
  const auto found = std::ranges::find(float_planes, name, &FloatPlane::name);
  return found == float_planes.end() ? nullptr : &(image_.*found->plane);
}

DecodedView DecodedPlanes::view() {
  DecodedView view = DecodedView::of(image_);
  view.bin = bin_.pixels.data();
  view.delay_m = delay_m_.pixels.data();
  view.ratio = ratio_.pixels.data();
  view.returns = returns_.pixels.data();
  return view;
}

Image<float> DecodedPlanes::floats(std::string_view name) const {
  if (name == "status") return as_floats(image_.status);
  if (name == "returns") return as_floats(returns_);
  return name == "bin" ? as_floats(bin_) : *float_plane(name);
}

std::span<const std::byte> DecodedPlanes::items(std::string_view name, int rows) const {
  if (name == "status") return first_items(image_.status, rows);
  if (name == "returns") return first_items(returns_, rows);
  return name == "bin" ? first_items(bin_, rows) : first_items(*float_plane(name), rows);
}

void turn_into_z(float* depth_m, int first_row, int rows, const PinholeView& view) {
  parallel_for(rows, [&](std::int64_t row) {
    float* depth = depth_m + row * view.width;
    for (int column = 0; column < view.width; ++column)
      depth[column] = static_cast<float>(
          depth[column] * (1.0 / view.radial_per_z(first_row + static_cast<int>(row), column)));
  });
}

}  // namespace tofsmith::apps
