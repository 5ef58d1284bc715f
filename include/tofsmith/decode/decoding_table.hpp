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

/// How K measurements depend on light: what is expected of them and, apart where buckets are
/// subtracted, the light collected, which makes shot noise.
struct MeasurementTable {
  Eigen::MatrixXd correlation;        ///< chi, (N, K), row n at depth_bin = n
  Eigen::VectorXd ambient_gain;       ///< kappa (K)
  Eigen::MatrixXd shot_correlation;   ///< (N, K), or empty: correlation
  Eigen::VectorXd shot_ambient_gain;  ///< (K), or empty: ambient_gain

  int samples() const { return static_cast<int>(correlation.rows()); }
  int measurements() const { return static_cast<int>(correlation.cols()); }
  /// Of the light collected: shot_correlation, or what stands for it.
  const Eigen::MatrixXd& shot() const {
    return shot_correlation.size() > 0 ? shot_correlation : correlation;
  }
  /// Of the ambient light collected: shot_ambient_gain, or what stands for it.
  const Eigen::VectorXd& shot_ambient() const {
    return shot_ambient_gain.size() > 0 ? shot_ambient_gain : ambient_gain;
  }
};

/// How much too far pixels decode: terms in the phase phi = 2 pi depth / range of the depth as it
/// decodes, in the pixel's place, r and c in [-1, 1] over rows and columns, and in its signal.
///   e = offset + sum_h (harmonic_m[2 h - 2] cos(h phi) + harmonic_m[2 h - 1] sin(h phi))
///       + sum_d sum_i field_m[..] r^(d - i) c^i, d = 1, 2, ..; i = 0 .. d
///       + sum_j signal_m[j] log(S / S0)^(j + 1)
struct DepthErrorTerms {
  double offset_m = 0.0;
  Eigen::VectorXd harmonic_m;  ///< cos and sin of harmonic 1, 2, .. [m]; empty: none
  Eigen::VectorXd field_m;     ///< of degree 1 (2 terms), 2 (3 more), .. [m]; empty: none
  Eigen::VectorXd signal_m;    ///< of powers 1, 2 of the logarithm [m]; empty: none
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<DepthErrorTerms> auto& t) {
  return std::tuple(Field("offset_m", t.offset_m), Field("harmonic_m", t.harmonic_m),
                    Field("field_m", t.field_m), Field("signal_m", t.signal_m));
}

/// What is taken off depths that a table decodes, as a calibration against reference depth finds
/// it: `known` where the reference had depths, and `beyond`, of fewer terms, elsewhere.
struct DepthCorrection {
  int height = 0;  ///< of the frames [pixels], >= 1
  int width = 0;
  DepthErrorTerms known;
  DepthErrorTerms beyond;
  Eigen::VectorXd known_share;      ///< of equal parts of the range: 1 where `known` counts, else 0
  double signal_e_per_s = 1.0;      ///< S0 [e/s], > 0
  double min_signal_e_per_s = 0.0;  ///< signals below count as this one [e/s]
  double max_signal_e_per_s = 0.0;  ///< and above as this one [e/s]

  bool needs_signal() const { return known.signal_m.size() > 0 || beyond.signal_m.size() > 0; }
  /// e [m] of a pixel that decodes to `depth_m`.
  double error_m(double depth_m, double range_m, int row, int column, double signal_e_per_s) const;
  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<DepthCorrection> auto& c) {
  return std::tuple(Field("height", c.height), Field("width", c.width), Field("known", c.known),
                    Field("beyond", c.beyond), Field("known_share", c.known_share),
                    Field("signal_e_per_s", c.signal_e_per_s),
                    Field("min_signal_e_per_s", c.min_signal_e_per_s),
                    Field("max_signal_e_per_s", c.max_signal_e_per_s));
}

