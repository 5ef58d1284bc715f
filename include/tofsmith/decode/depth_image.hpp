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

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"

namespace tofsmith {

struct DecodingTable;
struct DepthCorrection;

/// Status of a decoded pixel. If several apply, the first of invalid, saturated, no_return,
/// low_signal, inconsistent, too_near, too_far, ambiguous is reported. Only mark_mixed_pixels()
/// sets mixed.
enum class PixelStatus : std::uint8_t {
  ok = 0,
  invalid = 1,     ///< a measurement is NaN or infinite: no depth
  no_return = 2,   ///< no depth explains the pixel with positive signal: no depth
  saturated = 3,   ///< a measurement is clipped: possibly far off
  low_signal = 4,  ///< the signal does not exceed its noise
  ambiguous = 5,   ///< another, distant depth explains the pixel almost as well
  /// The pixel sees two surfaces at an edge; its depth may belong to neither.
  mixed = 6,
  inconsistent = 7,  ///< no depth explains the measurements within their noise
  too_near = 8,      ///< below the depth limits: no depth
  too_far = 9,       ///< above the depth limits: no depth
};

constexpr auto words_of(PixelStatus /*any*/) {
  return word_list("ok", "invalid", "no_return", "saturated", "low_signal", "ambiguous", "mixed",
                   "inconsistent", "too_near", "too_far");
}
inline constexpr auto all_pixel_statuses = all_values<PixelStatus>;

/// Number of returns in a pixel, independent of PixelStatus.
enum class ReturnStatus : std::uint8_t {
  none = 0,
  single = 1,
  two = 2,         ///< a second return, or a tail, lowers chi^2 by more than the threshold
  unresolved = 3,  ///< neither one return nor two explain the pixel: the depth of one return,
                   ///< possibly biased
};

constexpr auto words_of(ReturnStatus /*any*/) {
  return word_list("none", "single", "two", "unresolved");
}

/// Origin of a plane, and whether it is written by default. A GPU computes only the first two.
enum class PlaneUse {
  usual,       ///< from every decoder, by default
  on_request,  ///< from every decoder
  of_returns,  ///< from decoders of several returns, by default
  of_frames    ///< from decode_frame(), computed on the CPU from the raw numbers
};

// All planes of a decoded frame, from which structs, names, help texts, files and Python classes
// are derived. The word is the name on the command line and in files.
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
        "predicted standard deviation of a depth in the main lobe")                             \
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
struct PlaneSynonym {
  std::string_view name;
  DecodedPlane plane;
};
inline constexpr std::array plane_synonyms = {PlaneSynonym{"amplitude", DecodedPlane::signal}};

/// Returns the word for a synonym or a name with unit ("deviation_m").
constexpr std::string_view usual_word(DecodedPlane /*any*/, std::string_view name) {
  for (const PlaneSynonym& synonym : plane_synonyms)
    if (name == synonym.name) return description_of(synonym.plane).word;
  for (const PlaneDescription& described : plane_descriptions)
    if (name == described.member) return described.word;
  return name;
}
/// Returns the help text with status codes and the methods that fill the plane.
std::string help_of(DecodedPlane plane);
/// @param multipath  for decoders of several returns
std::vector<DecodedPlane> usual_planes(bool multipath = false);

/// Value at pixels without depth.
template <typename Value>
inline constexpr Value no_value = std::numeric_limits<Value>::quiet_NaN();
template <>
inline constexpr std::int32_t no_value<std::int32_t> = -1;
template <>
inline constexpr PixelStatus no_value<PixelStatus> = PixelStatus::invalid;
template <>
inline constexpr ReturnStatus no_value<ReturnStatus> = ReturnStatus::none;

/// Planes of a decoded frame, (H, W) each or empty. Planes of floats are NaN without depth
/// (invalid, no_return, too_near, too_far).
struct DepthImage {
#define TOFSMITH_PLANE(type, member, word, unit, use, help) Image<type> member;
  TOFSMITH_DECODED_PLANES(TOFSMITH_PLANE)
#undef TOFSMITH_PLANE

  DepthImage() = default;
  DepthImage(int height, int width) : DepthImage(usual_planes(), height, width) {}
  DepthImage(const std::vector<DecodedPlane>& planes, int height, int width);
  int height() const { return status.height; }
  int width() const { return status.width; }
};

/// Planes of H x W values, row by row, in the caller's memory. Null planes are skipped, with all
/// work that only they need.
struct DecodedView {
#define TOFSMITH_PLANE(type, member, word, unit, use, help) type* member = nullptr;
  TOFSMITH_DECODED_PLANES(TOFSMITH_PLANE)
#undef TOFSMITH_PLANE

