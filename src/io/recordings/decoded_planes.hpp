// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/recordings/undistortion.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// Whether only decoders of several returns fill the plane.
bool is_multipath_plane(DecodedPlane plane);
/// Type of the items of a plane: status and returns uint8, bin int32, others float32.
NpyType type_of_plane(DecodedPlane plane);
/// What one pixel takes in these planes together [bytes].
std::size_t bytes_per_pixel(const std::vector<DecodedPlane>& planes);

/// Planes of a frame, or of some of its rows; those that nobody asked for are empty.
class DecodedPlanes {
 public:
  DecodedPlanes(const std::vector<DecodedPlane>& planes, int height, int width);
  /// All planes of an image; no bins and nothing of multipath returns.
  explicit DecodedPlanes(DepthImage image);

  int height() const { return height_; }
  int width() const { return width_; }
  /// Where a decoder writes; null for the planes that are empty.
  DecodedView view();
  /// Of how many measurements raw numbers are the mean, if that plane was asked for.
  /// @param first  pixel of the planes where they belong
  void keep_averaged(const RawView& raw, std::size_t first);

  /// Turns all planes into those of the ideal pinhole. @param as_z  what depth holds
  void undistort(const Undistortion& undistortion, bool as_z);

  const Image<float>& depth_m() const { return image_.depth_m; }
  const Image<PixelStatus>& statuses() const { return image_.status; }
  bool has(DecodedPlane plane) const;
  /// A plane as floats: codes of status, numbers of bins.
  Image<float> floats(DecodedPlane plane) const;
  /// The first rows of a plane as they are.
  std::span<const std::byte> items(DecodedPlane plane, int rows) const;

 private:
  /// Calls `use` with the image of a plane, of whatever type.
  template <typename Planes, typename Use>
  static auto with(Planes& planes, DecodedPlane plane, const Use& use);

  int height_, width_;
  DepthImage image_;
  Image<std::int32_t> bin_;
  Image<float> delay_m_, ratio_, averaged_;
  Image<ReturnStatus> returns_;
};

/// Turns radial distance into z-depth in place.
/// @param depth_m    rows of as many values as the view is wide
/// @param first_row  of the view
void turn_into_z(float* depth_m, int first_row, int rows, const PixelRays& pixel_rays);

}  // namespace tofsmith