/// Rules that replace saturated and invalid raw numbers before any arithmetic: invalid ones by NaN,
/// saturated ones by saturated_above or saturated_below, which the table's levels recognize.
struct RawMarking {
  RawMarkers markers;  ///< special numbers of the camera; these rules come first
  /// Replaces a saturated number: the table's saturation level, or 2^53 without one.
  double saturated_above = 0x1p53;
  /// Replaces a number that is clipped at the lower end: the table's lower level.
  double saturated_below = 0x1p53;
  bool subtracts = false;  ///< numbers are differences of light: an unsigned 0 is clipped
  /// Largest number of the converter [DN]: unsigned numbers from here on are clipped.
  std::optional<double> converter_max = {};
  /// Largest number of a converter of signed tap differences [DN]: signed numbers equal to this or
  /// to -this - 1 are clipped. Larger ones occur if the taps are converted and then subtracted.
  std::optional<double> signed_max = {};
  double unsigned_black_level = 0.0;  ///< subtracted from unsigned differences of taps
  /// Numbers of a tap from here on are clipped; for readers that subtract the taps.
  std::optional<double> tap_saturation_level = {};

  /// Returns false if every number of an array is kept.
  bool replaces_numbers() const { return !markers.empty() || signed_max; }
  /// Returns the replacement of a stored number; none if it is a measurement.
  std::optional<double> replacement(double number, bool is_unsigned) const;
  /// Returns the measurement of a stored number: its replacement, or the number itself without
  /// unsigned_black_level.
  double measured(double number, bool is_unsigned) const;
  /// Returns the measurement A - B of the stored numbers of two taps.
  double difference(double a, double b) const;
};

/// Returns the marking of a camera's raw numbers by its converter, full well and special numbers.
RawMarking raw_marking_of(const Camera& camera);

/// The bin of `bins` in a period nearest to row `row` of `rows`; -1 for -1.
constexpr std::int32_t nearest_bin_of_row(std::int32_t row, std::int64_t rows, std::int64_t bins) {
  if (row < 0 || rows == bins) return row;
  return static_cast<std::int32_t>((2 * row * bins + rows) / (2 * rows) % bins);
}

/// Everything a decoder needs to know of a code on a camera. Measurements are what leaves the
/// sensor (K of them: one per tap, or the differences of two-bucket pairs):
///   expected electrons  mu_i(z) = T_i (S chi_i(z) + A kappa_i) + dark_i
///   electrons           = (raw_i - black_level_i) * gain_e_per_raw_i
///   variance            = T_i (S shot_chi_i(z) + A shot_kappa_i) + shot_dark_i + constant_i
/// The shot terms are those of the light collected; they differ from the expected values where
/// buckets are subtracted. Left empty they are the same. Duties, exposures, gains and offsets may
/// differ from measurement to measurement.
///
/// The noise of rows is correlated. With `whitening` all shot terms and constant_variance_e2 are
/// variances of whitening (electrons - dark), whose covariance is diagonal at one nominal light.
struct DecodingTable : MeasurementTable {
  Eigen::VectorXd exposure_s;      ///< T [s] (K), each > 0
  Eigen::VectorXd dark_electrons;  ///< expected electrons without any light [e] (K)

  Eigen::VectorXd shot_dark_electrons;   ///< [e] (K), or empty: dark_electrons
  Eigen::VectorXd constant_variance_e2;  ///< of read-out and quantization [e^2] (K), each >= 0
  /// Ambient light whose shot noise decoders assume where ambient_gain is 0, so that measurements
  /// do not show it [e/s].
  double hidden_ambient_e_per_s = 0.0;

