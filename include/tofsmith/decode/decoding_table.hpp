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

/// Dependence of K measurements on signal and ambient light. The table describes the expected
/// measurements, and the collected light, which determines their shot noise. Measurements and
/// collected light differ only if buckets are subtracted.
struct MeasurementTable {
  Eigen::MatrixXd correlation;        ///< chi, (N, K), row n at depth_bin = n
  Eigen::VectorXd ambient_gain;       ///< kappa (K)
  Eigen::MatrixXd shot_correlation;   ///< (N, K), or empty: equal to correlation
  Eigen::VectorXd shot_ambient_gain;  ///< (K), or empty: equal to ambient_gain

  int samples() const { return static_cast<int>(correlation.rows()); }
  int measurements() const { return static_cast<int>(correlation.cols()); }
  /// Correlation of the collected light: shot_correlation, or correlation if that is empty.
  const Eigen::MatrixXd& shot() const {
    return shot_correlation.size() > 0 ? shot_correlation : correlation;
  }
  /// Gain of the collected ambient light: shot_ambient_gain, or ambient_gain if that is empty.
  const Eigen::VectorXd& shot_ambient() const {
    return shot_ambient_gain.size() > 0 ? shot_ambient_gain : ambient_gain;
  }
};

/// Terms of the depth error e of a pixel. They depend on the phase phi = 2 pi depth / range of the
/// uncorrected depth, on the pixel's row r and column c, each scaled to [-1, 1], and on its signal.
///   e = offset + sum_h (harmonic_m[2 h - 2] cos(h phi) + harmonic_m[2 h - 1] sin(h phi))
///       + sum_d sum_i field_m[...] r^(d - i) c^i, d = 1, 2, ...; i = 0 to d
///       + sum_j signal_m[j] log(S / S0)^(j + 1)
struct DepthErrorTerms {
  double offset_m = 0.0;
  Eigen::VectorXd harmonic_m;  ///< cos and sin of harmonic 1, 2, ... [m]; empty: none
  Eigen::VectorXd field_m;     ///< of degree 1 (2 terms), 2 (3 more), ... [m]; empty: none
  Eigen::VectorXd signal_m;    ///< of powers 1, 2 of the logarithm [m]; empty: none
};
/// Field descriptions (core/fields.hpp).
auto fields_of(ConstOrNot<DepthErrorTerms> auto& t) {
  return std::tuple(Field("offset_m", t.offset_m), Field("harmonic_m", t.harmonic_m),
                    Field("field_m", t.field_m), Field("signal_m", t.signal_m));
}

/// Depth error that is subtracted from decoded depths, as found by calibration against reference
/// depths. `known` applies to the depths that the reference contained. `beyond`, which has fewer
/// terms, applies to all other depths.
struct DepthCorrection {
  int height = 0;  ///< rows of the frames, >= 1
  int width = 0;   ///< columns of the frames, >= 1
  DepthErrorTerms known;
  DepthErrorTerms beyond;
  /// Weight of `known`, in [0, 1], at the middles of equal parts of the range; interpolated between
  /// them. `beyond` has the remaining weight. Empty: `known` applies everywhere.
  Eigen::VectorXd known_share;
  double signal_e_per_s = 1.0;      ///< S0 [e/s], > 0
  double min_signal_e_per_s = 0.0;  ///< smaller signals are replaced by this one [e/s]
  double max_signal_e_per_s = 0.0;  ///< larger signals are replaced by this one [e/s]

