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
#include "tofsmith/io/raw_frames.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// What decoders say of every pixel of a frame, as the planes of DecodedView.
enum class DecodedPlane {
  depth,       ///< [m], float
  signal,      ///< [e/s], float
  ambient,     ///< [e/s], float
  confidence,  ///< in [0, 1], float
  deviation,   ///< predicted standard deviation of depth [m], float
  status,      ///< PixelStatus, uint8
  delay,       ///< of a second return [m], float
  ratio,       ///< of a second return, float
  returns,     ///< ReturnStatus, uint8
  bin,         ///< of zncc the one that scores best, of others the nearest; int32
  averaged,    ///< of how many measurements a pixel's numbers are the mean, in variance; float
  residual,    ///< chi-square per degree of freedom, float
};

inline constexpr std::array all_decoded_planes = {
    DecodedPlane::depth,     DecodedPlane::signal, DecodedPlane::ambient,  DecodedPlane::confidence,
    DecodedPlane::deviation, DecodedPlane::status, DecodedPlane::delay,    DecodedPlane::ratio,
    DecodedPlane::returns,   DecodedPlane::bin,    DecodedPlane::averaged, DecodedPlane::residual};

/// "depth", "signal", ..: the word of the enumerator, which arrays of .npz files have too.
std::string_view name_of(DecodedPlane plane);
/// @throws std::invalid_argument for any other word
DecodedPlane parse_decoded_plane(std::string_view name);
/// The planes that are written unless others are asked for: depth to status; of decoders of several
/// returns also delay, ratio and returns. Not bin, averaged and residual.
std::vector<DecodedPlane> usual_planes(bool multipath = false);

/// Which distance is written as depth.
enum class DepthKind {
  radial,  ///< along the ray, as the camera measures it
  z,       ///< along the optical axis
};

/// "radial", "z".
std::string_view name_of(DepthKind kind);
/// @throws std::invalid_argument for any other word
DepthKind parse_depth_kind(std::string_view name);

/// Whether an output of this name holds points: .ply, .pcd.
bool holds_points(const std::filesystem::path& path);

/// A recording to be decoded into files.
struct DecodeRequest {
  /// .npy, .npz or .h5, (H, W, K) or (F, H, W, K), of any size; or K files, one a measurement in
  /// their order, (H, W) or (F, H, W) each.
  std::vector<std::filesystem::path> raw;
  RawLayout layout = RawLayout::interleaved;  ///< of one .npy, .npz or .h5; never guessed
  std::string dataset;  ///< of .npz and .h5; empty: the one called raw, or the only one
  std::filesystem::path raw_format;  ///< describes a sensor's dump (*.raw.toml); empty: no dump

  /// .npy .pfm .png (16 bits, mm): depth alone; .npz: an array of each plane; .exr: a channel of
  /// each; .ply, .pcd (organized): points with planes as scalars. Files of several frames get
  /// numbers: name-03.npz.
  std::filesystem::path output;
  std::vector<DecodedPlane> outputs;   ///< others are not computed; empty: what `output` holds
  DepthKind kind = DepthKind::radial;  ///< .ply and .pcd hold points either way
  bool all_points = false;             ///< in .ply and .pcd; else those of pixels that are ok
  /// Of points and z; none: a view 60 degrees wide. Pixels that see nothing, by a map of rays, are
  /// invalid.
  std::optional<Lens> lens;
  /// Planes are those of the ideal pinhole, without the lens's distortion: each pixel takes the
  /// values of the nearest one, and its depth along the axis. Pixels that the lens does not see are
  /// invalid. Needs a lens; nothing changes without distortion.
  bool undistort = false;
  std::optional<int> frame;  ///< this one alone, counted from 0; none: all
  bool stack = false;        ///< all frames in one .npy a plane, name-PLANE.npy
  /// Means of so many consecutive frames are decoded, as frames of their own with a noise so much
  /// smaller; the last one is of those that are left. What is invalid or saturated in one is so in
  /// the mean. `frame` counts means. From 1 to the number of frames.
  int average = 1;
  /// Exposures of so many consecutive frames, over the shortest, which is the camera's:
  /// merge_exposures() makes one of them. Empty: none. The recording holds whole groups; `frame`
  /// counts those. Goes without `average`.
  std::vector<double> hdr;
  /// Image of shares that StrayLight takes off each frame before all else (.npy, ..); empty: none.
  std::filesystem::path stray_light;
  /// Of how many equal measurements each raw number is the mean already, > 0: their noise is so
  /// much smaller. With `average` it multiplies.
  double averaged = 1.0;
  /// Of the frames, or means of frames, one after another: what stays the same is added up. `frame`
  /// counts all frames before it in, and with `look_ahead` those after it. With `filter` it is
  /// `before_filter`. None: each frame for itself.
  std::optional<TimeFilterOptions> time_filter;
  std::optional<FilterOptions> filter;  ///< of each frame that comes of that; none: not filtered
  std::optional<MixedPixels> mixed;     ///< mark_mixed_pixels() of each frame; none: not looked for
  std::filesystem::path offset_map;     ///< [m], as PixelMaps::delay_offset_m; empty: none
  double offset_m = 0.0;                ///< of every pixel, beside that of its map [m]
  std::filesystem::path gain_map;       ///< as PixelMaps::gain; empty: none
  double memory_mb = 256.0;             ///< for frames under way [MB], > 0
  OutputPolicy policy = OutputPolicy::refuse_existing;
  std::vector<std::string> other_inputs;  ///< files that were read too: no output replaces them
};

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
///         cannot hold the range, and frames that need more than `memory_mb`
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
/// @param planes      of depth, signal, ambient, confidence, deviation, status; not of .npy .pfm
///                    .png
/// @param view        of points (.ply, .pcd)
/// @param all_points  of pixels that are not ok, too
/// @throws std::invalid_argument for a plane that is not there; IoError for an unknown extension,
///         or as AtomicFile
void write_decoded(const std::filesystem::path& path, const DepthImage& image,
                   const std::vector<DecodedPlane>& planes, const PinholeView& view,
                   OutputPolicy policy, bool all_points = false);

}  // namespace tofsmith
