// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "io/recordings/decoded_planes.hpp"
#include "io/recordings/read_ahead.hpp"
#include "io/recordings/undistortion.hpp"
#include "tofsmith/io/depth_kind.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// Writes planes by extension: depth as .npy, .pfm and .png; the chosen planes as channels of .exr,
/// as arrays of .npz, or as scalars of the point cloud of .ply and .pcd.
/// @param planes      planes of `decoded` to write; .npy, .pfm and .png require depth, points also
///                    status
/// @param kind        kind of the depth
/// @param pixel_rays  for points; not needed by other files
/// @param all_points  also write points of pixels that are not ok
void write_planes(const std::filesystem::path& path, const DepthImage& decoded,
                  const std::vector<DecodedPlane>& planes, DepthKind kind,
                  const PixelRays& pixel_rays, bool all_points, OutputPolicy policy);

/// Returns true if a file with this name contains only depth: .npy, .pfm, .png.
bool holds_depth_only(const std::filesystem::path& path);

/// Fails early if write_planes() cannot write to this path. @throws IoError
void check_decoded_output(const std::filesystem::path& path, OutputPolicy policy);

/// Destination of decoded frames, and the planes to write.
struct DecodeTarget {
  std::filesystem::path path;  ///< numbered for several frames, unless stacked
  OutputPolicy policy = OutputPolicy::refuse_existing;
  bool stack = false;                ///< all frames in one .npy per plane
  std::vector<DecodedPlane> planes;  ///< planes to write
  bool count_statuses = true;        ///< even if the status plane is not written
  bool all_points = false;           ///< also points of pixels that are not ok
  bool find_mixed = false;           ///< requires planes that may not be written
  bool needs_signal = false;         ///< to correct depth, even if it is not written
  bool as_z = false;                 ///< depth along the axis instead of radial distance
  int first_frame = 0;
  int frames = 1;
  PinholeView view;      ///< of all frames
  PixelRays pixel_rays;  ///< of the decoded or written planes, for points and z-depth
  std::optional<Undistortion> undistortion = {};  ///< of decoded planes; none: not applied

  /// Returns the file of a frame: name.npz, frame 3 of 12 -> name-03.npz.
  std::filesystem::path frame_path(int frame) const;
  /// Returns all files that will be written: one per frame, or one per plane of a stack.
  std::vector<std::filesystem::path> paths() const;
  /// Returns true if rows are written as they arrive; otherwise planes of whole frames are needed.
  bool in_rows() const { return path.extension() == ".npy"; }
  /// Returns the index of the first pixel of a band in the decoded planes.
  std::size_t first_pixel(const Band& band) const {
    return in_rows()
               ? 0
               : static_cast<std::size_t>(band.first_row) * static_cast<std::size_t>(view.width);
  }
  /// Returns the planes that must be decoded: for output, for points, for counts and for finding
  /// mixed pixels.
  std::vector<DecodedPlane> needed_planes() const;
  /// Temporary memory for writing a frame, in addition to its planes [bytes].
  std::size_t writing_bytes() const;
};

/// Writes decoded frames. Files are written completely or not at all.
class DecodeOutput {
 public:
  /// @throws IoError if a file could not be written
  explicit DecodeOutput(DecodeTarget target);

  /// Writes the next rows of a frame.
  /// @param planes  only these rows if target.in_rows(); otherwise the whole frame, complete with
  ///                its last rows
  /// @throws IoError if a file cannot be written
  void take(int frame, int first_row, int rows, const DepthImage& planes);
  /// Completes the files of a stack. Must be called once, last.
  void finish();

  const DecodeTarget& target() const { return target_; }

 private:
  void open_files(int frame);
  void close_files();

  DecodeTarget target_;
  std::vector<std::unique_ptr<NpyItemWriter>> files_;  // .npy being written, one per plane
};

}  // namespace tofsmith