  Eigen::VectorXd black_level;            ///< raw number without light (K); 0 where it is electrons
  Eigen::VectorXd gain_e_per_raw;         ///< electrons per raw number (K), each > 0
  std::optional<float> saturation_level;  ///< raw numbers from here on are clipped; none: no limit
  /// Raw numbers down from here are clipped, for differences; none: no limit.
  std::optional<float> lower_saturation_level = {};
  RawMarking marking = {};  ///< rules for saturated and invalid numbers as they are stored
  double range_m = 0.0;     ///< depth of a whole period [m], > 0
  /// Nearest and farthest depth that the camera works at; see depth_limits(). None: the range.
  std::optional<std::array<double, 2>> working_distance_m = {};
  /// N of the bins in which depths are reported; the table has as many rows as its correlation
  /// functions need. 0: one bin per row.
  int bins = 0;
  Eigen::MatrixXd whitening;  ///< (K, K), or empty: noise is independent
  /// Of rows: covariance of whitening (electrons - dark), all of it. Empty without whitening.
  RowCovariance covariance;
  /// Of frames of one size; apply() takes it off what decoders give. None: nothing.
  std::optional<DepthCorrection> correction = {};
  /// Error of the table that decoders tolerate at least, see DecodeOptions::model_error_percent.
  double model_error_percent = 0.0;
  int exposures = 0;  ///< of a frame, with K / exposures measurements each; 0: K exposures
  /// Constant that [playback] adds to depth and that the correlation contains [m].
  double playback_offset_m = 0.0;

  /// Number of exposures of a frame, each of which takes measurements() / exposure_count() numbers.
  int exposure_count() const { return exposures > 0 ? exposures : measurements(); }
  /// Whether measurements are rows, of correlated noise.
  bool has_rows() const { return whitening.size() > 0; }
  /// Dark electrons collected [e] (K): shot_dark_electrons, or what stands for them.
  const Eigen::VectorXd& shot_dark() const {
    return shot_dark_electrons.size() > 0 ? shot_dark_electrons : dark_electrons;
  }
  /// N of the bins in which depths are reported.
  int bin_count() const { return bins > 0 ? bins : samples(); }
  /// Depth of one bin [m].
  double bin_m() const { return range_m / bin_count(); }
  /// Depth from one row to the next [m].
  double row_m() const { return range_m / samples(); }
  /// The bin nearest to a row; -1 for -1.
  std::int32_t nearest_bin(std::int32_t row) const {
    return nearest_bin_of_row(row, samples(), bin_count());
  }
  /// A position in bins of one in rows.
  double in_bins(double row) const { return bins > 0 ? row * bins / samples() : row; }

