// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/hidden.hpp"
#include "tofsmith/decode/depth_decoder.hpp"

namespace tofsmith {

struct DecoderParts;

/// Thresholds that determine the status of a pixel.
struct DecodeOptions {
  double low_signal_sigma = 3.0;
  double min_confidence = 0.9;
  double false_alarm_rate = 1e-3;
  double model_error_percent = 0.0;

  /// @throws InvalidArgument
  void validate() const;
};
auto fields_of(ConstOrNot<DecodeOptions> auto& o) {
  return std::tuple(Field("low_signal_sigma", o.low_signal_sigma, at_least(0),
                          Help{"signal below which a pixel is marked low_signal"}),
                    Field("min_confidence", o.min_confidence, closed(0, 1),
                          Help{"confidence below which a pixel is marked ambiguous"}),
                    Field("false_alarm_rate", o.false_alarm_rate, right_open(0, 1),
                          Help{"probability that a pixel is marked inconsistent although it "
                               "fits the camera model; 0: mark none"}),
                    Field("model_error_percent", o.model_error_percent, closed(0, 100),
                          Help{"tolerated error of the camera model, such as wiggling, relative "
                               "to the signal; overridden by a larger value in a measured table"}));
}

/// Decodes depth by zero-mean normalized cross-correlation, with the ambient component projected
/// out instead of the mean:
///   y' = electrons - dark,  a = T o kappa,  x(z) = T o chi(z),  P = I - a a^T / |a|^2
///   z_hat = argmax_z (P y') . (P x(z)) / |P x(z)|
/// o is the element-wise product; for symbols see DecodingTable. Scores within 1e-11 |P y'| of the
/// best one are ties, which the lowest row wins. The depth is then refined between rows: it is the
/// maximum of the pixel's own correlation in a smooth table, and otherwise the best point on the
/// chords (straight lines) to both adjacent rows. The bin always equals the result of double
/// precision arithmetic, for any type of the raw numbers, processor and number of threads.
///
/// Planes of decode(), with the same bits on every processor:
///   bin: as decode_bins();
///   signal and ambient: least squares fit of y' to x(z_hat) and a;
///   deviation: noise of the estimated light, propagated through the least squares problem in (z,
///     S, A). Chords use the noise at the middle of the estimate's quarter;
///   confidence: posterior probability of the main lobe, the run of bins around the best one
///     along which the noiseless score decreases, up to 5 % of the range to either side. It is 1
///     if a bound proves that all other depths have at most about 1e-3;
///   residual: chi-square of the measurements per degree of freedom;
///   status: see PixelStatus. Measurements without the ambient component below 1e-12 of sum_i
///     |y'_i| count as 0: the pixel is no_return.
/// All planes except `bin` are computed in single precision: rounding errors are about 1e-7 /
/// (angle between adjacent bins) bins of depth, and 1e-6 of the brightest measurement for signal
/// and ambient light. Pixels that are invalid or have no return are NaN in all planes of floats;
/// the bin is -1 only for invalid pixels.
///
/// Immutable and thread-safe.
/// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 3; deviates: projects out ambient, not the mean
/// @see docs/decoding.md
class Decoder final : public DepthDecoder {
 public:
  /// @throws InvalidArgument for invalid arguments
  explicit Decoder(DecodingTable table, const DecodeOptions& options = {});

  DecodeMethod method() const override { return DecodeMethod::zncc; }
  const DecodingTable& table() const override;
  /// Dimension of the space that P x(z) spans, 2 to K.
  int rank() const;
  const Decoder* correlation_decoder() const override { return this; }

  /// Allocates nothing. Also for scores that are not positive.
  void decode_depth_bins(const float* measurements, std::int64_t pixels,
                         double* depth_bin) const override;
  /// Computes the best bins in [0, N), not always nearest to the refined position; -1 if a
  /// measurement is NaN or infinite.
  void decode_bins(const float* measurements, std::int64_t pixels,
                   std::int32_t* bin) const override;

 private:
  friend DecoderParts parts_of(const Decoder& decoder);
  void decode_pixels(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress) const override;

  struct Plan;
  Hidden<const Plan> plan_;
};

}  // namespace tofsmith
