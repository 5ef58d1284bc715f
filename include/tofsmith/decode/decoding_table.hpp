// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/fields.hpp"

namespace tofsmith {

/// Dependence of K measurements on signal and ambient light, and the collected light that
/// determines their shot noise. Measurements and collected light differ only if buckets are
/// subtracted.
struct MeasurementTable {
  Eigen::MatrixXd correlation;        ///< chi (N, K), row n at depth_bin = n
  Eigen::VectorXd ambient_gain;       ///< kappa (K)
  Eigen::MatrixXd shot_correlation;   ///< (N, K); empty: correlation
  Eigen::VectorXd shot_ambient_gain;  ///< (K); empty: ambient_gain

  int samples() const { return static_cast<int>(correlation.rows()); }
  int measurements() const { return static_cast<int>(correlation.cols()); }
  const Eigen::MatrixXd& shot() const {
    return shot_correlation.size() > 0 ? shot_correlation : correlation;
  }
  const Eigen::VectorXd& shot_ambient() const {
    return shot_ambient_gain.size() > 0 ? shot_ambient_gain : ambient_gain;
  }
};

/// Terms of the depth error e of a pixel, which depend on the phase phi = 2 pi depth / range of the
/// uncorrected depth, the pixel's row r and column c, scaled to [-1, 1], and its signal.
///   e = offset + sum_h (harmonic_m[2 h - 2] cos(h phi) + harmonic_m[2 h - 1] sin(h phi))
///       + sum_d sum_i field_m[...] r^(d - i) c^i, d = 1, 2, ...; i = 0 to d
///       + sum_j signal_m[j] log(S / S0)^(j + 1)
struct DepthErrorTerms {
  double offset_m = 0.0;
  Eigen::VectorXd harmonic_m;  ///< cos and sin of harmonic 1, 2, ...
  Eigen::VectorXd field_m;     ///< of degree 1 (2 terms), 2 (3 more), ...
  Eigen::VectorXd signal_m;    ///< of powers 1, 2 of the logarithm
};
auto fields_of(ConstOrNot<DepthErrorTerms> auto& t) {
  return std::tuple(Field("offset_m", t.offset_m), Field("harmonic_m", t.harmonic_m),
                    Field("field_m", t.field_m), Field("signal_m", t.signal_m));
}

/// Depth error that is subtracted from decoded depths. `known` applies to the depths of the
/// calibration, `beyond`, with fewer terms, to all others.
struct DepthCorrection {
  int height = 0;  ///< of the frames
  int width = 0;   ///< of the frames
  DepthErrorTerms known;
  DepthErrorTerms beyond;
  /// Weight of `known`, in [0, 1], at the middles of equal parts of the range, linear in between;
  /// `beyond` has the remaining weight. Empty: 1.
  Eigen::VectorXd known_share;
  double signal_e_per_s = 1.0;      ///< S0, > 0
  double min_signal_e_per_s = 0.0;  ///< replaces smaller signals
  double max_signal_e_per_s = 0.0;  ///< replaces larger signals

  bool needs_signal() const { return known.signal_m.size() > 0 || beyond.signal_m.size() > 0; }
  /// Returns e of a pixel.
  double error_m(double depth_m, double range_m, int row, int column, double signal_e_per_s) const;
  /// @throws InvalidArgument
  void validate() const;
};
auto fields_of(ConstOrNot<DepthCorrection> auto& c) {
  return std::tuple(Field("height", c.height), Field("width", c.width), Field("known", c.known),
                    Field("beyond", c.beyond), Field("known_share", c.known_share),
                    Field("signal_e_per_s", c.signal_e_per_s),
                    Field("min_signal_e_per_s", c.min_signal_e_per_s),
                    Field("max_signal_e_per_s", c.max_signal_e_per_s));
}

/// Rules that replace special raw numbers before any arithmetic: invalid ones by NaN, saturated
/// ones by saturated_above or saturated_below, which count as clipped.
struct RawMarking {
  RawMarkers markers;  ///< applied first
  /// The table's saturation level, or 2^53 without one.
  double saturated_above = 0x1p53;
  /// The table's lower saturation level.
  double saturated_below = 0x1p53;
  bool subtracts = false;  ///< differences of light: an unsigned 0 is clipped
  /// Unsigned numbers at or above it are clipped [DN].
  std::optional<double> converter_max = {};
  /// Signed numbers equal to this or to -this - 1 are clipped [DN]. Larger ones occur if the taps
  /// are converted and then subtracted.
  std::optional<double> signed_max = {};
  double unsigned_black_level = 0.0;  ///< of unsigned differences of taps
  /// Tap numbers at or above it are clipped, for readers that subtract the taps.
  std::optional<double> tap_saturation_level = {};

