// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/array.hpp"
#include "tofsmith/decode/decoded_view.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/scene/pinhole.hpp"

namespace tofsmith::apps {

/// Names of the planes that are written unless others are asked for: depth, signal, ambient,
/// confidence, deviation, status; of decoders of several returns also delay, ratio, returns.
std::vector<std::string> plane_names(bool multipath = false);
/// Whether only decoders of several returns fill the plane.
bool is_multipath_plane(std::string_view name);
/// All of these and bin: of zncc the one that scores best, of others the nearest.
std::vector<std::string> all_plane_names();

/// Type of the items of a plane: status and returns uint8, bin int32, others float32.
NpyType type_of_plane(std::string_view name);
/// What one pixel takes in these planes together [bytes].
std::size_t bytes_per_pixel(const std::vector<std::string>& names);

/// Planes of a frame, or of some of its rows; those that nobody asked for are empty.
class DecodedPlanes {
 public:
  /// @param names  of all_plane_names()
  DecodedPlanes(const std::vector<std::string>& names, int height, int width);
  /// All planes of an image; no bins.
  explicit DecodedPlanes(DepthImage image);

  int height() const { return height_; }
  int width() const { return width_; }
  /// Where a decoder writes; null for the planes that are empty.
  DecodedView view();

  const Image<float>& depth_m() const { return image_.depth_m; }
  /// A plane as floats: codes of status, numbers of bins.
  Image<float> floats(std::string_view name) const;
  /// The first rows of a plane as they are.
  std::span<const std::byte> items(std::string_view name, int rows) const;

 private:
  Image<float>* float_plane(std::string_view name);
  const Image<float>* float_plane(std::string_view name) const {
    return const_cast<DecodedPlanes*>(this)->float_plane(name);
  }

  int height_, width_;
  DepthImage image_;
  Image<std::int32_t> bin_;
  Image<float> delay_m_, ratio_;
  Image<ReturnStatus> returns_;
};

/// Turns radial distance into z-depth in place.
/// @param depth_m    rows x view.width values
/// @param first_row  of the view
void turn_into_z(float* depth_m, int first_row, int rows, const PinholeView& view);

}  // namespace tofsmith::apps
