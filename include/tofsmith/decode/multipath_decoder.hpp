// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/depth_image.hpp"

namespace tofsmith {

/// Prior distribution of multipath returns; depth has a uniform prior. It affects the result if
/// there is little light.
struct ReturnPrior {
  double single_probability = 0.5;
  double mean_delay_m = 0.5;
  double max_ratio = 0.5;
};
auto fields_of(ConstOrNot<ReturnPrior> auto& p) {
  return std::tuple(Field("single_probability", p.single_probability, right_open(0, 1),
                          Help{"prior probability that there is no second return"}),
                    Field("mean_delay_m", p.mean_delay_m, above(0),
                          Help{"mean of the exponential prior of the delay"}),
                    Field("max_ratio", p.max_ratio, left_open(0, 1),
                          Help{"upper end of the uniform prior of the ratio"}));
}

/// Options of multipath decoding.
struct MultipathOptions {
  /// In about 1 % of pixels with a single return, chi^2 exceeds 9.
  double threshold = 9.0;
  double shortest_delay_m = 0.1;
  std::optional<double> longest_delay_m;  ///< above the shortest and below the range
  double tail_m = 0.5;                    ///< at most the range
  std::optional<ReturnPrior> prior;
  DecodeOptions status_thresholds;  ///< of the single return

  /// @throws std::invalid_argument naming field, value and rule
  void validate(double range_m) const;
};
auto fields_of(ConstOrNot<MultipathOptions> auto& o) {
  return std::tuple(
      Field("threshold", o.threshold, at_least(0),
            Help{"decrease of chi^2 above which a second return is accepted"}),
      Field("shortest_delay_m", o.shortest_delay_m, above(0),
            Help{"shortest delay of a second return"}, OnlyWith{"method two-return"}),
      Field("longest_delay_m", o.longest_delay_m, Help{"longest delay of a second return"},
            OnlyWith{"method two-return"}, IfAbsent{"a third of the range"}),
      Field("tail_m", o.tail_m, above(0), Help{"mean delay of the tail"}, OnlyWith{"method tail"}),
      Field("prior", o.prior,
            Help{"prior of multipath; depth is the posterior median if one return does not explain "
                 "the pixel"},
            IfAbsent{"the most likely depth"}),
      Field("status_thresholds", o.status_thresholds, Help{"thresholds of the single return"}));
}

/// Base class of TwoReturnDecoder and TailDecoder. Fits one return, and a model with later light if
/// one return does not explain the pixel.
///
/// Immutable and thread-safe.
class MultipathDecoder {
 public:
  ~MultipathDecoder();
  MultipathDecoder(MultipathDecoder&&) noexcept;
  MultipathDecoder& operator=(MultipathDecoder&&) noexcept;

  const DecodingTable& table() const;
  const MultipathOptions& options() const;
  int measurements() const { return table().measurements(); }
  int samples() const { return table().bin_count(); }

  /// Decodes one frame on all threads into the caller's planes. Single and unresolved pixels are
  /// decoded as by Decoder::decode(). For pixels with multipath,
  ///   depth, signal: of the direct return; ambient light: least squares fit together with both
  ///     returns;
  ///   predicted standard deviation: from the Fisher information on (z, delta, S1, S2, A), without
  ///     the constraint S1 >= S2;
  ///   confidence: posterior probability of the best fit if the best fit at another direct depth is
  ///     the only alternative;
  ///   delay, ratio: of the second return or of the tail; NaN without one;
  ///   returns: ReturnStatus; PixelStatus is the same as from Decoder.
  /// With a prior, depth and deviation of pixels that one return does not explain are taken from
  /// the posterior.
  /// @throws std::invalid_argument if the shape does not match; Interrupted if `progress` requests
  ///         it
  /// @note the same bits for any number of threads; the last bits differ on processors without
  ///       fused multiply-add
  void decode(const RawView& raw, const DecodedView& decoded, const Progress& progress = {}) const;
  /// See Decoder::decode_within().
  void decode_within(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress = {}) const;
  /// Decodes frame `frame` of a stack (F, H, W, K) into a new image with the usual planes.
  DepthImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  /// Computes the positions of many pixels in [0, N); see Decoder::decode_depth_bins(). NaN without
  /// a return.
  void decode_depth_bins(const float* measurements, std::int64_t pixels, double* depth_bin) const;
  /// Computes the nearest bins in [0, N); -1 without a return.
  void decode_bins(const float* measurements, std::int64_t pixels, std::int32_t* bin) const;

 protected:
  struct Plan;
  explicit MultipathDecoder(std::unique_ptr<const Plan> plan);

 private:
  std::unique_ptr<const Plan> plan_;
};

/// Decodes the direct depth of pixels whose return is followed by an exponential tail, as in haze
/// and translucent materials:
///   y' = T o (S1 chi(z) + S2 integral_0^inf exp(-u / L) / L chi(z + u) du + A kappa) + noise,
/// S1 >= S2 >= 0, with a known mean delay L = MultipathOptions::tail_m. The method is that of
/// TwoReturnDecoder, but a candidate is one depth with its tail, and only the depth is refined. If
/// a tail is found, `delay` is tail_m and `ratio` is the light of the whole tail divided by that of
/// the direct return.
class TailDecoder : public MultipathDecoder {
 public:
  /// @throws std::invalid_argument if table or options are invalid, or the expected measurements
  ///         span too few dimensions: fewer than 5 (4 if ambient light cancels)
  explicit TailDecoder(DecodingTable table, const MultipathOptions& options = {});

  /// See TwoReturnDecoder::why_not_decodable().
  static std::optional<std::string> why_not_decodable(const DecodingTable& table);
};

/// Decodes the direct depth of pixels that may have two returns:
///   y' = electrons - dark = T o (S1 chi(z) + S2 chi(z + delta) + A kappa) + noise,  S1 >= S2 >= 0.
///
/// First, Decoder fits a single return. Its chi^2, weighted by the noise of the measurements and
/// restricted to the dimensions that the code spans without the ambient component, is an upper
/// limit on the improvement by a second return. If it is at most the threshold, the pixel is single
/// and keeps the result of Decoder. Otherwise two returns are fitted by weighted least squares
/// (maximum likelihood for normal noise): all pairs of positions on a coarse grid are evaluated in
/// closed form, and the best three are refined by Levenberg-Marquardt over (z, delta). Two returns
/// are accepted if their chi^2 is below that of the best single return by more than the threshold.
/// The constraint S2 <= S1 is necessary: otherwise a weak early return can explain pixels with a
/// single return.
///
/// The noise of a measurement is estimated from the measurement: max(y', 0) + dark + constant
/// variance. Correlation functions are interpolated between bins by cubics if these predict the
/// table better than chords (straight lines) do.
///
/// @see docs/multipath.md
class TwoReturnDecoder : public MultipathDecoder {
 public:
  /// @throws std::invalid_argument if table or options are invalid, or the expected measurements
  ///         span too few dimensions: fewer than 6 (5 if ambient light cancels). This excludes
  ///         codes of two frequencies.
  explicit TwoReturnDecoder(DecodingTable table, const MultipathOptions& options = {});

  /// Returns why two returns cannot be separated with a valid table: no depth can be decoded, or
  /// the expected measurements span too few dimensions. None: two returns can be separated, but the
  /// accuracy may be low.
  static std::optional<std::string> why_not_decodable(const DecodingTable& table);
};

}  // namespace tofsmith