  /// Whether depths can be distinguished at all: shapes agree, everything is finite, there are 3 to
  /// 64 measurements (2 are enough where ambient light cancels), and the correlation without what
  /// ambient light explains has rank >= 2 and at least two different directions.
  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// The table of a code on a camera. Raw numbers are electrons without ADC, else counts; differences
/// of buckets are taken from converted values, so that the black level cancels. They are clipped at
/// the ends of the converter's numbers, signed or unsigned; a clipped bucket does not show in a
/// smaller difference. Rows are whitened by their mean covariance over depth in the middle of the
/// camera's operating points.
DecodingTable make_decoding_table(const ForwardModel& model, const Camera& camera);

/// The table of whitening (electrons - dark) as measurements of their own, which decodes as that of
/// rows does; the table itself without whitening.
DecodingTable whitened(const DecodingTable& table);

/// @throws InvalidArgument if measurements are rows, which `what` does not take
void require_exposures(const DecodingTable& table, std::string_view what);

/// The table of a measured correlation (N, K) that comes without a camera: equal duties and
/// exposures, so that the mean over measurements is what ambient light explains. Signal and ambient
/// are then in raw numbers, of which noise is taken as if they were electrons.
DecodingTable make_decoding_table(const Eigen::MatrixXd& correlation, double range_m);

/// Why no depth can be decoded from what `table` measures, though its numbers are in order: too few
/// measurements or too many, or a correlation that leaves depth, signal and ambient light mixed up.
/// None: depth can be decoded.
std::optional<std::string> why_not_decodable(const DecodingTable& table);

/// Two depths that look the same in every measurement once ambient light is unknown.
struct AmbiguousDepths {
  int first_bin = 0;   ///< the lower one; the decoder always answers with it
  int second_bin = 0;  ///< the higher one
  double first_m = 0.0;
  double second_m = 0.0;
};

/// Every depth whose direction equals that of a lower depth, paired with the lowest such, by
/// increasing second_bin. Depths without contrast (all measurements alike, as two words of one-tap
/// Gray codes) have no direction and are left out.
std::vector<AmbiguousDepths> ambiguous_depths(const DecodingTable& table);

/// The largest angle by which a table turns from one row to the next [rad], without jumps (more
/// than 75 degrees, as where a ramp falls back). 0 for a smooth table, whose course between its
/// rows is known. For other tables depths between rows are assumed to lie on the chords; above 10
/// degrees the true curve may differ.
double furthest_turn_rad(const DecodingTable& table);

/// What constant light adds to the measurements of a measured table.
enum class MeasuredAmbient {
  equal,  ///< the same to all, as with equal duties; it cancels in differences of taps
  mean,   ///< as much as the mean of the column over the period: right for any duties, if the
          ///< columns are 0 where no light is
  none,   ///< nothing: the columns are differences already
};

/// "equal", "mean", "none".
std::string_view name_of(MeasuredAmbient ambient);
/// @throws std::invalid_argument for any other word
MeasuredAmbient parse_measured_ambient(std::string_view name);
/// kappa (K) of the columns of a correlation (N, K).
Eigen::VectorXd ambient_gain_of(const Eigen::MatrixXd& correlation, MeasuredAmbient ambient);

/// Correlation functions that a delay sweep measured, with what is known of the measurements. Where
/// a list is empty the camera says it.
struct MeasuredTable {
  /// chi (N, K) up to one common factor, row n at depth_bin = n, the end point left out. Values may
  /// be negative. A constant along ambient_gain changes no depth, only the ambient light found.
  Eigen::MatrixXd correlation;
  int taps = 1;                    ///< columns hold the taps of an exposure side by side
  bool differences = false;        ///< columns are differences of two taps, as they were read out
  Eigen::VectorXd ambient_gain;    ///< kappa (K), or empty: equal
  Eigen::VectorXd exposure_s;      ///< T [s] (K), each > 0, or empty: the camera's
  Eigen::VectorXd black_level;     ///< raw number without light (K), or empty: the camera's
  Eigen::VectorXd gain_e_per_raw;  ///< electrons per raw number (K), or empty: the camera's
  std::optional<DepthCorrection> correction = {};  ///< taken off what it decodes; none: nothing
  std::optional<double> range_m = {};  ///< depth of a whole period [m]; none: the camera's
  double model_error_percent = 0.0;    ///< error that decoders tolerate at least; in [0, 100]

  int samples() const { return static_cast<int>(correlation.rows()); }
  int columns() const { return static_cast<int>(correlation.cols()); }

  /// The same with its columns, and what is known of each, in another order.
  /// @param source  which column each is now (K)
  MeasuredTable in_order(const Eigen::VectorXi& source) const;

  /// Whether the sizes agree and the range is one. @throws std::invalid_argument naming field,
  /// value and rule
  void validate() const;
};

/// The table of measured correlation functions on a camera, which gives range, noise, saturation
/// and read-out, differences of taps where it reads differences, and how depths drift with its
/// temperature. Its samples, waveforms and
/// impulse responses do not count: they are in the measurement.
///
/// Signal is found in multiples of what the table was measured with. Shot noise is that of the
/// expected electrons: columns below 0 are raised along ambient_gain, and the ambient light found
/// is lower by that. Differences, and columns below 0 that ambient light does not reach, have the
/// noise of their largest magnitude at every depth.
/// @throws std::invalid_argument if table or camera are invalid or do not fit
DecodingTable make_decoding_table(const MeasuredTable& measured, const Camera& camera);

}  // namespace tofsmith
