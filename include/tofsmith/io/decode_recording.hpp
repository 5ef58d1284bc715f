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

/// Whether an output of this name holds points: .ply, .pcd.
bool holds_points(const std::filesystem::path& path);

/// Type of the values of a plane in files; statuses are uint8.
NpyType type_of(DecodedPlane plane);
/// Returns the help text of DecodeRequest::outputs, which lists the planes.
std::string_view help_of_outputs();

/// A recording to be decoded into files.
struct DecodeRequest {
  /// .npy, .npz or .h5, (H, W, K) or (F, H, W, K), of any size; or K files, one per measurement in
  /// their order, (H, W) or (F, H, W) each.
  std::vector<std::filesystem::path> raw;
  RawLayout layout = RawLayout::interleaved;
  std::string dataset;
  std::filesystem::path raw_format;

  /// .npy .pfm .png (16 bits, mm): depth alone; .npz: an array of each plane; .exr: a channel of
  /// each; .ply, .pcd (organized): points with planes as scalars. Files of several frames get
  /// numbers: name-03.npz.
  std::filesystem::path output;
  std::vector<DecodedPlane> outputs;
  DepthKind kind = DepthKind::radial;
  bool all_points = false;
  /// Of points and z, which require a lens or `view_deg`. Pixels that see nothing, by a map of
  /// rays, are invalid.
  std::optional<Lens> lens;
  std::optional<double> view_deg;
  bool undistort = false;  ///< needs a lens; nothing changes without distortion
  std::optional<int> frame;
  bool stack = false;
  /// A pixel that is invalid or saturated in one frame is so in the mean. Not above the number of
  /// frames.
  int average = 1;
  /// The recording holds whole groups, of which merge_exposures() makes frames. Goes without
  /// `average`.
  std::vector<double> hdr;
  /// F frames of E exposures give (F - 1) E + 1 depth images, in the order of their last
  /// exposures. A time filter averages windows that share no exposure. Not valid with `average`,
  /// `averaged`, `hdr` or `look_ahead`.
  bool sliding = false;
  std::filesystem::path stray_light;  ///< image of shares, as StrayLight takes it
  double averaged = 1.0;              ///< multiplied by `average`
  /// Applies to consecutive frames, or means of frames. `frame` also uses the frames before it,
  /// and with `look_ahead` the frames after it. With `filter` it is `before_filter`.
  std::optional<TimeFilterOptions> time_filter;
  std::optional<FilterOptions> filter;  ///< after the temporal filter
  std::optional<MixedPixels> mixed;     ///< see mark_mixed_pixels()
  std::optional<double> min_depth_m;    ///< see depth_limits()
  std::optional<double> max_depth_m;
  std::filesystem::path offset_map;  ///< as PixelMaps::delay_offset_m
  double offset_m = 0.0;
  std::filesystem::path gain_map;  ///< as PixelMaps::gain
  double memory_mb = 256.0;
  /// Order of the code's exposures in the decoder's table, as Playback::order. It is only used to
  /// suggest other orders if the raw numbers do not fit. Empty: one exposure per measurement, in
  /// the order of the code.
  std::vector<int> order;
  OutputPolicy policy = OutputPolicy::refuse_existing;
  std::vector<std::string> other_inputs;  ///< files that were read too: no output replaces them
};
auto fields_of(ConstOrNot<DecodeRequest> auto& r) {
  return std::tuple(
      Field("raw", r.raw, FieldMark::from_above),
      Field("layout", r.layout,
            Help{"how raw numbers are stored: interleaved, or planar for (K,H,W) and (F,K,H,W); "
                 "never guessed"}),
      Field("dataset", r.dataset,
            Help{"array of an .npz, or data set of an .h5, that holds the raw numbers"},
            IfAbsent{"the one called raw, or the only one"}),
      Field("raw_format", r.raw_format,
            Help{"the raw file is a sensor's dump without header, as this .raw.toml file describes "
                 "it (docs/raw_formats.md)"}),
      Field("output", r.output, FieldMark::from_above),
      Field("outputs", r.outputs, Help{help_of_outputs()},
            IfAbsent{"depth to status, as many as the output holds"}),
      Field("kind", r.kind,
            Help{"depth to write: radial distance, as the camera measures it, or z along the axis "
                 "(the convention of depth images for simulate and demo); .ply and .pcd hold "
                 "points either way"}),
      Field("all_points", r.all_points,
            Help{"in .ply and .pcd also write points of pixels that are not ok"}),
      Field("lens", r.lens, FieldMark::from_above),
      Field("view_deg", r.view_deg, open(0, 180),
            Help{"horizontal angle of view to assume for points and z if the camera has no [lens]"},
            IfAbsent{"points and z require a lens"}),
      Field("undistort", r.undistort,
            Help{"write planes without the distortion of the camera's lens: each pixel takes the "
                 "values of the nearest one; pixels that the lens does not see are invalid"}),
      Field("frame", r.frame, at_least(0),
            Help{"decode this frame only, counted from 0; with averaging this mean, with exposures "
                 "to merge this group; a temporal filter also uses the frames before it"},
            IfAbsent{"all"}),
      Field("stack", r.stack,
            Help{"write all frames to one .npy, (F,H,W), as they come, and each plane but depth to "
                 "a separate file, NAME-PLANE.npy"}),
      Field(
          "average", r.average, at_least(1),
          Help{"decode the means of this many consecutive frames; the last one is of those left"}),
      Field("hdr", r.hdr,
            Help{"exposure ratios of bracketed frames to the shortest exposure, which is the "
                 "camera's, such as 1,4,16: each group is merged into one frame, without saturated "
                 "samples, by their noise"}),
      Field("sliding", r.sliding,
            Help{"decode each new exposure together with the exposures before it, as many as a "
                 "frame has: one depth image per exposure; pixels that change meanwhile are "
                 "inconsistent"}),
      Field("stray_light", r.stray_light,
            Help{"light that the lens scatters, of calibrate stray-light (.npy .npz .exr .pfm), "
                 "removed from the raw numbers first"}),
      Field("averaged", r.averaged, left_open(0, 1e9),
            Help{"number of equal measurements of which the raw frames are already averages; sets "
                 "their noise"}),
      Field("time_filter", r.time_filter, Help{"options of the temporal filter"}, IfAbsent{"none"}),
      Field("filter", r.filter, Help{"options of the spatial filter"}, IfAbsent{"none"}),
      Field("mixed", r.mixed,
            Help{"find pixels at edges of depth that see two surfaces: label (status mixed, the "
                 "depth stays), snap (to the depth of the one that gives more light) or drop (no "
                 "depth)"},
            IfAbsent{"off"}),
      Field("min_depth_m", r.min_depth_m, at_least(0),
            Help{"smallest radial depth after all corrections; pixels below it are too_near"},
            IfAbsent{"the camera's working distance, or 0"}),
      Field("max_depth_m", r.max_depth_m, above(0),
            Help{"largest radial depth after all corrections; pixels above it are too_far"},
            IfAbsent{"the camera's working distance, or the range"}),
      Field("offset_map", r.offset_map,
            Help{"distance by which each pixel decodes too far, in metres (.npy .npz .exr .pfm), "
                 "subtracted from its depth; NaN marks a dead pixel"}),
      Field("offset_m", r.offset_m,
            Help{"distance by which every pixel decodes too far, subtracted from its depth"}),
      Field("gain_map", r.gain_map,
            Help{"response of each pixel relative to that of a usual one, removed from signal and "
                 "ambient; NaN marks a dead pixel"}),
      Field("memory_mb", r.memory_mb, left_open(0, 1e9),
            Help{"memory for frames in flight; larger frames are decoded in bands of rows. The "
                 "program itself takes some 50 MB more"}),
      Field("order", r.order, FieldMark::from_above),
      Field("policy", r.policy, FieldMark::from_above),
      Field("other_inputs", r.other_inputs, FieldMark::from_above));
}