  bool wants_bins_only() const;
  std::vector<DecodedPlane> planes() const;
  /// Returns a view of all non-empty planes of an image.
  static DecodedView of(DepthImage& image);
  /// Returns a view that begins at a later pixel.
  DecodedView from(std::size_t pixel) const;
};

/// Calls `use` with a plane of every argument: an Image of a DepthImage, a pointer of a
/// DecodedView.
template <typename Use, typename... Planes>
auto with_plane(DecodedPlane plane, const Use& use, Planes&... of) {
#define TOFSMITH_PLANE(type, member, word, unit, use_of, help) \
  if (plane == DecodedPlane::word) return use(of.member...);
  TOFSMITH_DECODED_PLANES(TOFSMITH_PLANE)
#undef TOFSMITH_PLANE
  throw std::invalid_argument("plane: not a value of DecodedPlane");
}

/// Calls with_plane() for every plane.
template <typename Use, typename... Planes>
void for_each_plane(const Use& use, Planes&... of) {
#define TOFSMITH_PLANE(type, member, word, unit, use_of, help) use(of.member...);
  TOFSMITH_DECODED_PLANES(TOFSMITH_PLANE)
#undef TOFSMITH_PLANE
}
#undef TOFSMITH_DECODED_PLANES

/// Calibration of the individual pixels of a sensor, of the size of its frames. Empty maps are not
/// applied; NaN marks a dead pixel.
struct PixelMaps {
  Image<float> delay_offset_m;  ///< distance by which a pixel decodes too far
  Image<float> gain;            ///< response relative to a usual pixel, > 0

  bool empty() const { return delay_offset_m.empty() && gain.empty(); }
  /// @throws InvalidArgument if a size differs, or a pixel is infinite or not > 0
  void validate(int height, int width) const;
};

/// Corrects `count` decoded pixels from `first` on in place: subtracts the offset from the depth,
/// which wraps into [0, range), and divides signal and ambient by the gain. Dead pixels become
/// invalid.
/// @param decoded  planes whose first value belongs to pixel `first`
/// @throws InvalidArgument if the pixels do not lie within a map
void apply(const PixelMaps& maps, double range_m, const DecodedView& decoded, std::size_t first,
           std::size_t count);

/// Subtracts a calibrated depth error from `count` pixels from `first` on; depths wrap into [0,
/// range). Must be called before the PixelMaps are applied.
/// @param decoded  planes whose first value belongs to pixel `first`
/// @throws InvalidArgument if the correction is not for frames of `height` x `width`, or depth, or
///         a signal on which the correction depends, is null
void apply(const DepthCorrection& correction, double range_m, const DecodedView& decoded,
           int height, int width, std::size_t first, std::size_t count);

/// Treatment of pixels that see two surfaces at a depth edge; all get the status mixed.
enum class MixedPixels {
  label,  ///< the decoded depth is kept
  snap,   ///< depth of the nearest pixel of the surface that gives more light
  drop,   ///< no depth: NaN in every plane of floats
};

constexpr auto words_of(MixedPixels /*any*/) { return word_list("label", "snap", "drop"); }

/// Data before filtering.
struct UnfilteredPixels {
  const RawView* measured = nullptr;  ///< (H, W, K)
  /// (H, W), or empty: nonzero pixels were found mixed before and excluded from the filter. They
  /// stay mixed.
  Image<std::uint8_t> mixed = {};
};

/// Finds flying pixels in a decoded frame: pixels that see two surfaces at a depth edge, because
/// the lens blurs the image.
///
/// The light of two surfaces in the 9 x 9 neighbourhood is fitted by weighted least squares,
///   y = S1 x(z1) + S2 x(z2) + A a,  S1, S2 > 0.
/// The pixel is mixed if this explains its measurements better than either surface alone, and not
/// much worse than a single return. For filtered pixels, it suffices that the unfiltered
/// measurements pass the test. With rank 2 (K = 3), no pixel is marked, because two returns fit any
/// measurement.
/// @param raw      numbers that were decoded
/// @param maps     applied to `decoded`
/// @param decoded  whole frame, modified in place; depth_m, deviation_m and status are required
/// @param unfiltered  required if `raw` is filtered
/// @return number of marked pixels
/// @throws InvalidArgument if the shapes do not match or a required plane is null
/// @see docs/filtering.md
std::int64_t mark_mixed_pixels(const DecodingTable& table, const RawView& raw, MixedPixels mixed,
                               const DecodedView& decoded, const PixelMaps& maps = {},
                               const Progress& progress = {},
                               const UnfilteredPixels& unfiltered = {});

}  // namespace tofsmith
