// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "io/recordings/prepared_frames.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/io/depth_kind.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// Resamples images to the ideal pinhole. Each pixel has the values of the source pixel nearest to
/// its ray, so that depths are not mixed.
class Undistortion {
 public:
  /// @throws std::invalid_argument as PinholeView::validate()
  explicit Undistortion(const PinholeView& view);

  /// Memory, including one plane during resampling [bytes].
  std::size_t bytes() const;

  /// @param none  value of pixels that the image does not cover
  template <typename Value>
  void apply(Image<Value>& plane, Value none) const {
    const std::vector<Value> from = plane.pixels;
    for (std::size_t i = 0; i < source_.size(); ++i)
      plane.pixels[i] = source_[i] < 0 ? none : from[static_cast<std::size_t>(source_[i])];
  }
  /// Converts radial distances after apply(), so that z does not change.
  void turn_radial(Image<float>& depth_m) const;

 private:
  std::vector<std::int32_t> source_;  // source pixel of each pixel; -1: none
  std::vector<float> radial_ratio_;   // of the pixel's ray to the source's ray, at the same z
};

std::size_t bytes_per_pixel(const std::vector<DecodedPlane>& planes);

/// @param as_z  the depth is z, not radial
void undistort(DepthImage& image, const Undistortion& undistortion, bool as_z);

std::span<const std::byte> items_of(const DepthImage& image, DecodedPlane plane, int rows);

/// Converts radial distance in place.
/// @param depth_m  rows with the width of the view
/// @param first_row  index in the view
void turn_into_z(float* depth_m, int first_row, int rows, const PixelRays& pixel_rays);

/// Writes planes by extension: depth as .npy, .pfm and .png; other planes also as channels of .exr,
/// arrays of .npz, or scalars of the points of .ply and .pcd.
/// @param planes  to write; .npy, .pfm and .png require depth, points also status
/// @param pixel_rays  only for points
/// @param all_points  also write points of pixels that are not ok
void write_planes(const std::filesystem::path& path, const DepthImage& decoded,
                  const std::vector<DecodedPlane>& planes, DepthKind kind,
                  const PixelRays& pixel_rays, bool all_points, OutputPolicy policy);

/// Returns true for .npy, .pfm and .png.
bool holds_depth_only(const std::filesystem::path& path);

/// Destination of decoded frames.
struct DecodeTarget {
  std::filesystem::path path;  ///< numbered for several frames, unless stacked
  OutputPolicy policy = OutputPolicy::refuse_existing;
  bool stack = false;  ///< all frames in one .npy per plane
  std::vector<DecodedPlane> planes;
  bool count_statuses = true;  ///< even if the status plane is not written
  bool all_points = false;
  std::vector<DecodedPlane> correction_planes = {};  ///< planes_for(), even if not written
  bool as_z = false;  ///< depth along the axis instead of radial distance
  int first_frame = 0;
  int frames = 1;
  PinholeView view;      ///< of all frames
  PixelRays pixel_rays;  ///< of the decoded or written planes, for points and z-depth
  std::optional<Undistortion> undistortion = {};  ///< of decoded planes; none: not applied

  /// Frame 3 of 12 of name.npz is name-03.npz.
  std::filesystem::path frame_path(int frame) const;
  std::vector<std::filesystem::path> paths() const;
  /// Returns true if rows are written as they arrive, not whole frames.
  bool in_rows() const { return path.extension() == ".npy"; }
  /// Index of the first pixel of a band in the decoded planes.
  std::size_t first_pixel(const Band& band) const {
    return in_rows()
               ? 0
               : static_cast<std::size_t>(band.first_row) * static_cast<std::size_t>(view.width);
  }
  std::vector<DecodedPlane> needed_planes() const;
  /// Memory in addition to the planes of a frame [bytes].
  std::size_t writing_bytes() const;
};

/// Files are written completely or not at all.
class DecodeOutput {
 public:
  explicit DecodeOutput(DecodeTarget target);

  /// Writes the next rows of a frame.
  /// @param planes  only these rows if target.in_rows(); otherwise the whole frame, complete with
  ///   its last rows
  /// @throws IoError if a file cannot be written
  void take(int frame, int first_row, int rows, const DepthImage& planes);
  /// Must be called once, last: closes the files.
  void finish();

  const DecodeTarget& target() const { return target_; }

 private:
  void open_files(int frame);

  DecodeTarget target_;
  std::vector<std::unique_ptr<NpyItemWriter>> files_;
};

}  // namespace tofsmith
