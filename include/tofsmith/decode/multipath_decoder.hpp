// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "tofsmith/core/hidden.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

/// Prior of multipath returns; depth has a uniform prior. Affects the result in dim light.
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

struct MultipathOptions {
  /// About 1 % of pixels with a single return have a larger chi^2.
  double threshold = 9.0;
  double shortest_delay_m = 0.1;
  std::optional<double> longest_delay_m;  ///< above the shortest and below the range
  double tail_m = 0.5;                    ///< at most the range
  std::optional<ReturnPrior> prior;
  DecodeOptions status_thresholds;

  /// @throws InvalidArgument
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

class MultipathEngine;
enum class MultipathKind;

/// Base class of TwoReturnDecoder and TailDecoder. Fits later light if one return does not explain
/// the pixel.
///
/// Single and unresolved pixels are decoded as by Decoder. For pixels with multipath,
///   depth, signal: of the direct return; ambient light: fitted together with both returns;
///   deviation: from the Fisher information on (z, delta, S1, S2, A), without the constraint S1
///     >= S2;
///   confidence: posterior probability of the best fit against the best fit at another direct
///     depth;
///   delay, ratio: of the second return or of the tail; NaN without one;
///   returns: ReturnStatus; PixelStatus is the same as from Decoder.
/// With a prior, depth and deviation are computed from the posterior unless one return explains the
/// pixel. The last bits differ on processors without fused multiply-add.
///
/// Immutable and thread-safe.
class MultipathDecoder : public DepthDecoder {
 public:
  DecodeMethod method() const override;
  const DecodingTable& table() const override;
  void decode_depth_bins(const float* measurements, std::int64_t pixels,
                         double* depth_bin) const override;

 protected:
  MultipathDecoder(DecodingTable table, const MultipathOptions& options, MultipathKind later);

 private:
  void decode_pixels(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress) const override;

  Hidden<const MultipathEngine> engine_;
};

/// Decodes the direct depth of pixels whose return is followed by an exponential tail, as in haze:
///   y' = T o (S1 chi(z) + S2 integral_0^inf exp(-u / L) / L chi(z + u) du + A kappa) + noise,
/// S1 >= S2 >= 0, with a known mean delay L = MultipathOptions::tail_m. The method is that of
/// TwoReturnDecoder with one depth per candidate; `delay` is tail_m, and `ratio` S2 / S1.
class TailDecoder : public MultipathDecoder {
 public:
  /// @throws InvalidArgument if table or options are invalid, or the expected measurements span
  ///         fewer than 5 dimensions (4 if ambient light cancels)
  explicit TailDecoder(DecodingTable table, const MultipathOptions& options = {});

  static std::optional<std::string> why_not_decodable(const DecodingTable& table);
};

/// Decodes the direct depth of pixels that may have two returns:
///   y' = electrons - dark = T o (S1 chi(z) + S2 chi(z + delta) + A kappa) + noise,  S1 >= S2 >= 0.
///
/// If the chi^2 of Decoder's single return, an upper limit on the improvement by a second one, is
/// at most the threshold, the pixel is single. Otherwise two returns are fitted by weighted least
/// squares: all pairs on a coarse grid in closed form, the best three refined by
/// Levenberg-Marquardt. They are accepted if chi^2 decreases by more than the threshold. Without S2
/// <= S1, a weak early return could explain pixels with a single return.
///
/// The noise of a measurement is max(y', 0) + dark + constant variance. Correlation functions are
/// interpolated by cubics where these predict the table better than chords.
/// @see docs/multipath.md
class TwoReturnDecoder : public MultipathDecoder {
 public:
  /// @throws InvalidArgument if table or options are invalid, or the expected measurements span
  ///         fewer than 6 dimensions (5 if ambient light cancels), as for codes of two frequencies
  explicit TwoReturnDecoder(DecodingTable table, const MultipathOptions& options = {});

  /// Returns why two returns cannot be separated with a valid table; none if they can, possibly
  /// with low accuracy.
  static std::optional<std::string> why_not_decodable(const DecodingTable& table);
};

}  // namespace tofsmith
