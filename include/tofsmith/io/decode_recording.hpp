// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/frame_pipeline.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/depth_kind.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// Returns true for files of points: .ply, .pcd.
bool holds_points(const std::filesystem::path& path);

NpyType type_of(DecodedPlane plane);
/// Help text of DecodeRequest::outputs, which lists the planes.
std::string_view help_of_outputs();
/// Text of the planes that are written by default.
std::string_view default_of_outputs();

/// Request to decode a recording into files.
struct DecodeRequest {
  /// .npy, .npz or .h5, (H, W, K) or (F, H, W, K); or K files (H, W) or (F, H, W) in order.
  std::vector<std::filesystem::path> raw;
  RawLayout layout = RawLayout::interleaved;
  std::string dataset;
  std::filesystem::path raw_format;

  /// .npy, .pfm, .png (16 bits, mm): only depth; .npz: arrays; .exr: channels; .ply, .pcd
  /// (organized): points with planes as scalars. Files of several frames are numbered: name-03.npz.
  std::filesystem::path output;
  std::vector<DecodedPlane> outputs;
  DepthKind kind = DepthKind::radial;
  bool all_points = false;
  /// Lens for points and z-depth (or `view_deg`). Pixels without a ray in its map are invalid.
  std::optional<Lens> lens;
  std::optional<double> view_deg;
  bool undistort = false;
  std::optional<int> frame;
  bool stack = false;
  /// Number of consecutive frames to average. Invalid or saturated pixels of one frame are also
  /// invalid or saturated in the mean.
  int average = 1;
  /// Groups are merged by merge_exposures(). Not valid with `average`.
  std::vector<double> hdr;
  /// F frames of E exposures give (F - 1) E + 1 depth images. A time filter averages windows that
  /// share no exposure. Not valid with `average`, `averaged`, `hdr` or `look_ahead`.
  bool sliding = false;
  std::filesystem::path stray_light;  ///< image with the kernel of StrayLight
  double averaged = 1.0;              ///< multiplied by `average`
  /// Applied to consecutive frames or means. For one `frame`, the frames before it are read as
  /// well, and with `look_ahead` the frames after it. `filter` sets `before_filter`.
  std::optional<TimeFilterOptions> time_filter;
  std::optional<FilterOptions> filter;  ///< after the temporal filter
  std::optional<MixedPixels> mixed;
  std::optional<double> min_depth_m;  ///< see depth_limits()
  std::optional<double> max_depth_m;
  std::filesystem::path offset_map;  ///< as PixelMaps::delay_offset_m
  double offset_m = 0.0;
  std::filesystem::path gain_map;  ///< as PixelMaps::gain
  double memory_mb = 256.0;
  /// Order of the exposures, as Playback::order, for errors about raw numbers that do not fit.
  /// Empty: one exposure per measurement, in the order of the code.
  std::vector<int> order;
  OutputPolicy policy = OutputPolicy::refuse_existing;
  std::vector<std::string> other_inputs;  ///< which outputs must not replace
};
auto fields_of(ConstOrNot<DecodeRequest> auto& r) {
  return std::tuple(
      Field("raw", r.raw, FieldMark::from_above),
      Field("layout", r.layout,
            Help{"memory layout of the raw numbers: interleaved (H,W,K) or planar (K,H,W); not "
                 "detected automatically"}),
      Field("dataset", r.dataset,
            Help{"array of an .npz file or dataset of an .h5 file with the raw numbers"},
            IfAbsent{"raw, otherwise the only one"}),
      Field("raw_format", r.raw_format,
            Help{"description (.raw.toml) of a raw file without header; see docs/raw_formats.md"}),
      Field("output", r.output, FieldMark::from_above),
      Field("outputs", r.outputs, Help{help_of_outputs()}, IfAbsent{default_of_outputs()}),
      Field("kind", r.kind,
            Help{"depth to write: radial distance, or z along the optical axis; .ply and .pcd "
                 "contain points"}),
      Field("all_points", r.all_points,
            Help{"also write points of pixels that are not ok (.ply, .pcd)"}),
      Field("lens", r.lens, FieldMark::from_above),
      Field(
          "view_deg", r.view_deg, open(0, 180),
          Help{"horizontal angle of view, instead of the camera's [lens]; points and z require one "
               "of them"},
          IfAbsent{"none"}),
      Field("undistort", r.undistort,
            Help{"write undistorted planes (nearest pixel); pixels outside the lens's view are "
                 "invalid"}),
      Field("frame", r.frame, at_least(0),
            Help{"index of the only frame to decode, from 0; if frames are averaged or merged, "
                 "the index of the averaged or merged frame"},
            IfAbsent{"all"}),
      Field("stack", r.stack,
            Help{"write all frames to one .npy (F,H,W), and each plane except depth to "
                 "NAME-PLANE.npy"}),
      Field("average", r.average, at_least(1),
            Help{"average this many consecutive frames before decoding; the last group may be "
                 "smaller"}),
      Field("hdr", r.hdr,
            Help{"merge groups of frames with different exposures: multiples of the camera's "
                 "exposure, e.g. 1,4,16; the shortest is 1"}),
      Field("sliding", r.sliding,
            Help{"decode a sliding window of exposures instead of frames: one depth image per "
                 "exposure"}),
      Field("stray_light", r.stray_light,
            Help{"kernel of the stray light to remove from raw numbers, from calibrate "
                 "stray-light (.npy .npz .exr .pfm)"}),
      Field("averaged", r.averaged, left_open(0, 1e9),
            Help{"number of equal measurements averaged in each raw frame; determines the noise"}),
      Field("time_filter", r.time_filter, Help{"options of the temporal filter"}, IfAbsent{"none"}),
      Field("filter", r.filter, Help{"options of the spatial filter"}, IfAbsent{"none"}),
      Field("mixed", r.mixed,
            Help{"flying pixels at depth edges: label as mixed, snap to the brighter surface, or "
                 "drop the depth"},
            IfAbsent{"off"}),
      Field("min_depth_m", r.min_depth_m, at_least(0),
            Help{"smallest radial depth after all corrections; pixels below it are too_near"},
            IfAbsent{"the camera's working distance, otherwise 0"}),
      Field("max_depth_m", r.max_depth_m, above(0),
            Help{"largest radial depth after all corrections; pixels above it are too_far"},
            IfAbsent{"the camera's working distance, otherwise the range"}),
      Field("offset_map", r.offset_map,
            Help{"depth offset of each pixel in metres (.npy .npz .exr .pfm), subtracted from "
                 "the depth; NaN: dead pixel"}),
      Field("offset_m", r.offset_m, Help{"depth offset of all pixels, subtracted from the result"}),
      Field(
          "gain_map", r.gain_map,
          Help{
              "relative response of each pixel, removed from signal and ambient; NaN: dead pixel"}),
      Field("memory_mb", r.memory_mb, left_open(0, 1e9),
            Help{"memory for in-flight frames; the process uses about 50 MB more; frames that do "
                 "not fit are decoded in bands of rows"}),
      Field("order", r.order, FieldMark::from_above),
      Field("policy", r.policy, FieldMark::from_above),
      Field("other_inputs", r.other_inputs, FieldMark::from_above));
}

