// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Distribution of the true depths of trials.
enum class DepthSampling {
  uniform,  ///< anywhere in the range
  bins,     ///< favours codes that are wrong in between
};
constexpr auto words_of(DepthSampling /*any*/) { return word_list("uniform", "bins"); }

inline constexpr double default_outlier_threshold_m = 0.5;
inline constexpr Help outlier_threshold_help{"circular error above which a depth is an outlier"};

/// Options of evaluate().
struct EvaluateOptions {
  std::int64_t trials = 20000;  ///< rounded up to even numbers
  std::uint64_t seed = 1;
  double outlier_threshold_m = default_outlier_threshold_m;
  bool sub_bin = true;
  DepthSampling depth = DepthSampling::uniform;
  bool clip_to_open_sensor = false;
  DecodeMethod method = DecodeMethod::zncc;
  UnwrapWeights unwrap_weights = UnwrapWeights::variance;
  double target_standard_error = 0.0;
  std::int64_t max_trials = 50'000'000;
  bool draw_every_measurement = false;
  bool bounds = true;

  /// @throws std::invalid_argument
  void validate() const;
};
auto fields_of(ConstOrNot<EvaluateOptions> auto& o) {
  return std::tuple(
      Field("trials", o.trials, closed(2, 4e9),
            Help{"trials per operating point; the initial number if a target standard error is "
                 "given"}),
      Field("seed", o.seed, Help{"seed of all trials"}),
      Field("outlier_threshold_m", o.outlier_threshold_m, at_least(0).or_infinity(),
            outlier_threshold_help),
      Field("sub_bin", o.sub_bin, Help{"interpolate decoded depths between bins"}),
      Field("depth", o.depth,
            Help{"true depths: uniform in the range, or on bins only (underestimates errors)"}),
      Field("clip_to_open_sensor", o.clip_to_open_sensor,
            Help{"clip each measurement to [0, T (S + A)] electrons, where T is the exposure, S "
                 "the signal and A the ambient light, as in the simulator of Gutierrez-Barragan et "
                 "al., CVPR 2019"}),
      Field("method", o.method, decode_method_help),
      Field("unwrap_weights", o.unwrap_weights, unwrap_weights_help, unwrap_weights_condition),
      Field("target_standard_error", o.target_standard_error, right_open(0, 1),
            Help{"end the trials as soon as the depth error has this relative standard error, "
                 "such as 1% or 0.01; 0: no target"}),
      Field("max_trials", o.max_trials, closed(2, 4e9),
            Help{"maximum number of trials per operating point if a target standard error is "
                 "given"}),
      Field("draw_every_measurement", o.draw_every_measurement,
            Help{"draw the noise of every measurement, so that all methods have the same noise"}),
      Field("bounds", o.bounds, Help{"compute the bounds; otherwise they are 0"}));
}

/// Depth error at one operating point.
struct PointDepthError {
  OperatingPoint point;
  std::int64_t trials = 0;
  Estimate linear_mde_m;
  Estimate circular_mde_m;
  Estimate linear_rmse_m;
  Estimate circular_rmse_m;
  Estimate outlier_rate;
  double cramer_rao_mae_m = 0.0;
  /// ReceiverBound of the camera; for rows, HistogramBound of their light.
  double receiver_bound_mae_m = 0.0;
  double direct_tof_bound_mae_m = 0.0;

