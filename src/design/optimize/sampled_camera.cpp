// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/sampled_camera.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "camera/shared/ambient_leak.hpp"
#include "core/shared/whole_vectors.hpp"
#include "design/grid_transfer.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Contrast below 1 mixes the taps of an exposure: C x_j + (1 - C) / t sum_k x_k.
Eigen::MatrixXd mixing_matrix(int exposures, int taps, const Sensor& sensor) {
  const std::vector<double>& each = sensor.modulation_contrasts;
  require(each.empty() || each.size() == static_cast<std::size_t>(exposures),
          "number of sensor.modulation_contrast", each.size(),
          "must be 1 or equal the " + std::to_string(exposures) + " exposures of a design");
  Eigen::MatrixXd mixing = Eigen::MatrixXd::Zero(exposures * taps, exposures * taps);
  for (int e = 0; e < exposures; ++e) {
    const double contrast =
        each.empty() ? sensor.modulation_contrast : each[static_cast<std::size_t>(e)];
    mixing.block(e * taps, e * taps, taps, taps) =
        contrast * Eigen::MatrixXd::Identity(taps, taps) +
        Eigen::MatrixXd::Constant(taps, taps, (1.0 - contrast) / taps);
  }
  return mixing;
}

Eigen::VectorXd sensitivities(int exposures, int taps, double mismatch) {
  Eigen::VectorXd sensitivity = Eigen::VectorXd::Ones(exposures * taps);
  for (int i = 0; i < exposures * taps; ++i)
    sensitivity[i] += ((taps == 1 ? i : i % taps) % 2 == 0 ? 0.5 : -0.5) * mismatch;
  return sensitivity;
}

}  // namespace

bool sees_ambient(const Camera& camera, int exposures) {
  if (camera.sensor.readout != Readout::difference) return true;
  if (camera.sensor.tap_mismatch == 0.0) return false;
  const double leak = 0.5 * std::abs(camera.sensor.tap_mismatch);
  const std::vector<double>& each_s = camera.exposure_s.each_s;
  const double exposure_s = each_s.empty() ? camera.exposure_s.total_s / exposures
                                           : *std::max_element(each_s.begin(), each_s.end());
  const double light_e = exposure_s * brightest_ambient_e_per_s(camera);
  const double variance_e2 = light_e + 2.0 * exposure_s * camera.sensor.dark_current_e_per_s +
                             2.0 * constant_variance_e2_of(camera.sensor);
  return !ambient_cancels(camera, Eigen::VectorXd::Constant(1, leak * light_e),
                          Eigen::VectorXd::Constant(1, variance_e2));
}

SampledCamera::SampledCamera(const Camera& camera, int samples, int exposures)
    : SampledCamera(in_buckets(camera), samples, exposures,
                    camera.sensor.is_signed() && !camera.sensor.binary) {}

SampledCamera::SampledCamera(const Camera& camera, int samples, int exposures, bool squares)
    : transform_(samples),
      exposures_(exposures),
      taps_(camera.sensor.taps),
      difference_(camera.sensor.readout == Readout::difference),
      ambient_unknown_(sees_ambient(camera, exposures)),
      squares_(squares),
      transfer_(grid_transfer(camera, samples) / static_cast<double>(samples)),
      total_s_(camera.exposure_s.sum_s()),
      dark_e_per_s_(camera.sensor.dark_current_e_per_s),
      read_variance_e2_(constant_variance_e2_of(camera.sensor)) {
  const int tap_values = exposures * taps_;
  const Eigen::MatrixXd readout = readout_matrix(tap_values, camera.sensor.readout);
  const Eigen::MatrixXd mixing =
      sensitivities(exposures, taps_, camera.sensor.tap_mismatch).asDiagonal() *
      mixing_matrix(exposures, taps_, camera.sensor);
  combination_ = readout * mixing;
  shot_combination_ = readout.cwiseAbs() * mixing;
  Eigen::VectorXd exposure_s(measurements());
  const int per_exposure = measurements() / exposures;
  for (int i = 0; i < measurements(); ++i)
    exposure_s[i] = camera.exposure_s.of(i / per_exposure, exposures);
  dark_electrons_ = readout.rowwise().sum().cwiseProduct(
      (camera.sensor.dark_current_e_per_s * exposure_s).array().matrix());
  taps_read_ = readout.cwiseAbs().rowwise().sum();
  times_ = times_for(std::move(exposure_s));
}

