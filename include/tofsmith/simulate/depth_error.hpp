// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
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

/// Where the true depths of trials lie.
enum class DepthSampling {
  uniform,  ///< anywhere in the range
  bins,     ///< on bins only: flatters codes that are wrong in between
};
constexpr std::array<std::string_view, 2> words_of(DepthSampling /*any*/) {
  return {"uniform", "bins"};
}

/// Circular error above which a depth counts as an outlier, by default.
inline constexpr double default_outlier_threshold_m = 0.5;
inline constexpr Help outlier_threshold_help{"circular error above which a depth is an outlier"};

/// Options of evaluate(); fields_of() below describes each of them.
struct EvaluateOptions {
  std::int64_t trials = 20000;  ///< odd numbers are rounded up
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

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<EvaluateOptions> auto& o) {
  return std::tuple(
      Field("trials", o.trials, closed(2, 4e9),
            Help{"trials per operating point; with a target, the number of the first round"}),
      Field("seed", o.seed, Help{"seed of all trials"}),
      Field("outlier_threshold_m", o.outlier_threshold_m, at_least(0).or_infinity(),
            outlier_threshold_help),
      Field("sub_bin", o.sub_bin, Help{"decode between bins"}),
      Field("depth", o.depth,
            Help{"where true depths lie: anywhere in the range, or on bins only, which flatters "
                 "codes"}),
      Field("clip_to_open_sensor", o.clip_to_open_sensor,
            Help{"clip electrons to [0, T (S + A)], like the simulator of the paper's authors"}),
      Field("method", o.method, decode_method_help),
      Field("unwrap_weights", o.unwrap_weights, unwrap_weights_help, unwrap_weights_condition),
      Field("target_standard_error", o.target_standard_error, right_open(0, 1),
            Help{"relative standard error of the depth error at which trials end, such as 1% or "
                 "0.01; 0: no target"}),
      Field("max_trials", o.max_trials, closed(2, 4e9),
            Help{"maximum number of trials per operating point with a target"}),
      Field("draw_every_measurement", o.draw_every_measurement,
            Help{"draw the noise of every measurement even if zncc needs fewer numbers, so that "
                 "methods are compared with the same noise"}),
      Field("bounds", o.bounds, Help{"compute the bounds; otherwise they are 0"}));
}

/// Depth error at one operating point.
struct PointDepthError {
  OperatingPoint point;
  std::int64_t trials = 0;        ///< made
  Estimate linear_mde_m;          ///< mean |decoded - true|
  Estimate circular_mde_m;        ///< mean of the shorter way round the range
  Estimate linear_rmse_m;         ///< root of the mean square of the linear error
  Estimate circular_rmse_m;       ///< of the circular error
  Estimate outlier_rate;          ///< share of circular errors beyond the threshold
  double cramer_rao_mae_m = 0.0;  ///< CramerRaoBound of the code
  /// ReceiverBound of the camera, with the code's exposures; of rows, HistogramBound of their
  /// light.
  double receiver_bound_mae_m = 0.0;
  double direct_tof_bound_mae_m = 0.0;  ///< DirectTofBound of the camera's light; 0: there is none
};
/// A bound as tables of numbers hold it: not a number where it bounds nothing, which is 0.
inline double bound_or_nan(double bound_m) {
  return bound_m == 0.0 ? std::numeric_limits<double>::quiet_NaN() : bound_m;
}
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<PointDepthError> auto& p) {
  return std::tuple(
      Field("point", p.point, FieldMark::in_place), Field("trials", p.trials, FieldMark::apart),
      Field("linear_mde_m", p.linear_mde_m, at_least(0)),
      Field("circular_mde_m", p.circular_mde_m, at_least(0)),
      Field("linear_rmse_m", p.linear_rmse_m, at_least(0)),
      Field("circular_rmse_m", p.circular_rmse_m, at_least(0)),
      Field("outlier_rate", p.outlier_rate, closed(0, 1), FieldMark::without_error),
      Field("cramer_rao_mae_m", p.cramer_rao_mae_m, at_least(0).or_infinity(), FieldMark::bound),
      Field("receiver_bound_mae_m", p.receiver_bound_mae_m, at_least(0).or_infinity(),
            FieldMark::bound, FieldMark::may_be_null),
      Field("direct_tof_bound_mae_m", p.direct_tof_bound_mae_m, at_least(0).or_infinity(),
            FieldMark::bound, FieldMark::may_be_null));
}

/// One figure for all operating points, of what is known of each.
struct DepthErrorMean {
  Estimate geometric_mean_m;
  Estimate mean_m;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<DepthErrorMean> auto& m) {
  return std::tuple(Field("geometric_mean_m", m.geometric_mean_m, at_least(0)),
                    Field("mean_m", m.mean_m, at_least(0)));
}

/// Depth error of a code on a camera.
struct DepthErrorReport {
  std::string code;
  int exposures = 0;
  int taps = 0;
  int measurements = 0;  ///< that leave the sensor
  int samples = 0;
  std::int64_t trials = 0;         ///< made per operating point, with a target: at most
  int points_short_of_target = 0;  ///< that reached max_trials first
  std::uint64_t seed = 0;
  double outlier_threshold_m = 0.0;
  DepthErrorMean linear, circular;            ///< of mean absolute errors
  DepthErrorMean linear_rmse, circular_rmse;  ///< of root mean square errors
  std::vector<PointDepthError> points;        ///< in the order of OperatingRange::points()

