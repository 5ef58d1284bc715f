// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"

namespace tofsmith {

struct DecodingTable;
struct DepthCorrection;

/// Status of a decoded pixel. If several apply, the first of invalid, saturated, no_return,
/// low_signal, inconsistent, too_near, too_far, ambiguous is reported. Only mark_mixed_pixels()
/// sets mixed, and only depth limits set too_near and too_far.
enum class PixelStatus : std::uint8_t {
  ok = 0,
  invalid = 1,     ///< a measurement is NaN or infinite: no depth
  no_return = 2,   ///< no depth explains the pixel with positive signal: no depth
  saturated = 3,   ///< a measurement is clipped: the depth may have a large error
  low_signal = 4,  ///< the signal does not exceed its noise
  ambiguous = 5,   ///< another depth, far from this one, explains the pixel almost as well
  /// The pixel sees two surfaces at an edge. Its depth belongs to neither of them, or is that of a
  /// neighbour (MixedPixels::snap).
  mixed = 6,
  inconsistent = 7,  ///< no depth explains the measurements within their noise
  too_near = 8,      ///< the depth is below the depth limits: no depth
  too_far = 9,       ///< the depth is above the depth limits: no depth
};

inline constexpr std::array all_pixel_statuses = {
    PixelStatus::ok,        PixelStatus::invalid,      PixelStatus::no_return,
    PixelStatus::saturated, PixelStatus::low_signal,   PixelStatus::ambiguous,
    PixelStatus::mixed,     PixelStatus::inconsistent, PixelStatus::too_near,
    PixelStatus::too_far};

/// "ok", "invalid", "no_return", "saturated", "low_signal", "ambiguous", "mixed", "inconsistent",
/// "too_near", "too_far".
std::string_view name_of(PixelStatus status);

/// Number of returns in a pixel. It is independent of PixelStatus, which reports whether the depth
/// of a single return is reliable: a saturated pixel may have two returns.
enum class ReturnStatus : std::uint8_t {
  none = 0,        ///< no depth: invalid or no return
  single = 1,      ///< one return explains the pixel
  two = 2,         ///< a second return, or a tail, lowers chi^2 by more than the threshold
  unresolved = 3,  ///< neither one return nor two explain the pixel: the depth is that of one
                   ///< return and may be biased
};

inline constexpr std::array all_return_statuses = {ReturnStatus::none, ReturnStatus::single,
                                                   ReturnStatus::two, ReturnStatus::unresolved};

/// "none", "single", "two", "unresolved".
std::string_view name_of(ReturnStatus status);

/// Origin of a plane, and whether it is written by default.
enum class PlaneUse {
  usual,       ///< from every decoder; written by default
  on_request,  ///< from every decoder
  of_returns,  ///< from decoders of several returns, which write it by default
  of_frames    ///< only from decode_frame(), computed from the raw numbers of the frame
};

// All planes of a decoded frame. Structs, names, help texts, files and Python classes are derived
// from this list. The member of DepthImage and DecodedView includes the unit; the word is the name
// on the command line and in files.
//   PLANE(type of a pixel, member, word, unit, use, help)
#define TOFSMITH_DECODED_PLANES(PLANE)                                                          \
  PLANE(float, depth_m, depth, "m", usual, "distance along the ray, in [0, range)")             \
  PLANE(float, signal_e_per_s, signal, "e/s", usual,                                            \
        "signal of the return, also called amplitude")                                          \
  PLANE(float, ambient_e_per_s, ambient, "e/s", usual,                                          \
        "ambient light, NaN if it cancels in differences")                                      \
  PLANE(float, confidence, confidence, "", usual,                                               \
        "probability that the depth lies in the main lobe")                                     \
  PLANE(float, deviation_m, deviation, "m", usual,                                              \
        "predicted standard deviation of the depth, given that it is in the correct peak")      \
  PLANE(PixelStatus, status, status, "", usual, "reliability of the depth")                     \
  PLANE(float, delay_m, delay, "m", of_returns, "delay of the second return, NaN without one")  \
  PLANE(float, ratio, ratio, "", of_returns,                                                    \
        "light of the second return relative to the first, NaN without a second")               \
  PLANE(ReturnStatus, returns, returns, "", of_returns, "number of returns")                    \
  PLANE(std::int32_t, bin, bin, "", on_request,                                                 \
        "best bin (zncc) or nearest bin (other methods), -1 where a measurement is not finite") \
  PLANE(float, averaged, averaged, "", of_frames, "number of averaged measurements")            \
  PLANE(float, residual, residual, "", on_request,                                              \
        "chi-square of the measurements per degree of freedom, NaN without degrees of freedom")

/// A plane of a decoded frame.
enum class DecodedPlane {
#define TOFSMITH_PLANE(type, member, word, unit, use, help) word,
  TOFSMITH_DECODED_PLANES(TOFSMITH_PLANE)
#undef TOFSMITH_PLANE
};

struct PlaneDescription {
  DecodedPlane plane;
  std::string_view word, member, unit;
  PlaneUse use;
  std::string_view help;

