// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"

namespace tofsmith {

struct DecodingTable;
struct DepthCorrection;

/// Outcome of a pixel. If several apply, the first of invalid, saturated, no_return, low_signal,
/// inconsistent, ambiguous is reported. Only mark_mixed_pixels() sets mixed.
enum class PixelStatus : std::uint8_t {
  ok = 0,
  invalid = 1,     ///< a measurement is NaN or infinite: no depth
  no_return = 2,   ///< no depth explains the pixel with positive signal: no depth
  saturated = 3,   ///< a measurement is clipped: the depth may be far off
  low_signal = 4,  ///< the signal does not stand out of its noise
  ambiguous = 5,   ///< another depth, far from this one, explains the pixel almost as well
  mixed = 6,  ///< sees two surfaces at an edge: the depth is that of neither, or of a neighbour
  inconsistent = 7,  ///< no depth explains the measurements within their noise
};

inline constexpr std::array all_pixel_statuses = {
    PixelStatus::ok,        PixelStatus::invalid,     PixelStatus::no_return,
    PixelStatus::saturated, PixelStatus::low_signal,  PixelStatus::ambiguous,
    PixelStatus::mixed,     PixelStatus::inconsistent};

/// "ok", "invalid", "no_return", "saturated", "low_signal", "ambiguous", "mixed", "inconsistent".
std::string_view name_of(PixelStatus status);

/// How many returns a pixel shows. It stands beside PixelStatus, which says whether the depth of a
/// single return can be trusted: a pixel may be saturated and still be two returns.
enum class ReturnStatus : std::uint8_t {
  none = 0,        ///< no depth: invalid or no return at all
  single = 1,      ///< one return explains the pixel
  two = 2,         ///< a second return, or a tail, explains it better by more than the threshold
  unresolved = 3,  ///< one return does not explain it, and neither does a second: the depth is that
                   ///< of one return and may be biased
};

inline constexpr std::array all_return_statuses = {ReturnStatus::none, ReturnStatus::single,
                                                   ReturnStatus::two, ReturnStatus::unresolved};

/// "none", "single", "two", "unresolved".
std::string_view name_of(ReturnStatus status);

/// What a decoder says about every pixel of a frame; all planes are (H, W). Pixels without depth
/// (invalid, no_return) hold NaN in every plane but status.
struct DepthImage {
  Image<float> depth_m;          ///< distance along the ray [m], in [0, range)
  Image<float> signal_e_per_s;   ///< S [e/s]
  Image<float> ambient_e_per_s;  ///< A [e/s]; NaN where differences hide it; noise may make it < 0
  Image<float> confidence;       ///< that no far-off depth is the true one, in [0, 1]
  Image<float> predicted_standard_deviation_m;  ///< of depth around the right peak [m]
  Image<PixelStatus> status;
  Image<float> residual;  ///< as DecodedView::residual; empty unless the caller gives it a size

  DepthImage() = default;
  DepthImage(int height, int width);
  int height() const { return status.height; }
  int width() const { return status.width; }
};

/// Where a decoder writes: planes of H x W values, row by row, in the caller's memory. A null plane
/// is not wanted, and what only it needs is not computed. Owns nothing.
struct DecodedView {
  std::int32_t* bin = nullptr;       ///< as decode_bins of the decoder: in [0, N), or -1
  float* depth_m = nullptr;          ///< as the planes of DepthImage
  float* signal_e_per_s = nullptr;   ///< [e/s]
  float* ambient_e_per_s = nullptr;  ///< [e/s]
  float* confidence = nullptr;       ///< in [0, 1]
  float* predicted_standard_deviation_m = nullptr;  ///< [m]
  PixelStatus* status = nullptr;
  /// Chi-square per degree of freedom of the measurements around the decoded depth, signal and
  /// ambient light: 1 on average. NaN where the code leaves no degree of freedom.
  float* residual = nullptr;
  // Of decoders of several returns; others leave them as they are.
  float* delay_m = nullptr;  ///< as the planes of MultipathImage
  float* ratio = nullptr;
  ReturnStatus* returns = nullptr;

  bool wants_bins_only() const;
  /// All planes of an image that have a size; no bins.
  static DecodedView of(DepthImage& image);
  /// The same planes from a later pixel on.
  DecodedView from(std::size_t pixel) const;
};

/// What differs from pixel to pixel of a sensor, of the size of its frames. A map left empty is not
/// applied; NaN in a map marks a dead pixel.
struct PixelMaps {
  Image<float> delay_offset_m;  ///< (H, W): by how much a pixel decodes too far [m], any sign
  Image<float> gain;            ///< (H, W): response of a pixel over that of a usual one, > 0

