// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/decoding_table.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/shared/decompositions.hpp"
#include "decode/search/direction_table.hpp"
#include "decode/search/smooth_curve.hpp"
#include "decode/shared/marked_raw.hpp"
#include "decode/table_resolution.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

std::string shape_of(const Eigen::MatrixXd& matrix) {
  return std::to_string(matrix.rows()) + " x " + std::to_string(matrix.cols());
}

void require_table(const Eigen::MatrixXd& values, const char* field, const DecodingTable& table) {
  require(values.rows() == table.correlation.rows() && values.cols() == table.correlation.cols(),
          field, shape_of(values),
          "must have the shape of correlation, " + shape_of(table.correlation));
  require(values.allFinite(), field, "NaN or infinite", "must be finite");
}

void require_list(const Eigen::VectorXd& values, const char* field, double minimum,
                  const DecodingTable& table) {
  require(
      values.size() == table.correlation.cols(), field, std::to_string(values.size()) + " entries",
      "must have one for each of the " + std::to_string(table.measurements()) + " measurements");
  for (const double value : values) {
    require(std::isfinite(value), field, value, "must be finite");
    require(value >= minimum, field, value, "must not be negative");
  }
}

std::optional<BrokenRule> count_not_decodable(const DecodingTable& table) {
  if (table.measurements() >= 2 && table.measurements() <= max_measurements) return std::nullopt;
  return broken("measurements", table.measurements(),
                "must be in [3, 64] (or 2, if ambient light cancels)");
}

std::optional<BrokenRule> correlation_not_decodable(const DecodingTable& table) {
  const AmbientProjection projection(table);
  if (table.measurements() < 3 && !projection.ambient.isZero(0.0))
    return broken("measurements", table.measurements(),
                  "must be >= 3: there are three unknowns, signal, ambient light and depth");
  if (projection.rank() < 2)
    return broken("rank of correlation without ambient light", projection.rank(),
                  "must be >= 2, or depth cannot be separated from signal");
  return std::nullopt;
}

}  // namespace

std::optional<std::string> why_not_decodable(const DecodingTable& table) {
  if (const auto count = count_not_decodable(table)) return count->text();
  return text_of(correlation_not_decodable(table));
}

void DecodingTable::validate() const {
  constexpr double any = std::numeric_limits<double>::lowest();
  require(samples() >= 2, "correlation", shape_of(correlation), "must have at least 2 rows");
  require(count_not_decodable(*this));
  require_table(correlation, "correlation", *this);
  require_list(ambient_gain, "ambient_gain", any, *this);
  require_list(exposure_s, "exposure_s", 0.0, *this);
  require(exposure_s.minCoeff() > 0.0, "exposure_s", exposure_s.minCoeff(), "must be > 0");
  require_list(dark_electrons, "dark_electrons", any, *this);
  require_list(constant_variance_e2, "constant_variance_e2", 0.0, *this);
  if (shot_correlation.size() > 0) require_table(shot_correlation, "shot_correlation", *this);
  if (shot_ambient_gain.size() > 0)
    require_list(shot_ambient_gain, "shot_ambient_gain", 0.0, *this);
  if (shot_dark_electrons.size() > 0)
    require_list(shot_dark_electrons, "shot_dark_electrons", 0.0, *this);
  require_list(black_level, "black_level", any, *this);
  require_list(gain_e_per_raw, "gain_e_per_raw", 0.0, *this);
  require(gain_e_per_raw.minCoeff() > 0.0, "gain_e_per_raw", gain_e_per_raw.minCoeff(),
          "must be > 0");
  if (has_rows()) {
    require(whitening.rows() == correlation.cols() && whitening.cols() == correlation.cols(),
            "whitening", shape_of(whitening), "must be measurements x measurements");
    require(whitening.allFinite(), "whitening", "NaN or infinite", "must be finite");
  }
  const float highest = saturation_level.value_or(std::numeric_limits<float>::infinity());
  require(!std::isnan(highest), "saturation_level", highest, "must be a number");
  const float lowest = lower_saturation_level.value_or(-std::numeric_limits<float>::infinity());
  require(lowest < highest, "lower_saturation_level", lowest, "must be below saturation_level");
  require(std::isfinite(range_m) && range_m > 0.0, "range_m", range_m, "must be finite and > 0");
  require(bins >= 0, "bins", bins, "must not be negative");
  require(model_error_percent >= 0.0 && model_error_percent <= 100.0, "model_error_percent",
          model_error_percent, "must be in [0, 100]");
  require(correlation_not_decodable(*this));
}