  constexpr bool is_of_every_decoder() const {
    return use == PlaneUse::usual || use == PlaneUse::on_request;
  }
};
/// Descriptions in the order of DecodedPlane.
inline constexpr std::array plane_descriptions = {
#define TOFSMITH_PLANE(type, member, word, unit, use, help) \
  PlaneDescription{DecodedPlane::word, #word, #member, unit, PlaneUse::use, help},
    TOFSMITH_DECODED_PLANES(TOFSMITH_PLANE)
#undef TOFSMITH_PLANE
};
constexpr const PlaneDescription& description_of(DecodedPlane plane) {
  return plane_descriptions.at(static_cast<std::size_t>(plane));
}

constexpr auto words_of(DecodedPlane /*any*/) {
  std::array<std::string_view, plane_descriptions.size()> words;
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = plane_descriptions[i].word;
  return words;
}
/// Another name of a plane.
struct PlaneSynonym {
  std::string_view name;
  DecodedPlane plane;
};
inline constexpr std::array plane_synonyms = {PlaneSynonym{"amplitude", DecodedPlane::signal}};

/// Returns the word of a plane for a synonym and for its name with unit ("deviation_m").
constexpr std::string_view usual_word(DecodedPlane /*any*/, std::string_view name) {
  for (const PlaneSynonym& synonym : plane_synonyms)
    if (name == synonym.name) return description_of(synonym.plane).word;
  for (const PlaneDescription& described : plane_descriptions)
    if (name == described.member) return described.word;
  return name;
}
/// "depth", "signal", ...: the word of the enumerator.
std::string_view name_of(DecodedPlane plane);
/// Returns the plane of a word, a synonym or a name with unit; see usual_word().
/// @throws std::invalid_argument for any other word
DecodedPlane parse_decoded_plane(std::string_view name);
/// Returns the help text of a plane, with the meaning of its status codes and the methods that fill
/// it.
std::string help_of(DecodedPlane plane);
/// Returns the planes that are written by default.
/// @param multipath  for decoders of several returns
std::vector<DecodedPlane> usual_planes(bool multipath = false);

/// The value of a plane at pixels without depth.
template <typename Value>
inline constexpr Value no_value = std::numeric_limits<Value>::quiet_NaN();
template <>
inline constexpr std::int32_t no_value<std::int32_t> = -1;
template <>
inline constexpr PixelStatus no_value<PixelStatus> = PixelStatus::invalid;
template <>
inline constexpr ReturnStatus no_value<ReturnStatus> = ReturnStatus::none;

/// Planes of a decoded frame, (H, W) each or empty. Pixels without depth (invalid, no_return,
/// too_near, too_far) are NaN in every plane of floats.
struct DepthImage {
#define TOFSMITH_PLANE(type, member, word, unit, use, help) Image<type> member;
  TOFSMITH_DECODED_PLANES(TOFSMITH_PLANE)
#undef TOFSMITH_PLANE

  DepthImage() = default;
  /// Allocates the usual planes.
  DepthImage(int height, int width) : DepthImage(usual_planes(), height, width) {}
  DepthImage(const std::vector<DecodedPlane>& planes, int height, int width);
  int height() const { return status.height; }
  int width() const { return status.width; }
};

/// Output of a decoder: planes of H x W values, row by row, in the caller's memory. Null planes are
/// skipped, together with all work that only they need. Owns nothing.
struct DecodedView {
#define TOFSMITH_PLANE(type, member, word, unit, use, help) type* member = nullptr;
  TOFSMITH_DECODED_PLANES(TOFSMITH_PLANE)
#undef TOFSMITH_PLANE

  bool wants_bins_only() const;
  /// Returns the planes that are not null.
  std::vector<DecodedPlane> planes() const;
  /// Returns a view of all planes of an image that are not empty.
  static DecodedView of(DepthImage& image);
  /// Returns a view of the same planes that begins at a later pixel.
  DecodedView from(std::size_t pixel) const;
};

/// Calls `use` with the given plane of every argument `of`. A DepthImage provides an Image, a
/// DecodedView a pointer.
template <typename Use, typename... Planes>
auto with_plane(DecodedPlane plane, const Use& use, Planes&... of) {
#define TOFSMITH_PLANE(type, member, word, unit, use_of, help) \
  if (plane == DecodedPlane::word) return use(of.member...);
  TOFSMITH_DECODED_PLANES(TOFSMITH_PLANE)
#undef TOFSMITH_PLANE
  throw std::invalid_argument("plane: not a value of DecodedPlane");
}

/// Calls `use` with every plane in turn; see with_plane().
template <typename Use, typename... Planes>
void for_each_plane(const Use& use, Planes&... of) {
#define TOFSMITH_PLANE(type, member, word, unit, use_of, help) use(of.member...);
  TOFSMITH_DECODED_PLANES(TOFSMITH_PLANE)
#undef TOFSMITH_PLANE
}
#undef TOFSMITH_DECODED_PLANES

/// Calibration of the individual pixels of a sensor. Maps have the size of its frames. An empty map
/// is not applied; NaN in a map marks a dead pixel.
struct PixelMaps {
  Image<float> delay_offset_m;  ///< (H, W): distance by which a pixel decodes too far [m], any sign
  Image<float> gain;            ///< (H, W): response relative to that of a usual pixel, > 0

  bool empty() const { return delay_offset_m.empty() && gain.empty(); }
  /// @throws std::invalid_argument naming the map, its size and the frames' size, or the pixel that
  ///         is infinite or not > 0
  void validate(int height, int width) const;
};

/// Corrects `count` decoded pixels from `first` on (row by row) in place: depth becomes depth -
/// offset, wrapped into [0, range); signal and ambient are divided by the gain. Confidence and
/// deviation do not change, because shot noise depends on the collected electrons. Bins do not
/// change either, because they refer to the table. Dead pixels become invalid, without depth.
/// @param maps     valid for the frame
/// @param range_m  range of the decoding table [m]
/// @param decoded  planes whose first value belongs to pixel `first`
/// @throws std::invalid_argument if the pixels do not lie within a map
void apply(const PixelMaps& maps, double range_m, const DecodedView& decoded, std::size_t first,
           std::size_t count);

/// Subtracts a calibrated depth error from the depths of `count` pixels from `first` on (row by
/// row). Depths wrap into [0, range). Must be called before the PixelMaps are applied. Pixels
/// without depth do not change.
/// @param decoded  planes whose first value belongs to pixel `first`; the signal is required if the
///                 correction depends on it
/// @throws std::invalid_argument if the correction is not for frames of `height` x `width`, or a
///         required plane is null
void apply(const DepthCorrection& correction, double range_m, const DecodedView& decoded,
           int height, int width, std::size_t first, std::size_t count);

/// Treatment of pixels at depth edges that see two surfaces.
enum class MixedPixels {
  label,  ///< status mixed; the decoded depth is kept
  snap,   ///< status mixed; depth of the nearest pixel of the surface that gives more light
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

/// Data of filtered pixels before filtering.
struct UnfilteredPixels {
  const RawView* measured = nullptr;  ///< unfiltered measurements, (H, W, K)
  /// (H, W), or empty: pixels with nonzero values were found mixed before and excluded from the
  /// filter. They stay mixed.
  Image<std::uint8_t> mixed = {};
};

/// Finds flying pixels in a decoded frame: pixels that see two surfaces at a depth edge, because
/// the lens blurs the image.
///
/// The candidate surfaces of a pixel consist of pixels of its 9 x 9 neighbourhood. The depth of
/// each of these pixels agrees with that of at least six of its eight neighbours, apart from the
/// local slope. The light of two candidates is fitted to the measurements by weighted least
/// squares,
///   y = S1 x(z1) + S2 x(z2) + A a,  S1, S2 > 0.
/// The pixel is mixed if this model explains its measurements better than either surface alone, and
/// not much worse than a single return at the decoded depth. If the decoded depth matches a
/// candidate, the model must be much better than the single return. A filtered pixel is also mixed
/// if its unfiltered measurements pass the test, because averaging over neighbours hides mixed
/// light. With rank 2 (K = 3), two returns fit any measurement, and no pixel is marked. Pixels that
/// are invalid, saturated or without depth do not change.
/// @param table    table of the decoder
/// @param raw      numbers that were decoded; if filtered, with the number of averaged measurements
/// @param maps     maps that were applied to `decoded`
/// @param decoded  whole frame, modified in place: depth_m, deviation_m and
///                 status are required; snap writes depth_m, its deviation, and status
/// @param unfiltered  required if `raw` is filtered
/// @return number of marked pixels
/// @throws std::invalid_argument if the shapes do not match or a required plane is null;
///         Interrupted if `progress` requests it
/// @note the same bits for any number of threads
std::int64_t mark_mixed_pixels(const DecodingTable& table, const RawView& raw, MixedPixels mixed,
                               const DecodedView& decoded, const PixelMaps& maps = {},
                               const Progress& progress = {},
                               const UnfilteredPixels& unfiltered = {});

}  // namespace tofsmith