/// How many pixels have which status.
class StatusCounts {
 public:
  void add(std::span<const PixelStatus> statuses);
  void add(const StatusCounts& other);
  std::int64_t of(PixelStatus status) const { return counts_[static_cast<std::size_t>(status)]; }
  std::int64_t pixels() const;

 private:
  std::array<std::int64_t, all_pixel_statuses.size()> counts_{};
};

/// What came of a recording.
struct DecodedRecording {
  int height = 0;
  int width = 0;
  int measurements = 0;
  int first_frame = 0;                       ///< that was asked for; means count as frames
  int frame_count = 0;                       ///< that were asked for; 0 before the work begins
  std::vector<DecodedPlane> outputs;         ///< the planes written
  std::vector<std::filesystem::path> files;  ///< of every finished frame; of a stack: of outputs
  std::vector<StatusCounts>
      frames;               ///< of every finished frame; no counts if nobody asked for them
  std::int64_t pixels = 0;  ///< decoded, over all frames
  double seconds = 0.0;
  std::vector<std::string> notes;  ///< what the user should know

  double frames_per_s() const { return static_cast<double>(frames.size()) / seconds; }
  double megapixels_per_s() const { return 1e-6 * static_cast<double>(pixels) / seconds; }
  StatusCounts total() const;
};