/// Number of pixels by status.
class StatusCounts {
 public:
  void add(std::span<const PixelStatus> statuses);
  void add(const StatusCounts& other);
  std::int64_t of(PixelStatus status) const { return counts_[static_cast<std::size_t>(status)]; }
  std::int64_t pixels() const;

 private:
  std::array<std::int64_t, all_pixel_statuses.size()> counts_{};
};

/// Result of decode_recording().
struct DecodedRecording {
  int height = 0;
  int width = 0;
  int measurements = 0;
  int first_frame = 0;  ///< first requested frame; means count as frames
  int frame_count = 0;
  std::vector<DecodedPlane> outputs;
  std::vector<std::filesystem::path> files;  ///< per finished frame; of a stack: per plane
  std::vector<StatusCounts> frames;  ///< per finished frame; zero if statuses were not requested
  std::int64_t pixels = 0;
  double seconds = 0.0;
  std::vector<std::string> notes;  ///< for the user

  double frames_per_s() const { return static_cast<double>(frames.size()) / seconds; }
  double megapixels_per_s() const { return 1e-6 * static_cast<double>(pixels) / seconds; }
  StatusCounts total() const;
};

/// Decodes a recording of any length with constant memory, in bands of rows (whole frames if they
/// are filtered).
/// @param backend  the table of its decoder defines the meaning of the raw numbers
/// @throws std::invalid_argument "field = value; rule" for an invalid request, before any output
/// @throws IoError as RawFramesReader; for maps that do not match; for outputs that exist, are
///         inputs or cannot represent a depth; and for frames that need more than `memory_mb`
/// @throws Interrupted (files of finished frames are kept)
/// @note same bits for any number of threads and any memory limit
DecodedRecording decode_recording(const DecodeRequest& request, const FrameBackend& backend,
                                  const Progress& progress = {});
/// As above; `result` is updated after every frame, also if it throws.
void decode_recording(const DecodeRequest& request, const FrameBackend& backend,
                      const Progress& progress, DecodedRecording& result);

/// Returns fewer bytes than the size of `into` only at the end of the stream.
using ReadStream = std::function<std::size_t(std::span<std::byte> into)>;
using WriteStream = std::function<void(std::span<const std::byte> bytes)>;

/// Result of decode_stream().
struct DecodedStream {
  int height = 0;  ///< 0 until the header is read
  int width = 0;
  std::int64_t frames = 0;
  StatusCounts statuses;  ///< if status is an output
  double seconds = 0.0;   ///< including waiting
};

/// Decodes the frames of a stream with memory for a few frames. Each frame is written before the
/// next is read, unless a temporal filter looks ahead, as planes in the order of `outputs`
/// (default: depth) with H x W little-endian items: uint8 for status and returns, int32 for bin,
/// otherwise float32.
/// @param request  `raw_format` describes the stream, a header followed by frames; `raw`, `output`,
///                 `frame`, `stack`, `memory_mb` and `policy` are ignored
/// @param result   updated after every frame
/// @throws std::invalid_argument, IoError as decode_recording(); IoError if the stream ends within
///         a frame or before the first; exceptions of `read` and `write`; Interrupted
void decode_stream(const DecodeRequest& request, const FrameBackend& backend,
                   const ReadStream& read, const WriteStream& write, const Progress& progress,
                   DecodedStream& result);

/// Writes the planes of a decoded frame by extension, as DecodeRequest::output.
/// @param planes  ignored for .npy, .pfm and .png
/// @param view    for points (.ply, .pcd)
/// @throws std::invalid_argument if the frame does not have a plane; IoError for an unknown
///         extension
void write_decoded(const std::filesystem::path& path, const DepthImage& image,
                   const std::vector<DecodedPlane>& planes, const PinholeView& view,
                   OutputPolicy policy, bool all_points = false);

}  // namespace tofsmith
