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

/// What is assumed of multipath returns before a pixel is seen; depth itself may be anything. The
/// answer leans on it where light is scarce.
struct ReturnPrior {
  double single_probability = 0.5;
  double mean_delay_m = 0.5;
  double max_ratio = 0.5;
};
auto fields_of(ConstOrNot<ReturnPrior> auto& p) {
  return std::tuple(Field("single_probability", p.single_probability, right_open(0, 1),
                          Help{"prior probability that there is no second return"}),
                    Field("mean_delay_m", p.mean_delay_m, above(0),
                          Help{"prior mean of delays, which are exponential"}),
                    Field("max_ratio", p.max_ratio, left_open(0, 1),
                          Help{"prior of ratios: uniform from 0 to this"}));
}

/// How multipath is looked for.
struct MultipathOptions {
  /// Single returns exceed 9 in about one pixel of a hundred.
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
            Help{"how much chi^2 must fall for a second return to count"}),
      Field("shortest_delay_m", o.shortest_delay_m, above(0),
            Help{"shortest delay of a second return"}, OnlyWith{"method two-return"}),
      Field("longest_delay_m", o.longest_delay_m, Help{"longest delay of a second return"},
            OnlyWith{"method two-return"}, IfAbsent{"a third of the range"}),
      Field("tail_m", o.tail_m, above(0), Help{"mean delay of the light that trails off"},
            OnlyWith{"method tail"}),
      Field("prior", o.prior,
            Help{"prior under which depth is the posterior median, where one return does not "
                 "explain the pixel"},
            IfAbsent{"the most likely depth"}),
      Field("status_thresholds", o.status_thresholds, Help{"thresholds of the single return"}));
}

/// What TwoReturnDecoder and TailDecoder share: a model of one return, and one of light that comes
/// later too for the pixels that one return does not explain.
///
/// Immutable and safe to use from many threads at once.
class MultipathDecoder {
 public:
  ~MultipathDecoder();
  MultipathDecoder(MultipathDecoder&&) noexcept;
  MultipathDecoder& operator=(MultipathDecoder&&) noexcept;

  const DecodingTable& table() const;
  const MultipathOptions& options() const;
  int measurements() const { return table().measurements(); }
  int samples() const { return table().bin_count(); }

  /// Decodes one frame on all threads into the caller's planes; as Decoder::decode for single and
  /// unresolved pixels. Where multipath was found
  ///   depth, signal: of the direct return; ambient light: least squares beside both;
  ///   predicted standard deviation: from the Fisher information on (z, delta, S1, S2, A); S1 >= S2
  ///     is not counted as knowledge;
  ///   confidence: posterior probability against the best other fit at another direct depth;
  ///   delay, ratio: of the second return or of the tail, NaN where there is none;
  ///   returns: ReturnStatus; PixelStatus stays what Decoder says.
  /// With a prior, depth and deviation are the posterior's where one return does not explain the
  /// pixel.
  /// @throws std::invalid_argument if the shape does not fit; Interrupted if progress says so
  /// @note the same bits for any number of threads; processors without fused multiply-add differ in
  ///       the last ones
  void decode(const RawView& raw, const DecodedView& decoded, const Progress& progress = {}) const;
  /// As Decoder::decode_within().
  void decode_within(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress = {}) const;
  /// The same for frame `frame` of several (F, H, W, K), into a new image with the usual planes.
  DepthImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  /// Positions in [0, N) of many pixels; see Decoder::decode_depth_bins. NaN also without return.
  void decode_depth_bins(const float* measurements, std::int64_t pixels, double* depth_bin) const;
  /// The nearest bins in [0, N), -1 where there is none.
  void decode_bins(const float* measurements, std::int64_t pixels, std::int32_t* bin) const;

 protected:
  struct Plan;
  explicit MultipathDecoder(std::unique_ptr<const Plan> plan);

 private:
  std::unique_ptr<const Plan> plan_;
};

/// Direct depth of pixels behind whose return light trails off, as in haze and translucent things:
///   y' = T o (S1 chi(z) + S2 integral_0^inf exp(-u / L) / L chi(z + u) du + A kappa) + noise,
/// S1 >= S2 >= 0, with the mean delay L = MultipathOptions::tail_m known. All else is as in
/// TwoReturnDecoder; a place tried is one depth with its tail, and only depth goes downhill.
/// The delay it gives is tail_m where a tail was found, the ratio the light of all of the tail
/// beside the direct return's.
class TailDecoder : public MultipathDecoder {
 public:
  /// @throws std::invalid_argument if table or options are invalid, or the code holds too few
  ///         independent means: fewer than 5 (4 where ambient light cancels)
  explicit TailDecoder(DecodingTable table, const MultipathOptions& options = {});

  /// As TwoReturnDecoder::why_not_decodable(), of a tail.
  static std::optional<std::string> why_not_decodable(const DecodingTable& table);
};

/// Direct depth of pixels into which light may come back twice:
///   y' = electrons - dark = T o (S1 chi(z) + S2 chi(z + delta) + A kappa) + noise,  S1 >= S2 >= 0.
///
/// The fast Decoder fits one return. Its chi^2, weighted by the noise of the measurements and
/// counted in the dimensions the code spans (what ambient light explains left out), is all that a
/// second return could explain: up to the threshold the pixel is single and keeps what Decoder
/// says. Else two returns are fitted by weighted least squares, the likelihood of normal noise: all
/// pairs of coarse places are tried in closed form, the best three followed by Levenberg-Marquardt
/// on (z, delta). Two returns are accepted if chi^2 falls by more than the threshold below the best
/// single return's anywhere. S2 <= S1 is needed: without it a phantom early return explains pixels
/// of one return.
///
/// The noise of a measurement is taken from itself: max(y', 0) + dark + constant variance. Curves
/// between bins are drawn by cubics where that predicts the table better than chords do.
///
/// @see docs/multipath.md
class TwoReturnDecoder : public MultipathDecoder {
 public:
  /// @throws std::invalid_argument if table or options are invalid, or the code holds too few
  ///         independent means: fewer than 6 (5 where ambient light cancels), as codes of two
  ///         frequencies do
  explicit TwoReturnDecoder(DecodingTable table, const MultipathOptions& options = {});

  /// Why two returns cannot be separated with a table whose numbers are in order: no depth can be
  /// decoded at all, or there are too few independent means. None: they can, well or badly.
  static std::optional<std::string> why_not_decodable(const DecodingTable& table);
};

}  // namespace tofsmith