MeasurementTimes SampledCamera::times_for(Eigen::VectorXd exposure_s) const {
  MeasurementTimes times;
  times.constant_variance_e2 =
      taps_read_.cwiseProduct((dark_e_per_s_ * exposure_s).array().matrix() +
                              Eigen::VectorXd::Constant(measurements(), read_variance_e2_));
  times.exposure_s = std::move(exposure_s);
  return times;
}

MeasurementTimes SampledCamera::times(const Eigen::VectorXd& shares) const {
  const int per_exposure = measurements() / exposures_;
  return times_for(total_s_ * shares.transpose().replicate(per_exposure, 1).reshaped());
}

Eigen::VectorXd SampledCamera::pull_back_times(const Eigen::VectorXd& by_exposure_s) const {
  const int per_exposure = measurements() / exposures_;
  return total_s_ * by_exposure_s.reshaped(per_exposure, exposures_).colwise().sum().transpose();
}

SampledCamera::Measured SampledCamera::transformed(const SampledCode& code) const {
  Measured measured;
  const auto spectra_of = [&](const Eigen::MatrixXd& columns,
                              std::vector<Eigen::VectorXcd>& spectra) {
    spectra.resize(static_cast<std::size_t>(columns.cols()));
    Eigen::VectorXd signal;
    for (Eigen::Index i = 0; i < columns.cols(); ++i) {
      signal = columns.col(i);
      transform_.forward(signal, spectra[static_cast<std::size_t>(i)]);
    }
  };
  spectra_of(code.modulation, measured.modulation);
  spectra_of(code.demodulation, measured.demodulation);
  return measured;
}

SampledCamera::Measured SampledCamera::measure(const SampledCode& code) const {
  Measured measured = transformed(code);
  measured.times = code.shares.size() > 0 ? times(code.shares) : times_;
  Eigen::MatrixXd correlation(samples(), exposures_ * taps_);
  Eigen::VectorXd signal;
  for (int e = 0; e < exposures_; ++e) {
    const Eigen::VectorXcd seen =
        measured.modulation[static_cast<std::size_t>(e)].conjugate().cwiseProduct(transfer_);
    for (int i = e * taps_; i < (e + 1) * taps_; ++i) {
      transform_.inverse(measured.demodulation[static_cast<std::size_t>(i)].cwiseProduct(seen),
                         signal);
      correlation.col(i) = signal;
    }
  }
  const Eigen::VectorXd gain = code.demodulation.colwise().mean().transpose();
  measured.table.correlation = correlation * combination_.transpose();
  measured.table.ambient_gain = combination_ * gain;
  if (difference_) {
    measured.table.shot_correlation = correlation * shot_combination_.transpose();
    measured.table.shot_ambient_gain = shot_combination_ * gain;
  }
  if (squares_) measure_squares(code, measured);
  return measured;
}

void SampledCamera::measure_squares(const SampledCode& code, Measured& measured) const {
  measured.weight.resize(samples(), exposures_);
  measured.square.resize(static_cast<std::size_t>(exposures_));
  Eigen::VectorXd signal;
  for (int e = 0; e < exposures_; ++e) {
    measured.weight.col(e) = code.demodulation.col(2 * e) - code.demodulation.col(2 * e + 1);
    signal = measured.weight.col(e).cwiseAbs2();
    measured.table.shot_ambient_gain[e] = signal.mean();
    Eigen::VectorXcd& square = measured.square[static_cast<std::size_t>(e)];
    transform_.forward(signal, square);
    const Eigen::VectorXcd& m = measured.modulation[static_cast<std::size_t>(e)];
    transform_.inverse(square.cwiseProduct(m.conjugate()).cwiseProduct(transfer_), signal);
    measured.table.shot_correlation.col(e) = signal;
  }
}