  const Estimate& of(DepthErrorMeasure measure) const {
    const bool is_linear = measure.kind == DepthErrorKind::linear;
    if (measure.statistic == ErrorStatistic::rmse)
      return is_linear ? linear_rmse_m : circular_rmse_m;
    return is_linear ? linear_mde_m : circular_mde_m;
  }
};
auto fields_of(ConstOrNot<PointDepthError> auto& p) {
  return std::tuple(
      Field("point", p.point, FieldMark::in_place),
      Field("trials", p.trials, FieldMark::apart, Help{"trials at each point"}),
      Field("linear_mde_m", p.linear_mde_m, at_least(0),
            Help{"mean absolute difference of decoded and true depth"}),
      Field("circular_mde_m", p.circular_mde_m, at_least(0),
            Help{"the same for the circular (wrapped) difference"}),
      Field("linear_rmse_m", p.linear_rmse_m, at_least(0), Help{"root mean square difference"}),
      Field("circular_rmse_m", p.circular_rmse_m, at_least(0),
            Help{"root mean square circular difference"}),
      Field("outlier_rate", p.outlier_rate, closed(0, 1), FieldMark::without_error,
            Help{"share of circular errors above the threshold"}),
      Field("cramer_rao_mae_m", p.cramer_rao_mae_m, at_least(0).or_infinity(), FieldMark::bound,
            Help{"bound for the code; 0: no bound (docs/bounds.md)"}),
      Field("receiver_bound_mae_m", p.receiver_bound_mae_m, at_least(0).or_infinity(),
            FieldMark::bound, FieldMark::may_be_null,
            Help{"bound for any code on the camera; 0: no bound, e.g. without impulse responses"}),
      Field("direct_tof_bound_mae_m", p.direct_tof_bound_mae_m, at_least(0).or_infinity(),
            FieldMark::bound, FieldMark::may_be_null,
            Help{"bound for the camera's light; 0: no bound"}));
}

/// Column of a table of operating points, with the value at one of them.
struct PointColumn {
  std::string name;
  double value = 0.0;  ///< NaN if there is no bound
};
/// Returns light, errors with their standard errors, and bounds.
std::vector<PointColumn> point_columns(const PointDepthError& point);

/// Averages over all operating points.
struct DepthErrorMean {
  Estimate geometric_mean_m;
  Estimate mean_m;
};
auto fields_of(ConstOrNot<DepthErrorMean> auto& m) {
  return std::tuple(
      Field("geometric_mean_m", m.geometric_mean_m, at_least(0), Help{"geometric mean"}),
      Field("mean_m", m.mean_m, at_least(0), Help{"arithmetic mean"}));
}

/// Depth error of a code on a camera.
struct DepthErrorReport {
  std::string code;
  int exposures = 0;
  int taps = 0;
  int measurements = 0;
  int samples = 0;
  std::int64_t trials = 0;
  int points_short_of_target = 0;
  std::uint64_t seed = 0;
  double outlier_threshold_m = 0.0;
  DepthErrorMean linear, circular;
  DepthErrorMean linear_rmse, circular_rmse;
  std::vector<PointDepthError> points;

  const DepthErrorMean& of(DepthErrorMeasure measure) const {
    const bool is_linear = measure.kind == DepthErrorKind::linear;
    if (measure.statistic == ErrorStatistic::rmse) return is_linear ? linear_rmse : circular_rmse;
    return is_linear ? linear : circular;
  }
};
auto fields_of(ConstOrNot<DepthErrorReport> auto& r) {
  return std::tuple(
      Field("code", r.code, InDocuments{"name"}), Field("exposures", r.exposures, at_least(1)),
      Field("taps", r.taps, at_least(1)), Field("measurements", r.measurements, at_least(1)),
      Field("samples", r.samples, at_least(1)),
      Field("trials", r.trials, FieldMark::apart,
            Help{"trials per operating point; with a target standard error the maximum"}),
      Field("points_short_of_target", r.points_short_of_target, FieldMark::apart,
            Help{"number of operating points that reached max_trials before the target"}),
      Field("seed", r.seed, FieldMark::apart),
      Field("outlier_threshold_m", r.outlier_threshold_m, FieldMark::apart, outlier_threshold_help),
      Field("linear", r.linear, Help{"means of the linear mean absolute errors"}),
      Field("circular", r.circular, Help{"means of the circular mean absolute errors"}),
      Field("linear_rmse", r.linear_rmse, Help{"means of the linear root mean square errors"}),
      Field("circular_rmse", r.circular_rmse,
            Help{"means of the circular root mean square errors"}),
      Field("points", r.points));
}