  bool needs_signal() const { return known.signal_m.size() > 0 || beyond.signal_m.size() > 0; }
  /// Returns e [m] of a pixel that decodes to `depth_m`.
  double error_m(double depth_m, double range_m, int row, int column, double signal_e_per_s) const;
  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
/// Field descriptions (core/fields.hpp).
auto fields_of(ConstOrNot<DepthCorrection> auto& c) {
  return std::tuple(Field("height", c.height), Field("width", c.width), Field("known", c.known),
                    Field("beyond", c.beyond), Field("known_share", c.known_share),
                    Field("signal_e_per_s", c.signal_e_per_s),
                    Field("min_signal_e_per_s", c.min_signal_e_per_s),
                    Field("max_signal_e_per_s", c.max_signal_e_per_s));
}

/// Rules that replace special raw numbers before any arithmetic. Invalid numbers become NaN.
/// Saturated numbers become saturated_above or saturated_below, which are at the saturation levels
/// of the table and therefore count as clipped.
struct RawMarking {
  RawMarkers markers;  ///< special numbers of the camera; these rules are applied first
  /// Value that replaces a saturated number: the table's saturation level, or 2^53 without one.
  double saturated_above = 0x1p53;
  /// Value that replaces a number clipped at the lower end: the table's lower saturation level.
  double saturated_below = 0x1p53;
  bool subtracts = false;  ///< numbers are differences of light, so that an unsigned 0 is clipped
  /// Largest number of the converter [DN]: unsigned numbers at or above it are clipped.
  std::optional<double> converter_max = {};
  /// Largest number of a converter of signed tap differences [DN]: signed numbers equal to this or
  /// to -this - 1 are clipped. Larger ones occur if the taps are converted and then subtracted.
  std::optional<double> signed_max = {};
  double unsigned_black_level = 0.0;  ///< subtracted from unsigned differences of taps
  /// Tap numbers at or above it are clipped; used by readers that subtract the taps.
  std::optional<double> tap_saturation_level = {};

  /// Returns false if every number of an array is kept.
  bool replaces_numbers() const { return !markers.empty() || signed_max; }
  /// Returns the replacement of a stored number, or none if the number is a measurement.
  std::optional<double> replacement(double number, bool is_unsigned) const;
  /// Returns the measurement of a stored number: its replacement, or the number minus
  /// unsigned_black_level.
  double measured(double number, bool is_unsigned) const;
  /// Returns the measurement A - B of the stored numbers of two taps.
  double difference(double a, double b) const;
};

/// Returns the rules for a camera's raw numbers, from its converter, full well and special numbers.
RawMarking raw_marking_of(const Camera& camera);

/// Returns the bin nearest to row `row`, where a period has `rows` rows and `bins` bins. Returns -1
/// for row -1.
constexpr std::int32_t nearest_bin_of_row(std::int32_t row, std::int64_t rows, std::int64_t bins) {
  if (row < 0 || rows == bins) return row;
  return static_cast<std::int32_t>((2 * row * bins + rows) / (2 * rows) % bins);
}

/// Everything that a decoder needs about a code on a camera. The K measurements are the values that
/// the sensor reads out: one per tap, or the differences of two-bucket pairs.
///   expected electrons  mu_i(z) = T_i (S chi_i(z) + A kappa_i) + dark_i
///   electrons           = (raw_i - black_level_i) * gain_e_per_raw_i
///   variance            = T_i (S shot_chi_i(z) + A shot_kappa_i) + shot_dark_i + constant_i
/// The shot terms describe the collected light; they differ from the expected values only if
/// buckets are subtracted, and are otherwise empty. Duties, exposures, gains and offsets may differ
/// between measurements.
///
/// Measurements of a sensor with Readout::rows have correlated noise. Their tables contain the
/// matrix `whitening`, W. All shot terms and constant_variance_e2 are then variances of the
/// whitened measurements W (electrons - dark). The covariance of these is diagonal at one nominal
/// light level.
struct DecodingTable : MeasurementTable {
  Eigen::VectorXd exposure_s;      ///< T [s] (K), each > 0
  Eigen::VectorXd dark_electrons;  ///< expected electrons without light [e] (K)

  Eigen::VectorXd shot_dark_electrons;   ///< [e] (K), or empty: equal to dark_electrons
  Eigen::VectorXd constant_variance_e2;  ///< of readout and quantization [e^2] (K), each >= 0
  /// Ambient light [e/s] that decoders assume in order to compute shot noise if ambient_gain is 0.
  /// In this case the measurements contain no information on ambient light.
  double hidden_ambient_e_per_s = 0.0;

