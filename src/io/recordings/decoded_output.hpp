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

/// Writes planes by extension: .npy, .pfm and .png hold depth; .exr every chosen plane as a
/// channel; .npz every chosen plane as an array; .ply and .pcd a point cloud with the chosen planes
/// as scalars.
/// @param planes      those of `decoded` to write; .npy, .pfm and .png take depth, points need it
///                    and status too
/// @param kind        of the depth
/// @param pixel_rays  of points; other files need none
/// @param all_points  though their pixels are not ok
void write_planes(const std::filesystem::path& path, const DepthImage& decoded,
                  const std::vector<DecodedPlane>& planes, DepthKind kind,
                  const PixelRays& pixel_rays, bool all_points, OutputPolicy policy);

/// Whether a file of this name holds depth alone: .npy, .pfm, .png.
bool holds_depth_only(const std::filesystem::path& path);

/// Fails before the work if write_planes() could not write there. @throws IoError
void check_decoded_output(const std::filesystem::path& path, OutputPolicy policy);

/// What becomes of decoded frames.
struct DecodeTarget {
  std::filesystem::path path;  ///< with several frames they get numbers, unless stacked
  OutputPolicy policy = OutputPolicy::refuse_existing;
  bool stack = false;                ///< all frames in one .npy per plane
  std::vector<DecodedPlane> planes;  ///< to write
  bool count_statuses = true;        ///< though the status plane may not be written
  bool all_points = false;           ///< of pixels that are not ok, too
  bool find_mixed = false;           ///< which needs planes that may not be written
  bool needs_signal = false;         ///< to correct depth, though it may not be written
  bool as_z = false;                 ///< depth along the axis instead of radial distance
  int first_frame = 0;
  int frames = 1;
  PinholeView view;      ///< of all frames
  PixelRays pixel_rays;  ///< of what is decoded or written, if points or z-depth are written
  std::optional<Undistortion> undistortion = {};  ///< of decoded planes; none: they stay

  /// File of a frame: name.npz, frame 3 of 12 -> name-03.npz.
  std::filesystem::path frame_path(int frame) const;
  /// Every file that will be written: of each frame, or of each plane of a stack.
  std::vector<std::filesystem::path> paths() const;
  /// Rows are written as they come; else a frame's planes stand in memory as a whole.
  bool in_rows() const { return path.extension() == ".npy"; }
  /// Where the planes of what is decoded hold the first pixel of a band.
  std::size_t first_pixel(const Band& band) const {
    return in_rows()
               ? 0
               : static_cast<std::size_t>(band.first_row) * static_cast<std::size_t>(view.width);
  }
  /// Planes that must be decoded: those written, what points are made of, what is counted
  /// and what mixed pixels are found by.
  std::vector<DecodedPlane> needed_planes() const;
  /// What writing a frame takes for a while, beside its planes [bytes].
  std::size_t writing_bytes() const;
};

/// Writes decoded frames, each file whole or not at all.
class DecodeOutput {
 public:
  /// @throws IoError if a file could not be written
  explicit DecodeOutput(DecodeTarget target);

  /// Takes the rows of a frame that follow those taken before.
  /// @param planes  of exactly these rows, from its first row on, if target.in_rows(); else of the
  ///                whole frame, complete once the last rows come
  /// @throws IoError if a file cannot be written
  void take(int frame, int first_row, int rows, const DepthImage& planes);
  /// Gives the stack its name. Call it once, last.
  void finish();

  const DecodeTarget& target() const { return target_; }

 private:
  void open_files(int frame);
  void close_files();

  DecodeTarget target_;
  std::vector<std::unique_ptr<NpyItemWriter>> files_;  // .npy being written, one per plane
};

}  // namespace tofsmith