  const DepthErrorMean& of(DepthErrorKind kind) const {
    return kind == DepthErrorKind::linear ? linear : circular;
  }
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<DepthErrorReport> auto& r) {
  return std::tuple(
      Field("code", r.code, InDocuments{"name"}), Field("exposures", r.exposures, at_least(1)),
      Field("taps", r.taps, at_least(1)), Field("measurements", r.measurements, at_least(1)),
      Field("samples", r.samples, at_least(1)), Field("trials", r.trials, FieldMark::apart),
      Field("points_short_of_target", r.points_short_of_target, FieldMark::apart),
      Field("seed", r.seed, FieldMark::apart),
      Field("outlier_threshold_m", r.outlier_threshold_m, FieldMark::apart),
      Field("linear", r.linear), Field("circular", r.circular), Field("linear_rmse", r.linear_rmse),
      Field("circular_rmse", r.circular_rmse), Field("points", r.points));
}

/// Monte Carlo depth error at every operating point of the camera, with bounds beside it.
///
/// Trial t of point p draws from the stream (seed, p, t) alone: its depth, uniform on the t-th of
/// `trials` equal slices of the range (slices in which depths are equally likely, where the camera
/// weighs them), its albedo if that is uniform, and its noise. Codes are so
/// compared on the same depths. Noise is normal or Poisson as the sensor says, of the variance of
/// that depth; of rows it is drawn in every time bin, or normal with their covariance. Where all
/// that follows is linear and ZNCC decodes, normal noise is drawn in the plane that ZNCC looks at,
/// with the covariance it has there: the same distribution from fewer numbers. Standard errors come
/// from the differences of trials in neighbouring slices; they hold for the sliced depths (and err
/// on the large side).
///
/// With a target, a point gets further rounds of trials, each sliced by itself, at least half as
/// many again as it has. Where the error is linear, as many are made as the wraps foreseen from the
/// circular error need, whether or not any were met.
/// @throws std::invalid_argument if the camera or the options are invalid, the code does not fit or
///         the method cannot decode it; Interrupted if progress says so
/// @note same bits for any number of threads, on one dispatch_target()
DepthErrorReport evaluate(const CodeSet& code, const Camera& camera,
                          const EvaluateOptions& options = {}, const Progress& progress = {});

/// The best origin of depth of a code.
struct BestRotation {
  int rotation_bin = 0;  ///< CodeSet::rotated by this many bins has the least linear error
  /// Geometric mean over the operating points of the linear error [m], for each rotation (N). Where
  /// the camera weighs depths, of the error that it asks for.
  std::vector<double> linear_geometric_mean_m;
};

/// Finds the rotation with the least linear depth error. Circular error does not depend on it, but
/// where the camera weighs depths (OperatingRange::depths): there the error that the camera asks
/// for decides, and trials, drawn uniformly, are weighed at every rotation by how often their depth
/// occurs.
///
/// Rotating a code moves true and decoded depths alike: a trial costs |decoded - true| at every
/// rotation but those that put the origin between the two, where it costs the range less that. So
/// one run of trials gives the error at all N rotations. (Every rotation is judged by the same
/// trials and the least is taken: its own figure is a little low; evaluate the rotated code for an
/// honest one. A generator of the light rounds switching times: on one, rotations by whole points
/// alone are chosen among.)
/// @param options  as for evaluate
BestRotation best_rotation(const CodeSet& code, const Camera& camera,
                           const EvaluateOptions& options = {}, const Progress& progress = {});

/// Mean circular depth error [m] of a table on frames made from itself, so that measured tables
/// stand beside codes: expected electrons along the chords between its rows, normal noise of the
/// variance it states, one depth drawn in each of `trials` equal slices of the range.
/// @param light   S in multiples of what the table was measured with, A in e/s
/// @param trials  >= 2; odd numbers are rounded up
/// @throws std::invalid_argument if the table or the number of trials is invalid
/// @note same bits for any number of threads, on one dispatch_target()
Estimate table_depth_error_m(const DecodingTable& table, const OperatingPoint& light,
                             std::int64_t trials = 20000, std::uint64_t seed = 1);

/// Error of the direct depth [m]: geometric means over the operating points of mean |error|.
struct OperatingMultipathError {
  Estimate linear_m, circular_m;

  const Estimate& of(DepthErrorKind kind) const {
    return kind == DepthErrorKind::linear ? linear_m : circular_m;
  }
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<OperatingMultipathError> auto& e) {
  return std::tuple(Field("linear_m", e.linear_m, at_least(0)),
                    Field("circular_m", e.circular_m, at_least(0)));
}

/// Errors of a code in the operating multipath.
struct OperatingMultipathReport {
  OperatingMultipathError single_path;                ///< decoded as single-path
  std::optional<OperatingMultipathError> two_return;  ///< as two returns; none: the code cannot
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<OperatingMultipathReport> auto& r) {
  return std::tuple(Field("single_path", r.single_path), Field("two_return", r.two_return));
}

/// Computes the depth error where every pixel has a second return, for zncc and for the two-return
/// decoder on the same trials. Trial t of an operating point draws depth, uniform on the t-th slice
/// of the range, albedo, return and noise from its own random stream. Of the options, only trials
/// (per operating point) and seed count.
/// @throws std::invalid_argument as evaluate(); Interrupted
OperatingMultipathReport operating_multipath_report(const CodeSet& code, const Camera& camera,
                                                    const OperatingMultipath& later,
                                                    const EvaluateOptions& options = {},
                                                    const Progress& progress = {});

}  // namespace tofsmith