  bool replaces_numbers() const { return !markers.empty() || signed_max; }
  /// Returns the replacement of a stored number; none for a measurement.
  std::optional<double> replacement(double number, bool is_unsigned) const;
  /// Returns the replacement of a stored number, or the number minus unsigned_black_level.
  double measured(double number, bool is_unsigned) const;
  /// Returns A - B for the stored numbers of two taps.
  double difference(double a, double b) const;
};

RawMarking raw_marking_of(const Camera& camera);

/// Returns the nearest of `bins` bins to one of `rows` rows; -1 for -1.
constexpr std::int32_t nearest_bin_of_row(std::int32_t row, std::int64_t rows, std::int64_t bins) {
  if (row < 0 || rows == bins) return row;
  return static_cast<std::int32_t>((2 * row * bins + rows) / (2 * rows) % bins);
}

/// Everything that a decoder needs about a code on a camera. The K measurements are the values that
/// the sensor reads out: one per tap, or the differences of two-bucket pairs.
///   expected electrons  mu_i(z) = T_i (S chi_i(z) + A kappa_i) + dark_i
///   electrons           = (raw_i - black_level_i) * gain_e_per_raw_i
///   variance            = T_i (S shot_chi_i(z) + A shot_kappa_i) + shot_dark_i + constant_i
/// The shot terms are empty unless buckets are subtracted.
///
/// For Readout::rows, whose noise is correlated, all shot terms and constant_variance_e2 are
/// variances of the whitened measurements W (electrons - dark), with W = `whitening`. Their
/// covariance is diagonal at one nominal light level. For RowDecoder::plain, the first row of W is
/// 0, the others are orthonormal with sums of 0, and ambient_gain is 0.
struct DecodingTable : MeasurementTable {
  Eigen::VectorXd exposure_s;      ///< T (K), each > 0
  Eigen::VectorXd dark_electrons;  ///< without light [e] (K)

  Eigen::VectorXd shot_dark_electrons;   ///< [e] (K); empty: dark_electrons
  Eigen::VectorXd constant_variance_e2;  ///< of readout and quantization (K), each >= 0
  /// Ambient light that decoders assume for shot noise if ambient_gain is 0, because the
  /// measurements then contain no information on it.
  double hidden_ambient_e_per_s = 0.0;

  Eigen::VectorXd black_level;            ///< raw number without light (K); 0 for electrons
  Eigen::VectorXd gain_e_per_raw;         ///< (K), each > 0
  std::optional<float> saturation_level;  ///< raw numbers at or above it are clipped
  /// Raw numbers at or below it are clipped, for differences.
  std::optional<float> lower_saturation_level = {};
  RawMarking marking = {};
  double range_m = 0.0;  ///< depth of a period, > 0
  /// Nearest and farthest; see depth_limits().
  std::optional<std::array<double, 2>> working_distance_m = {};
  /// N, the number of bins in which depths are reported; 0: one bin per row.
  int bins = 0;
  Eigen::MatrixXd whitening;  ///< W (K, K); empty: noise is independent
  /// Covariance of the whitened measurements; empty without whitening.
  RowCovariance covariance;
  RowDecoder decoder = RowDecoder::whitened;  ///< of rows; how W was selected
  /// Subtracted by apply() from decoded depths, for frames of one size.
  std::optional<DepthCorrection> correction = {};
  /// As DecodeOptions::model_error_percent; the larger of both applies.
  double model_error_percent = 0.0;
  int exposures = 0;  ///< per frame, with K / exposures measurements each; 0: K
  /// Constant that [playback] adds to depth; included in `correlation`.
  double playback_offset_m = 0.0;

  int exposure_count() const { return exposures > 0 ? exposures : measurements(); }
  bool has_rows() const { return whitening.size() > 0; }
  const Eigen::VectorXd& shot_dark() const {
    return shot_dark_electrons.size() > 0 ? shot_dark_electrons : dark_electrons;
  }
  int bin_count() const { return bins > 0 ? bins : samples(); }
  double bin_m() const { return range_m / bin_count(); }
  double row_m() const { return range_m / samples(); }
  /// Returns the bin nearest to a row; -1 for -1.
  std::int32_t nearest_bin(std::int32_t row) const {
    return nearest_bin_of_row(row, samples(), bin_count());
  }
  double in_bins(double row) const { return bins > 0 ? row * bins / samples() : row; }