SampledCode SampledCamera::pull_back(const Measured& measured,
                                     const MeasurementTable& gradient) const {
  Eigen::MatrixXd by_tap = gradient.correlation * combination_;
  Eigen::VectorXd by_gain = combination_.transpose() * gradient.ambient_gain;
  if (difference_ && !squares_) {
    by_tap += gradient.shot_correlation * shot_combination_;
    by_gain += shot_combination_.transpose() * gradient.shot_ambient_gain;
  }
  SampledCode result{Eigen::MatrixXd(samples(), exposures_),
                     Eigen::MatrixXd(samples(), exposures_ * taps_)};
  Eigen::VectorXd signal;
  Eigen::VectorXcd spectrum;
  for (int e = 0; e < exposures_; ++e) {
    const Eigen::VectorXcd& m = measured.modulation[static_cast<std::size_t>(e)];
    Eigen::VectorXcd by_modulation = Eigen::VectorXcd::Zero(transfer_.size());
    for (int i = e * taps_; i < (e + 1) * taps_; ++i) {
      // chi = F^-1 (D conj(M) G / N). The adjoint w.r.t. d multiplies by M conj(G); w.r.t. m it is
      // conj(gradient) D G.
      signal = by_tap.col(i);
      transform_.forward(signal, spectrum);
      const Eigen::VectorXcd& d = measured.demodulation[static_cast<std::size_t>(i)];
      by_modulation += spectrum.conjugate().cwiseProduct(d).cwiseProduct(transfer_);
      transform_.inverse(spectrum.cwiseProduct(m).cwiseProduct(transfer_.conjugate()), signal);
      result.demodulation.col(i) = signal.array() + by_gain[i] / samples();
    }
    if (squares_) {
      signal = gradient.shot_correlation.col(e);
      transform_.forward(signal, spectrum);
      by_modulation += spectrum.conjugate()
                           .cwiseProduct(measured.square[static_cast<std::size_t>(e)])
                           .cwiseProduct(transfer_);
      transform_.inverse(spectrum.cwiseProduct(m).cwiseProduct(transfer_.conjugate()), signal);
      const Eigen::VectorXd by_weight =
          2.0 * measured.weight.col(e).array() *
          (signal.array() + gradient.shot_ambient_gain[e] / samples());
      result.demodulation.col(2 * e) += by_weight;
      result.demodulation.col(2 * e + 1) -= by_weight;
    }
    transform_.inverse(by_modulation, signal);
    result.modulation.col(e) = signal;
  }
  return result;
}

MeasurementTable zeros_like(const MeasurementTable& table) {
  MeasurementTable zeros;
  zeros.correlation = Eigen::MatrixXd::Zero(table.samples(), table.measurements());
  zeros.ambient_gain = Eigen::VectorXd::Zero(table.measurements());
  if (table.shot_correlation.size() > 0) {
    zeros.shot_correlation = zeros.correlation;
    zeros.shot_ambient_gain = zeros.ambient_gain;
  }
  return zeros;
}

namespace {

/// Zero if ambient light is not estimated.
Eigen::VectorXd ambient_direction(const SampledCamera& camera, const MeasurementTable& table,
                                  const Eigen::VectorXd& relative_exposure) {
  const Eigen::VectorXd ambient = relative_exposure.cwiseProduct(table.ambient_gain);
  const double length = ambient.norm();
  if (!camera.ambient_unknown() || length == 0.0) return Eigen::VectorXd::Zero(ambient.size());
  return ambient / length;
}

}  // namespace

