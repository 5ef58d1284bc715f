// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/decode/range_part.hpp"

namespace tofsmith {

struct DecoderParts;

/// Thresholds of a pixel's status.
struct DecodeOptions {
  double low_signal_sigma = 3.0;
  /// Least probability that the main lobe is the right one.
  double min_confidence = 0.9;
  double false_alarm_rate = 1e-3;
  /// Root mean square, relative to the signal's part of the measurements.
  double model_error_percent = 0.0;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<DecodeOptions> auto& o) {
  return std::tuple(
      Field("low_signal_sigma", o.low_signal_sigma, at_least(0),
            Help{"signal below which a pixel is marked low_signal"}),
      Field("min_confidence", o.min_confidence, closed(0, 1),
            Help{"confidence below which a pixel is marked ambiguous"}),
      Field("false_alarm_rate", o.false_alarm_rate, right_open(0, 1),
            Help{"share of consistent pixels that are marked inconsistent; 0: no pixel is"}),
      Field("model_error_percent", o.model_error_percent, closed(0, 100),
            Help{"error of the camera model, such as wiggling, that is not marked inconsistent, "
                 "relative to the signal's part of the measurements; a larger one of the table "
                 "replaces it"}));
}

/// Depth by zero-mean normalized cross-correlation, with what ambient light explains projected out
/// instead of the mean:
///   y' = electrons - dark,  a = T o kappa,  x(z) = T o chi(z),  P = I - a a^T / |a|^2
///   z_hat = argmax_z (P y') . (P x(z)) / |P x(z)|
/// over all bins with contrast; scores within 1e-11 |P y'| of the best tie, and the lowest bin
/// wins. Then the best point on the chords to both neighbour bins. Every pixel gets exactly the bin
/// of double arithmetic, whatever the type of its raw numbers, the processor and the number of
/// threads.
///
/// Immutable and safe to use from many threads at once.
/// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 3; deviates: projects out ambient, not the mean
class Decoder {
 public:
  /// @throws std::invalid_argument if the table or the options are invalid
  explicit Decoder(DecodingTable table, const DecodeOptions& options = {});
  ~Decoder();
  Decoder(Decoder&&) noexcept;
  Decoder& operator=(Decoder&&) noexcept;

  const DecodingTable& table() const;
  const DecodeOptions& options() const;
  int measurements() const { return table().measurements(); }
  int samples() const { return table().bin_count(); }
  /// Dimension of the measurements' residual without ambient light, 2 .. K.
  int rank() const;

  /// Decodes one frame on all threads into the caller's planes, so that a stream of frames needs no
  /// memory of its own.
  ///   bin: the best one, as decode_bins gives it;
  ///   signal and ambient: least squares of y' on x(z_hat) and a;
  ///   predicted standard deviation: noise of the measurements at the estimate (mu_i + constant
  ///     variance, averaged over a quarter of the chord), carried through the least squares over
  ///     (z, S, A) that z_hat solves;
  ///   confidence: posterior probability that the depth lies in the main lobe, against all other
  ///     places of the curve. All depths are equally likely a priori, the ambient light may have
  ///     any value, and the signal has a prior proportional to 1/S from a tenth of its standard
  ///     deviation upwards; the noise is that at the best bin. The main lobe is the run of bins
  ///     around the best one along which the code's own score falls, at most 5 % of the range on
  ///     either side. Confidence is 1 where a bound proves that about 1e-3 at most is left for
  ///     other places;
  ///   residual: chi-square per degree of freedom of the measurements around the decoded light;
  ///   status: see PixelStatus; inconsistent if the residual exceeds the chi-square quantile of
  ///     false_alarm_rate by more than model_error_percent explains, low_signal by the noise at the
  ///     best bin. What remains of a pixel without ambient light counts as 0, and the pixel as
  ///     no_return, below 1e-12 of sum_i |y'_i|.
  /// All but bins is computed in single precision: depth errs by about 1e-7 / (angle between
  /// neighbour bins) of a bin, signal and ambient light by about 1e-6 of the brightest measurement.
  /// Pixels that are invalid or have no return are NaN in all planes of floats; the bin is -1 for
  /// invalid ones alone.
  /// @param raw      electrons or counts, with as many measurements as the table
  /// @param decoded  planes of the same height and width; only those that are not null are written,
  ///                 and each has the same values whichever others are
  /// @throws std::invalid_argument if the shape does not fit; Interrupted if progress says so
  /// @note the same bits for any number of threads and any layout of the raw numbers, and on every
  ///       processor
  void decode(const RawView& raw, const DecodedView& decoded, const Progress& progress = {}) const;
  /// As decode(), but only depths within a part of the range are candidates. Candidates are maxima
  /// of the correlation (other methods: minima of the cost), so that depths do not accumulate at
  /// the ends of a part. Confidence assumes that depths outside are 100 times less frequent. Pixels
  /// without a candidate, and pixels whose depth lies outside with a probability of at least 0.9,
  /// are no_return.
  /// @param parts  one per pixel, row by row
  void decode_within(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress = {}) const;
  /// The same for frame `frame` of several (F, H, W, K), into a new image.
  DepthImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  /// Positions in [0, N), refined between bins in double, of many pixels: the decoder inside a
  /// Monte Carlo loop. No status: the best position is given even if its score is not positive.
  /// @param measurements  raw numbers (pixels, K), measurements of a pixel side by side
  /// @param depth_bin     (pixels); NaN where a measurement is NaN or infinite
  /// @note single-threaded; allocates nothing
  void decode_depth_bins(const float* measurements, std::int64_t pixels, double* depth_bin) const;
  /// The same without refinement: the best bins in [0, N), which need not be the nearest to a
  /// refined position; -1 where a measurement is NaN or infinite.
  void decode_bins(const float* measurements, std::int64_t pixels, std::int32_t* bin) const;

 private:
  friend DecoderParts parts_of(const Decoder& decoder);

  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace tofsmith