  /// Requires matching shapes, finite numbers, 3 to 64 measurements (or 2 if ambient light
  /// cancels), and a correlation that, without the ambient component, has rank >= 2 and two
  /// different directions.
  /// @throws InvalidArgument
  void validate() const;
};

/// Builds the table of a code on a camera. Raw numbers are counts if the camera has an ADC,
/// otherwise electrons. Differences of buckets are differences of converted values, clipped at the
/// ends of the converter's range; a clipped bucket within this range cannot be detected. Unless
/// the decoder of the camera is plain, rows are whitened by their covariance at the middle
/// operating point, averaged over depth.
DecodingTable make_decoding_table(const ForwardModel& model, const Camera& camera);

/// Returns the table of the whitened measurements W (electrons - dark), which decodes them to the
/// same depths; `table` itself without whitening.
DecodingTable whitened(const DecodingTable& table);

/// @param what  name of the feature that does not support rows
/// @throws InvalidArgument if measurements are rows
void require_exposures(const DecodingTable& table, std::string_view what);

/// Builds the table of a correlation (N, K) without a camera, with equal duties and exposures.
/// Signal and ambient light are in raw numbers, with noise as for electrons.
DecodingTable make_decoding_table(const Eigen::MatrixXd& correlation, double range_m);

/// Returns why no depth can be decoded with a valid `table`; none if it can.
std::optional<std::string> why_not_decodable(const DecodingTable& table);

/// Two depths with equal measurements if ambient light is unknown.
struct AmbiguousDepths {
  int first_bin = 0;  ///< the lower one, which decoders return
  int second_bin = 0;
  double first_m = 0.0;
  double second_m = 0.0;
};

/// Returns the depths that cannot be distinguished from a lower depth, each paired with the lowest
/// such depth, by increasing second_bin: their correlations without the ambient component have the
/// same direction. Skips depths without contrast (all measurements equal).
std::vector<AmbiguousDepths> ambiguous_depths(const DecodingTable& table);

/// Returns the largest angle between adjacent rows of a table [rad], except for jumps of more than
/// 75 degrees; 0 for a smooth table, which can be interpolated accurately. In other tables decoders
/// assume chords, from which the true curve may deviate if the angle exceeds 10 degrees.
double furthest_turn_rad(const DecodingTable& table);

/// Contribution of constant light to the columns of a measured table.
enum class MeasuredAmbient {
  equal,  ///< equal for all, as with equal duties
  mean,   ///< proportional to the mean of the column: correct for any duties if the columns are 0
          ///< without light
  none,   ///< zero: columns are differences
};
constexpr auto words_of(MeasuredAmbient /*any*/) { return word_list("equal", "mean", "none"); }
/// @throws InvalidArgument for other words
inline MeasuredAmbient parse_measured_ambient(std::string_view name) {
  return parse_word<MeasuredAmbient>("ambient", name);
}
Eigen::VectorXd ambient_gain_of(const Eigen::MatrixXd& correlation, MeasuredAmbient ambient);

/// Correlation functions measured by a delay sweep. Empty lists are replaced by the camera's
/// values.
struct MeasuredTable {
  /// chi (N, K) up to one common factor, row n at depth_bin = n, without the end point. Adding a
  /// multiple of ambient_gain changes only the ambient light.
  Eigen::MatrixXd correlation;
  int taps = 1;                    ///< columns contain the taps of an exposure side by side
  bool differences = false;        ///< columns are differences of two taps
  Eigen::VectorXd ambient_gain;    ///< kappa (K); empty: equal
  Eigen::VectorXd exposure_s;      ///< T (K), each > 0
  Eigen::VectorXd black_level;     ///< raw number without light (K)
  Eigen::VectorXd gain_e_per_raw;  ///< (K), each > 0
  std::optional<DepthCorrection> correction = {};
  std::optional<double> range_m = {};  ///< depth of a period; none: the camera's
  double model_error_percent = 0.0;    ///< minimum that decoders tolerate, in [0, 100]

  int samples() const { return static_cast<int>(correlation.rows()); }
  int columns() const { return static_cast<int>(correlation.cols()); }

  /// Returns the table with its columns in another order.
  /// @param source  present column for each new one (K)
  MeasuredTable in_order(const Eigen::VectorXi& source) const;

  /// @throws InvalidArgument
  void validate() const;
};

/// Builds the table of measured correlation functions on a camera, which provides range, noise,
/// saturation, readout and drift with temperature. Its samples, waveforms and impulse responses are
/// ignored, because the measurement contains them.
///
/// Signal is relative to the signal of the measurement. Shot noise is that of the expected
/// electrons, so a multiple of ambient_gain is added to negative columns, which lowers the decoded
/// ambient light by the same amount. Differences, and columns that do not depend on ambient light,
/// remain negative; their noise is that of their largest magnitude.
/// @throws InvalidArgument if table or camera are invalid or do not match
DecodingTable make_decoding_table(const MeasuredTable& measured, const Camera& camera);

}  // namespace tofsmith