namespace {

/// Returns the matrix that whitens noise with this covariance; 0 in directions without noise.
Eigen::MatrixXd whitening_of(const Eigen::MatrixXd& covariance) {
  constexpr double rounding = 1e-12;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(covariance);
  const double least = rounding * parts.eigenvalues().maxCoeff();
  const Eigen::VectorXd weight = (parts.eigenvalues().array() > least)
                                     .select(parts.eigenvalues().array().max(least).rsqrt(), 0.0);
  return weight.asDiagonal() * parts.eigenvectors().transpose();
}

/// Returns W with orthonormal rows and W^T W = 1 - ones / K, in whose coordinates noise with this
/// covariance is uncorrelated. The first row is 0.
Eigen::MatrixXd centring_of(const Eigen::MatrixXd& covariance) {
  const Eigen::Index rows = covariance.rows();
  const Eigen::MatrixXd basis = complement_of(Eigen::VectorXd::Ones(rows));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(basis.transpose() * covariance *
                                                             basis);
  Eigen::MatrixXd centring = Eigen::MatrixXd::Zero(rows, rows);
  centring.bottomRows(rows - 1) = (basis * parts.eigenvectors()).transpose();
  return centring;
}

/// Replaces a packed covariance C by mix C mix^T.
template <typename Row>
void mix_pairs(const Eigen::MatrixXd& mix, Row&& packed) {
  const RowCovariance one{packed, Eigen::VectorXd::Zero(packed.size()),
                          Eigen::VectorXd::Zero(packed.size())};
  const Eigen::MatrixXd mixed = mix * one.at(0, 1.0, 0.0) * mix.transpose();
  for (Eigen::Index i = 0, pair = 0; i < mixed.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j, ++pair) packed[pair] = mixed(i, j);
}

void whiten_rows(const ForwardModel& model, const Camera& camera, DecodingTable& table) {
  RowCovariance noise = row_covariance(model, model.samples());
  const OperatingPoint nominal = camera.operating.middle();
  const RowCovariance mean{noise.signal.colwise().mean(), noise.ambient, noise.floor};
  const Eigen::MatrixXd nominal_e2 = mean.at(0, nominal.signal_e_per_s, nominal.ambient_e_per_s);
  table.decoder = camera.sensor.decoder;
  if (table.decoder == RowDecoder::plain) {
    table.whitening = centring_of(nominal_e2);
    table.ambient_gain.setZero();
  } else {
    table.whitening = whitening_of(nominal_e2);
  }
  for (Eigen::Index n = 0; n < noise.signal.rows(); ++n)
    mix_pairs(table.whitening, noise.signal.row(n));
  Eigen::RowVectorXd ambient = noise.ambient, floor = noise.floor;
  mix_pairs(table.whitening, ambient);
  mix_pairs(table.whitening, floor);
  noise.ambient = ambient, noise.floor = floor;
  // Ambient light that cancels is visible only through its noise; assume the nominal level.
  if (table.ambient_gain.isZero(0.0)) {
    noise.floor += nominal.ambient_e_per_s * noise.ambient;
    noise.ambient.setZero();
  }

  const int count = model.measurements();
  table.shot_correlation.resize(model.samples(), count);
  table.shot_ambient_gain.resize(count);
  table.shot_dark_electrons = Eigen::VectorXd::Zero(count);
  for (int k = 0; k < count; ++k) {
    const int own = pairs_of(k + 1) - 1;
    table.shot_correlation.col(k) = noise.signal.col(own) / table.exposure_s[k];
    table.shot_ambient_gain[k] = noise.ambient[own] / table.exposure_s[k];
    table.constant_variance_e2[k] = noise.floor[own];
  }
  table.covariance = std::move(noise);
}

}  // namespace