  Eigen::VectorXd black_level;            ///< raw number without light (K); 0 for electrons
  Eigen::VectorXd gain_e_per_raw;         ///< electrons per raw number (K), each > 0
  std::optional<float> saturation_level;  ///< raw numbers at or above it are clipped
  /// Raw numbers at or below it are clipped, for differences; none: no limit.
  std::optional<float> lower_saturation_level = {};
  RawMarking marking = {};  ///< rules for saturated and invalid stored numbers
  double range_m = 0.0;     ///< depth of a whole period [m], > 0
  /// Nearest and farthest working distance of the camera; see depth_limits(). None: the range.
  std::optional<std::array<double, 2>> working_distance_m = {};
  /// N, the number of bins in which depths are reported. The table has as many rows as its
  /// correlation functions need. 0: one bin per row.
  int bins = 0;
  Eigen::MatrixXd whitening;  ///< W (K, K), or empty: noise is independent
  /// Full covariance of the whitened measurements W (electrons - dark). Empty without whitening.
  RowCovariance covariance;
  /// Depth error that apply() subtracts from decoded depths, for frames of one size. None: no
  /// correction.
  std::optional<DepthCorrection> correction = {};
  /// Error of the table, as DecodeOptions::model_error_percent. Decoders tolerate the larger of
  /// both.
  double model_error_percent = 0.0;
  int exposures = 0;  ///< per frame, with K / exposures measurements each; 0: K exposures
  /// Constant [m] that [playback] adds to depth; `correlation` already includes it.
  double playback_offset_m = 0.0;

  /// Number of exposures per frame, each of which yields measurements() / exposure_count() numbers.
  int exposure_count() const { return exposures > 0 ? exposures : measurements(); }
  /// Returns true if measurements are rows, whose noise is correlated.
  bool has_rows() const { return whitening.size() > 0; }
  /// Collected dark electrons [e] (K): shot_dark_electrons, or dark_electrons if that is empty.
  const Eigen::VectorXd& shot_dark() const {
    return shot_dark_electrons.size() > 0 ? shot_dark_electrons : dark_electrons;
  }
  /// N, the number of bins in which depths are reported.
  int bin_count() const { return bins > 0 ? bins : samples(); }
  /// Depth of one bin [m].
  double bin_m() const { return range_m / bin_count(); }
  /// Depth between adjacent rows [m].
  double row_m() const { return range_m / samples(); }
  /// Returns the bin nearest to a row; -1 for -1.
  std::int32_t nearest_bin(std::int32_t row) const {
    return nearest_bin_of_row(row, samples(), bin_count());
  }
  /// Converts a position from rows to bins.
  double in_bins(double row) const { return bins > 0 ? row * bins / samples() : row; }