template <typename Value>
DecodingCurveOf<Value>::DecodingCurveOf(const SampledCamera& camera, const MeasurementTable& table,
                                        const Eigen::VectorXd& times_s)
    : samples(table.samples()),
      measurements(table.measurements()),
      stride(whole_vectors(samples + 1) + widest_vector),
      exposure_s(times_s) {
  const Eigen::VectorXd relative = exposure_s / exposure_s.mean();
  const Eigen::VectorXd direction = ambient_direction(camera, table, relative);
  exact_points = table.correlation * relative.asDiagonal();
  exact_points -= (exact_points * direction) * direction.transpose();
  const auto size = static_cast<std::size_t>(stride);
  points.assign(size * static_cast<std::size_t>(measurements), Value{0});
  squares.assign(size, Value{0});
  products.assign(size, Value{0});
  inverse_lengths.assign(size, Value{0});
  for (int j = 0; j <= samples; ++j) {
    const int at = j % samples, next = (at + 1) % samples;
    for (int r = 0; r < measurements; ++r)
      points[static_cast<std::size_t>(r) * size + static_cast<std::size_t>(j)] =
          static_cast<Value>(exact_points(at, r));
    squares[static_cast<std::size_t>(j)] = static_cast<Value>(exact_points.row(at).squaredNorm());
    products[static_cast<std::size_t>(j)] =
        static_cast<Value>(exact_points.row(at).dot(exact_points.row(next)));
    inverse_lengths[static_cast<std::size_t>(j)] =
        1 / std::sqrt(squares[static_cast<std::size_t>(j)] + smallest_square<Value>);
  }
}

template <typename Value>
CurveGradientOf<Value>::CurveGradientOf(const DecodingCurveOf<Value>& curve)
    : points(curve.points.size(), Value{0}),
      squares(curve.squares.size(), Value{0}),
      next_squares(curve.squares.size(), Value{0}),
      products(curve.squares.size(), Value{0}) {}

template <typename Value>
void CurveGradientOf<Value>::pull_back(const SampledCamera& camera, const MeasurementTable& table,
                                       const DecodingCurveOf<Value>& curve,
                                       MeasurementTable& gradient,
                                       Eigen::VectorXd* by_exposure_s) const {
  const int samples = curve.samples;
  Eigen::MatrixXd by_points(samples, curve.measurements);
  for (int j = 0; j < samples; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const int next = (j + 1) % samples, last = (j + samples - 1) % samples;
    const double by_square = squares[at] + next_squares[static_cast<std::size_t>(last)];
    for (int r = 0; r < curve.measurements; ++r)
      by_points(j, r) =
          points[static_cast<std::size_t>(r) * static_cast<std::size_t>(curve.stride) + at] +
          2.0 * by_square * curve.exact_points(j, r) + products[at] * curve.exact_points(next, r) +
          products[static_cast<std::size_t>(last)] * curve.exact_points(last, r);
  }
  // p_j = x_j - a (a . x_j) / |a|^2, with a / |a| = n. The gradient w.r.t. x_j is P G_j; w.r.t. a
  // it is -sum_j [P G_j (n . x_j) + p_j (n . G_j)] / |a|.
  const Eigen::VectorXd exposure = curve.exposure_s / curve.exposure_s.mean();
  const Eigen::VectorXd direction = ambient_direction(camera, table, exposure);
  const Eigen::VectorXd along = by_points * direction;
  by_points -= along * direction.transpose();
  gradient.correlation += by_points * exposure.asDiagonal();
  Eigen::VectorXd by_ambient = Eigen::VectorXd::Zero(curve.measurements);
  if (!direction.isZero(0.0)) {
    const Eigen::VectorXd curve_along = (table.correlation * exposure.asDiagonal()) * direction;
    const double length = exposure.cwiseProduct(table.ambient_gain).norm();
    by_ambient =
        -(by_points.transpose() * curve_along + curve.exact_points.transpose() * along) / length;
    gradient.ambient_gain += by_ambient.cwiseProduct(exposure);
  }
  if (!by_exposure_s) return;
  // x_i = g_i chi_i, a_i = g_i kappa_i, and g_i = T_i / mean T has the mean 1.
  const Eigen::VectorXd by_relative =
      by_points.cwiseProduct(table.correlation).colwise().sum().transpose() +
      by_ambient.cwiseProduct(table.ambient_gain);
  const double along_times = by_relative.dot(exposure) / curve.measurements;
  *by_exposure_s += (by_relative.array() - along_times).matrix() / curve.exposure_s.mean();
}

template struct DecodingCurveOf<float>;
template struct DecodingCurveOf<double>;
template struct CurveGradientOf<float>;
template struct CurveGradientOf<double>;

}  // namespace tofsmith