DecodingTable make_decoding_table(const ForwardModel& model, const Camera& camera) {
  require(model.samples() == camera.samples, "samples of the code", model.samples(),
          "must equal the camera's samples = " + std::to_string(camera.samples));
  DecodingTable table;
  const int rows = sufficient_rows(model);
  table.correlation = model.correlation_table(rows);
  if (rows != model.samples()) table.bins = model.samples();
  table.ambient_gain = unknown_ambient_gain(model, camera);
  table.exposure_s = model.exposure_s();
  table.dark_electrons = model.dark_electrons();
  table.constant_variance_e2 = model.constant_variance_e2();
  table.range_m = camera.range_m();
  table.exposures = model.exposures();
  table.playback_offset_m = model.playback_offset_m();
  table.hidden_ambient_e_per_s = camera.operating.middle().ambient_e_per_s;
  table.working_distance_m = camera.operating.working_distance_m;

  if (model.has_rows()) whiten_rows(model, camera, table);
  const Sensor& sensor = camera.sensor;
  set_saturation(camera, table);
  const double gain_e_per_raw = sensor.gain_e_per_dn.value_or(1.0);
  table.gain_e_per_raw = Eigen::VectorXd::Constant(table.measurements(), gain_e_per_raw);
  table.black_level = Eigen::VectorXd::Zero(table.measurements());
  if (sensor.is_signed() || !sensor.subtracts())
    table.black_level.setConstant(sensor.black_level_dn.value_or(0.0));
  if (sensor.subtracts()) {
    const Eigen::MatrixXd sums = model.readout().cwiseAbs();
    table.shot_correlation = model.tap_correlation_table(rows) * sums.transpose();
    table.shot_ambient_gain = sums * model.tap_ambient_gain();
    table.shot_dark_electrons = sums * (model.tap_dark_e_per_s() * model.tap_exposure_s());
  }
  return resolved(table);
}

DecodingTable make_decoding_table(const Eigen::MatrixXd& correlation, double range_m) {
  return resolved(table_of_rows(without_noise_above_band_limit(correlation), range_m));
}

DecodingTable table_of_rows(const Eigen::MatrixXd& correlation, double range_m) {
  const Eigen::Index measurements = correlation.cols();
  DecodingTable table;
  table.correlation = correlation;
  table.ambient_gain = Eigen::VectorXd::Ones(measurements);
  table.exposure_s = Eigen::VectorXd::Ones(measurements);
  table.dark_electrons = Eigen::VectorXd::Zero(measurements);
  table.constant_variance_e2 = Eigen::VectorXd::Zero(measurements);
  table.black_level = Eigen::VectorXd::Zero(measurements);
  table.gain_e_per_raw = Eigen::VectorXd::Ones(measurements);
  table.range_m = range_m;
  return table;
}

DecodingTable whitened(const DecodingTable& table) {
  if (!table.has_rows()) return table;
  DecodingTable white = table;
  white.whitening.resize(0, 0);
  white.correlation = table.correlation * table.whitening.transpose();
  white.ambient_gain = table.whitening * table.ambient_gain;
  white.dark_electrons.setZero();
  white.black_level.setZero();
  white.gain_e_per_raw.setOnes();
  white.saturation_level.reset();
  white.lower_saturation_level.reset();
  white.marking = {};
  return white;
}

void require_exposures(const DecodingTable& table, std::string_view what) {
  require(!table.has_rows(), "sensor.readout", "rows",
          std::string(what) +
              " requires independent measurements; rows can only be decoded by zncc or ml");
}