  /// Checks that shapes match and all numbers are finite, and that depths can be distinguished.
  /// This requires 3 to 64 measurements, or 2 if ambient light cancels. The correlation without the
  /// ambient component must have rank >= 2 and at least two different directions.
  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// Builds the table of a code on a camera. Raw numbers are counts if the camera has an ADC, and
/// electrons otherwise. Differences of buckets are differences of converted values, so that the
/// black level cancels. They are clipped at the ends of the converter's signed or unsigned range. A
/// clipped bucket cannot be detected if the difference lies within this range. For rows,
/// measurements are whitened by their covariance at the camera's middle operating point, averaged
/// over depth.
DecodingTable make_decoding_table(const ForwardModel& model, const Camera& camera);

/// Returns the table of the whitened measurements W (electrons - dark). It decodes these to the
/// same depths as `table` decodes the original measurements. Without whitening, returns `table`
/// itself.
DecodingTable whitened(const DecodingTable& table);

/// @param what  name of the feature that does not support rows, for the message
/// @throws InvalidArgument if measurements are rows
void require_exposures(const DecodingTable& table, std::string_view what);

/// Builds the table of a measured correlation (N, K) without a camera. Duties and exposures are
/// equal, so that ambient light contributes equally to all measurements. Signal and ambient light
/// are in raw numbers; their noise is computed as if they were electrons.
DecodingTable make_decoding_table(const Eigen::MatrixXd& correlation, double range_m);

/// Returns why no depth can be decoded with a valid `table`: too few or too many measurements, or a
/// correlation that cannot separate depth, signal and ambient light. None: depth can be decoded.
std::optional<std::string> why_not_decodable(const DecodingTable& table);

/// Two depths with the same measurements if ambient light is unknown.
struct AmbiguousDepths {
  int first_bin = 0;   ///< the lower one; the decoder always returns it
  int second_bin = 0;  ///< the higher one
  double first_m = 0.0;
  double second_m = 0.0;
};

/// Returns the depths that cannot be distinguished from a lower depth, each paired with the lowest
/// such depth, by increasing second_bin. Two depths cannot be distinguished if their correlations
/// without the ambient component have the same direction. Skips depths without contrast (all
/// measurements equal, as for two words of one-tap Gray codes), which have no direction.
std::vector<AmbiguousDepths> ambiguous_depths(const DecodingTable& table);

/// Returns the largest angle between adjacent rows of a table [rad], except for jumps (more than 75
/// degrees, as at the end of a ramp). Returns 0 for a smooth table, which can be interpolated
/// accurately. For other tables, decoders assume chords (straight lines) between adjacent rows. If
/// the angle exceeds 10 degrees, the true curve may deviate from them.
double furthest_turn_rad(const DecodingTable& table);

/// Contribution of constant light to the measurements of a measured table.
enum class MeasuredAmbient {
  equal,  ///< equal for all, as with equal duties; cancels in differences of taps
  mean,   ///< proportional to the mean of the column over the period: correct for any duties if
          ///< the columns are 0 without light
  none,   ///< zero: the columns are differences
};

/// "equal", "mean", "none".
std::string_view name_of(MeasuredAmbient ambient);
/// @throws std::invalid_argument for any other word
MeasuredAmbient parse_measured_ambient(std::string_view name);
/// Returns kappa (K) for the columns of a correlation (N, K).
Eigen::VectorXd ambient_gain_of(const Eigen::MatrixXd& correlation, MeasuredAmbient ambient);

/// Correlation functions measured by a delay sweep, with the known properties of the measurements.
/// Empty lists are replaced by the camera's values.
struct MeasuredTable {
  /// chi (N, K) up to one common factor, row n at depth_bin = n, without the end point. Values may
  /// be negative. Adding a multiple of ambient_gain changes no depth, only the ambient light.
  Eigen::MatrixXd correlation;
  int taps = 1;                    ///< columns hold the taps of an exposure side by side
  bool differences = false;        ///< columns are differences of two taps, formed at readout
  Eigen::VectorXd ambient_gain;    ///< kappa (K), or empty: equal
  Eigen::VectorXd exposure_s;      ///< T [s] (K), each > 0, or empty: the camera's
  Eigen::VectorXd black_level;     ///< raw number without light (K), or empty: the camera's
  Eigen::VectorXd gain_e_per_raw;  ///< electrons per raw number (K), or empty: the camera's
  std::optional<DepthCorrection> correction = {};  ///< subtracted from decoded depths
  std::optional<double> range_m = {};  ///< depth of a whole period [m]; none: the camera's
  double model_error_percent = 0.0;    ///< minimum error that decoders tolerate, in [0, 100]

  int samples() const { return static_cast<int>(correlation.rows()); }
  int columns() const { return static_cast<int>(correlation.cols()); }

  /// Returns the table with its columns and their properties in another order.
  /// @param source  index of the present column for each new column (K)
  MeasuredTable in_order(const Eigen::VectorXi& source) const;

  /// @throws std::invalid_argument naming field, value and rule, if sizes or range are invalid
  void validate() const;
};

/// Builds the table of measured correlation functions on a camera. The camera provides range,
/// noise, saturation, readout (including differences of taps) and drift with temperature. Its
/// samples, waveforms and impulse responses are ignored, because the measurement contains them.
///
/// Signal is relative to the signal at which the table was measured. Shot noise is that of the
/// expected electrons, which must not be negative. If columns contain negative values, a multiple
/// of ambient_gain is added to the table. This lowers the decoded ambient light by the same amount.
/// Some columns remain negative: differences, and columns that do not depend on ambient light.
/// Their noise at every depth is that of their largest magnitude.
/// @throws std::invalid_argument if table or camera are invalid or do not match
DecodingTable make_decoding_table(const MeasuredTable& measured, const Camera& camera);

}  // namespace tofsmith