  bool empty() const { return delay_offset_m.empty() && gain.empty(); }
  /// @throws std::invalid_argument naming the map, its size and the frames', or the pixel that is
  ///         infinite or not > 0
  void validate(int height, int width) const;
};

/// Corrects decoded pixels first .. first + count - 1 (row by row) in place: depth becomes depth -
/// offset, wrapped into [0, range); signal and ambient are divided by the gain. Confidence and
/// deviation stay, because shot noise is that of the electrons seen, and so do bins, which say
/// which row of the table fits. Dead pixels become invalid, without depth.
/// @param maps     valid for the frame
/// @param range_m  of the decoding table [m]
/// @param decoded  planes whose first value is that of pixel `first`
/// @throws std::invalid_argument if the pixels do not lie within a map
void apply(const PixelMaps& maps, double range_m, const DecodedView& decoded, std::size_t first,
           std::size_t count);

/// Takes what a calibration found off decoded depths, which wrap into [0, range), of `count`
/// pixels from `first` on (row by row), ahead of their maps. Pixels without depth stay as they are.
/// @param decoded  planes whose first value is that of pixel `first`; the signal is needed
///                 where the correction has terms in it
/// @throws std::invalid_argument if the frame, `height` x `width`, has another size, or a
///         plane that is needed is null
void apply(const DepthCorrection& correction, double range_m, const DecodedView& decoded,
           int height, int width, std::size_t first, std::size_t count);

/// What is done with pixels at edges of depth that see two surfaces at once.
enum class MixedPixels {
  label,  ///< status mixed; the depth stays as it was decoded
  snap,   ///< status mixed; the depth of the nearest pixel of the surface that gives more light
  drop,   ///< status mixed; no depth: NaN in every plane of floats
};

inline constexpr std::array all_mixed_pixels = {MixedPixels::label, MixedPixels::snap,
                                                MixedPixels::drop};

constexpr std::array<std::string_view, 3> words_of(MixedPixels /*any*/) {
  return {"label", "snap", "drop"};
}
/// "label", "snap", "drop".
std::string_view name_of(MixedPixels mixed);
/// @throws std::invalid_argument for any other word
MixedPixels parse_mixed_pixels(std::string_view name);

/// What is known of filtered pixels beside what their filter gave.
struct UnfilteredPixels {
  const RawView* measured = nullptr;  ///< their own numbers, (H, W, K)
  /// (H, W), or empty: where not 0, mark_mixed_pixels() found the pixel mixed before, and the
  /// filter left it out. It stays mixed.
  Image<std::uint8_t> mixed = {};
};

/// Finds pixels of a decoded frame that see two surfaces, as lenses make them at edges of depth.
///
/// In the 7 x 7 pixels around a pixel, those whose depth most of their own neighbours share, along
/// the slope that they show, make the surfaces. A pixel with none of their depths is mixed where
/// the light of two of them,
///   y = S1 x(z1) + S2 x(z2) + A a,  S1, S2 > 0,
/// explains its measurements, by weighted least squares, far better than that of either one alone,
/// within noise, and not much worse than a single return at the depth decoded. Of a filtered pixel
/// its own numbers are asked, too: a filter adds what lies beside it, which hides what it sees.
/// With rank 2, as K = 3, anything is explained by two returns: nothing is marked. Pixels that are
/// invalid, saturated or have no depth stay as they are.
/// @param table    of the decoder
/// @param raw      what was decoded: filtered numbers with how many measurements they are the mean
/// of
/// @param maps     those applied to `decoded`
/// @param decoded  whole frame, in place: depth_m, predicted_standard_deviation_m and status are
///                 needed; snap writes depth_m, the deviation of that depth, and status
/// @param unfiltered  where `raw` is filtered
/// @return how many pixels are marked
/// @throws std::invalid_argument if the shapes do not fit or a plane that is needed is null;
///         Interrupted if progress says so
/// @note the same bits for any number of threads
std::int64_t mark_mixed_pixels(const DecodingTable& table, const RawView& raw, MixedPixels mixed,
                               const DecodedView& decoded, const PixelMaps& maps = {},
                               const Progress& progress = {},
                               const UnfilteredPixels& unfiltered = {});

}  // namespace tofsmith