/// Decodes a recording of any length in memory that does not grow with it, in bands of rows, the
/// next of which is read meanwhile; with a filter, frame by frame. Each file appears whole or not
/// at all.
/// @param backend  its decoder's table defines the raw numbers
/// @throws std::invalid_argument "field = value; rule" for a request that cannot be, before any
///         file is written
/// @throws IoError as RawFramesReader, for maps that do not fit, outputs that exist, are inputs or
///         cannot hold a depth, and frames that need more than `memory_mb`
/// @throws Interrupted if progress says so; frames that are finished keep their files
/// @note the same bits for any number of threads and any memory
DecodedRecording decode_recording(const DecodeRequest& request, const FrameBackend& backend,
                                  const Progress& progress = {});
/// The same, with what is finished in `result` also when it throws.
/// @param result  filled frame by frame
void decode_recording(const DecodeRequest& request, const FrameBackend& backend,
                      const Progress& progress, DecodedRecording& result);

/// Fills bytes from a stream; gives how many, fewer only at its end.
using ReadStream = std::function<std::size_t(std::span<std::byte> into)>;
/// Takes bytes.
using WriteStream = std::function<void(std::span<const std::byte> bytes)>;

/// What came of a stream.
struct DecodedStream {
  int height = 0;  ///< of its frames; 0 before their description is read
  int width = 0;
  std::int64_t frames = 0;  ///< decoded and written
  StatusCounts statuses;    ///< of their pixels, if status is among the outputs
  double seconds = 0.0;     ///< until the last was written, waiting for them included
};

/// Decodes frames as they come, each written before the next is read: in the memory of a few
/// frames, with nothing held back but what a time filter is to look ahead. What comes out of a
/// frame are its planes, one after another in the order of the request's `outputs` (depth, if it
/// names none), of H x W items each, row by row, little end first: float32, status and returns
/// uint8, bin int32. The same numbers as in decode_recording().
/// @param request  its raw_format describes a stream: its header, then frame after frame; `raw`,
///                 `output`, `frame`, `stack`, `memory_mb` and `policy` say nothing
/// @param result   filled frame by frame, also when it throws
/// @throws std::invalid_argument, IoError as decode_recording(); IoError if the stream ends in a
///         frame, or ahead of the first; what `read` and `write` throw; Interrupted
void decode_stream(const DecodeRequest& request, const FrameBackend& backend,
                   const ReadStream& read, const WriteStream& write, const Progress& progress,
                   DecodedStream& result);

/// Writes what a decoder gave of a frame, by extension as DecodeRequest::output.
/// @param planes      not of .npy .pfm .png
/// @param view        of points (.ply, .pcd)
/// @param all_points  of pixels that are not ok, too
/// @throws std::invalid_argument for a plane that is not there; IoError for an unknown extension,
///         or as AtomicFile
void write_decoded(const std::filesystem::path& path, const DepthImage& image,
                   const std::vector<DecodedPlane>& planes, const PinholeView& view,
                   OutputPolicy policy, bool all_points = false);

}  // namespace tofsmith