/// Computes the depth error at every operating point by Monte Carlo simulation, with bounds; see
/// docs/montecarlo.md.
///
/// Trial t of point p uses only the random stream (seed, p, t), and its depth is uniform in the
/// t-th of `trials` slices of equal probability, so that all codes are compared at the same depths.
/// If the conversion is linear and the method is ZNCC, normal noise is only drawn in the subspace
/// that ZNCC uses, which gives the same distribution of errors. With a target, a point gets further
/// rounds of trials, each sliced separately and at least half as large as all previous ones
/// together.
/// @throws std::invalid_argument if the camera or the options are invalid, the code does not fit or
///         the method cannot decode it; Interrupted
/// @note same bits for any number of threads with the same dispatch_target()
DepthErrorReport evaluate(const CodeSet& code, const Camera& camera,
                          const EvaluateOptions& options = {}, const Progress& progress = {});

/// Best origin of depth of a code.
struct BestRotation {
  int rotation_bin = 0;  ///< argument of CodeSet::rotated()
  /// Geometric mean of the error [m] over the operating points for each rotation (N): linear, or
  /// the camera's error kind if it weights depths.
  std::vector<double> linear_geometric_mean_m;
};

/// Finds the rotation with the smallest linear depth error, averaged over close origins of depth
/// because one origin separates few pairs of true and decoded depths. If the camera weights depths
/// (OperatingRange::depths), its error kind decides, and uniformly drawn trials are weighted at
/// every rotation.
///
/// A rotation moves true and decoded depths alike. The error of a trial is |decoded - true|, or the
/// range minus that if the origin is between the two, so one run of trials gives the error at all N
/// rotations. These errors are biased low at the best rotation; evaluate the rotated code for an
/// unbiased value. If a
/// generator of the light rounds switching times, only rotations by whole points are considered.
BestRotation best_rotation(const CodeSet& code, const Camera& camera,
                           const EvaluateOptions& options = {}, const Progress& progress = {});

/// Computes the mean circular depth error [m] of a measured table for frames simulated from the
/// table itself. Expected electrons are interpolated linearly between its rows, and one depth is
/// drawn in each of `trials` equal slices of the range.
/// @param light   S relative to the light of the table's measurement, A in e/s
/// @param trials  >= 2, rounded up to even numbers
/// @throws std::invalid_argument if the table or the number of trials is invalid
Estimate table_depth_error_m(const DecodingTable& table, const OperatingPoint& light,
                             std::int64_t trials = 20000, std::uint64_t seed = 1);

/// Geometric means over the operating points of mean |error| of the direct depth.
struct OperatingMultipathError {
  Estimate linear_m, circular_m;

  const Estimate& of(DepthErrorKind kind) const {
    return kind == DepthErrorKind::linear ? linear_m : circular_m;
  }
};
auto fields_of(ConstOrNot<OperatingMultipathError> auto& e) {
  return std::tuple(Field("linear_m", e.linear_m, at_least(0)),
                    Field("circular_m", e.circular_m, at_least(0)));
}

/// Errors of a code with the camera's multipath light.
struct OperatingMultipathReport {
  OperatingMultipathError single_path;                ///< single-path decoder
  std::optional<OperatingMultipathError> two_return;  ///< two-return decoder, if supported
};
auto fields_of(ConstOrNot<OperatingMultipathReport> auto& r) {
  return std::tuple(Field("single_path", r.single_path), Field("two_return", r.two_return));
}

/// Computes the depth error with a second return in every pixel, for zncc and the two-return
/// decoder on the same trials, as evaluate(). Only `trials` and `seed` of the options are used.
/// @throws std::invalid_argument as evaluate(); Interrupted
OperatingMultipathReport operating_multipath_report(const CodeSet& code, const Camera& camera,
                                                    const OperatingMultipath& later,
                                                    const EvaluateOptions& options = {},
                                                    const Progress& progress = {});

/// Title of the column of exposures_by_taps().
inline constexpr const char* exposures_by_taps_title = "exposures x taps";

/// Explanation of the terms in tables of depth errors.
inline constexpr const char* depth_error_legend =
    "taps: values that are read out per exposure; linear: error of the depth; circular: error "
    "modulo the unambiguous range; S, A: signal and ambient light";

/// Returns the number of exposures and of values per exposure, such as "3 x 2"; "3 x 1" if the
/// sensor delivers the difference of two taps.
std::string exposures_by_taps(const DepthErrorReport& error);

}  // namespace tofsmith