std::vector<AmbiguousDepths> ambiguous_depths(const DecodingTable& table) {
  table.validate();
  constexpr double equal = 1e-9;
  const RowMajorMatrix curve = AmbientProjection(table).curve;
  const Eigen::Index rows = curve.rows(), bins = table.bin_count();
  RowMajorMatrix unit(bins, curve.cols());
  for (Eigen::Index n = 0; n < bins; ++n) {
    unit.row(n) = curve.row((2 * n * rows + bins) / (2 * bins) % rows);
    unit.row(n).normalize();  // zero vectors remain zero
  }
  const std::vector<std::int32_t> lowest = lowest_alike(unit, equal);

  std::vector<AmbiguousDepths> found;
  for (int n = 0; n < table.bin_count(); ++n) {
    const int first = lowest[static_cast<std::size_t>(n)];
    if (first < n) found.push_back({first, n, first * table.bin_m(), n * table.bin_m()});
  }
  return found;
}

namespace {

constexpr int max_rows = 1 << 18;
/// Permitted error between rows: 20 um minus the rounding error of float.
double depth_accuracy_m(double range_m) {
  constexpr double in_all_m = 2e-5, least_m = 5e-6, margin = 0.8;
  return margin *
         std::max(least_m, in_all_m - 0.5 * range_m * std::numeric_limits<float>::epsilon());
}

constexpr double widest_turn_rad = 15.0 * std::numbers::pi / 180.0;

int resolving_factor(const DecodingTable& table) {
  const RowMajorMatrix curve = AmbientProjection(table).curve;
  if (curve.cols() < 2) return 1;
  const std::optional<SmoothCurve> smooth = SmoothCurve::of(curve);
  if (!smooth) return 1;
  // The error is proportional to the cube of the spacing.
  const auto factor_of = [&](const SmoothCurve& at, double rows_per_row) {
    const double error_m = interpolation_error(at) * table.row_m() / rows_per_row;
    return rows_per_row * std::max(std::cbrt(error_m / depth_accuracy_m(table.range_m)),
                                   turns_of(at.points(0.0)).maxCoeff() / widest_turn_rad);
  };
  const double factor = factor_of(*smooth, 1.0);
  if (factor <= 1.0) return 1;
  // With few rows the estimate is unreliable.
  constexpr int finer = 4;
  const std::optional<SmoothCurve> fine = SmoothCurve::of(interpolated(curve, finer));
  const double needed = fine ? factor_of(*fine, finer) : factor;
  const int most = std::max(1, max_rows / table.samples());
  return static_cast<int>(std::clamp(std::ceil(needed - 1e-9), 1.0, static_cast<double>(most)));
}

Eigen::MatrixXd on_chords(const Eigen::MatrixXd& columns, int factor) {
  Eigen::MatrixXd fine(columns.rows() * factor, columns.cols());
  for (Eigen::Index n = 0; n < columns.rows(); ++n)
    for (int i = 0; i < factor; ++i) {
      const double t = static_cast<double>(i) / factor;
      fine.row(n * factor + i) =
          (1 - t) * columns.row(n) + t * columns.row((n + 1) % columns.rows());
    }
  return fine;
}

}  // namespace

int sufficient_rows(const ForwardModel& model) {
  const int samples = model.samples();
  if (model.has_rows()) return samples;
  if (const std::optional<int> highest = model.highest_harmonic()) {
    const int factor = (8 * *highest + 3 * samples - 1) / (3 * samples);
    return samples * std::clamp(factor, 1, std::max(1, max_rows / samples));
  }
  constexpr int most = 32;
  for (int rows = samples; rows <= most * samples && rows <= max_rows; ++rows)
    if (model.has_corners_at_rows(rows)) return rows;
  return samples;
}

DecodingTable resolved(const DecodingTable& table) {
  constexpr int fewest_rows = 8;
  if (table.has_rows() || table.samples() < fewest_rows || !table.correlation.allFinite())
    return table;
  const int factor = resolving_factor(table);
  if (factor == 1) return table;
  DecodingTable fine = table;
  fine.bins = table.bin_count();
  fine.correlation = interpolated(table.correlation, factor);
  if (table.shot_correlation.size() > 0)
    fine.shot_correlation = on_chords(table.shot_correlation, factor);
  return fine;
}

}  // namespace tofsmith
