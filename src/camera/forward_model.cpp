// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/forward_model.hpp"

#include <algorithm>
#include <cmath>

#include "camera/shared/actual_code.hpp"

namespace tofsmith {

namespace {

/// Contrast below 1 mixes the taps of an exposure: C x_j + (1 - C) / t sum_k x_k.
template <typename Columns>
void mix_taps(Columns& values, int taps, double contrast) {
  if (contrast == 1.0) return;
  for (Eigen::Index first = 0; first < values.cols(); first += taps) {
    const Eigen::VectorXd mean = values.middleCols(first, taps).rowwise().mean();
    for (Eigen::Index j = first; j < first + taps; ++j)
      values.col(j) = contrast * values.col(j) + (1.0 - contrast) * mean;
  }
}

/// Sensitivity of every tap value beside the mean of its pixel.
Eigen::VectorXd sensitivities(const CodeSet& code, const Sensor& sensor) {
  Eigen::VectorXd sensitivity = Eigen::VectorXd::Ones(code.measurements());
  for (int i = 0; i < code.measurements(); ++i) {
    const int place = code.taps() == 1 ? i : i % code.taps();
    sensitivity[i] += (place % 2 == 0 ? 0.5 : -0.5) * sensor.tap_mismatch;
  }
  return sensitivity;
}

}  // namespace

// Binary waveforms fall as 1/n^2, each arm of a Hann pair as 1/n^3 and of a low-pass as 1/n beyond
// its cutoff. For cutoffs within a few hundred f0 what is left out is below 1e-6; a response far
// faster than that is cut at this many harmonics, which rounds corners of the correlation function
// by 1/n of a period.
int harmonics_kept(int samples) { return std::max(2048, 8 * samples); }

Eigen::MatrixXd readout_matrix(int tap_values, Readout readout) {
  if (readout == Readout::separate) return Eigen::MatrixXd::Identity(tap_values, tap_values);
  Eigen::MatrixXd differences = Eigen::MatrixXd::Zero(tap_values / 2, tap_values);
  for (Eigen::Index i = 0; i < differences.rows(); ++i) {
    differences(i, 2 * i) = 1.0;
    differences(i, 2 * i + 1) = -1.0;
  }
  return differences;
}

double constant_variance_e2_of(const Sensor& sensor) {
  const double step_e = sensor.gain_e_per_dn.value_or(0.0);
  return sensor.read_noise_e * sensor.read_noise_e + step_e * step_e / 12.0;
}

ForwardModel::ForwardModel(const CodeSet& code, const Camera& camera)
    : samples_(code.samples()),
      taps_(code.taps()),
      contrast_(camera.sensor.modulation_contrast),
      sensitivity_(sensitivities(code, camera.sensor)),
      dark_current_e_per_s_(camera.sensor.dark_current_e_per_s),
      tap_constant_variance_e2_(constant_variance_e2_of(camera.sensor)) {
  camera.validate();
  require_fits(code, camera);
  const int tap_values = code.measurements();
  readout_ = readout_matrix(tap_values, camera.sensor.readout);

  const Eigen::VectorXcd transfer =
      camera.band_limited() ? camera.transfer(harmonics_kept(code.samples())) : Eigen::VectorXcd();
  const ActualCode actual = actual_code(code, camera);
  const double offset_m = (camera.playback ? camera.playback->offset_m : 0.0) +
                          (camera.temperature ? camera.temperature->offset_m() : 0.0);
  const bool reversed = camera.playback && camera.playback->reversed;
  if (camera.temperature) signal_gain_ = camera.temperature->signal_gain();
  Eigen::RowVectorXd gain(tap_values);
  tap_exposure_s_.resize(tap_values);
  for (int i = 0; i < tap_values; ++i) {
    const Waveform& d = actual.demodulation[static_cast<std::size_t>(i)];
    const Waveform& m = actual.modulation[static_cast<std::size_t>(code.exposure_of(i))];
    functions_.push_back(camera.band_limited() ? CorrelationFunction(d, m, transfer)
                                               : CorrelationFunction(d, m));
    if (offset_m != 0.0 || reversed)
      functions_.back() = functions_.back().moved(-offset_m / camera.range_m(), reversed);
    gain[i] = d.mean();
    tap_exposure_s_[i] = camera.exposure_s.of(code.exposure_of(i), code.exposures());
  }
  mix_taps(gain, taps_, contrast_);
  tap_ambient_gain_ = gain.transpose().cwiseProduct(sensitivity_);
  ambient_gain_ = readout_ * tap_ambient_gain_;
  exposure_s_.resize(measurements());
  for (int i = 0; i < measurements(); ++i)
    exposure_s_[i] = tap_exposure_s_[i * tap_values / measurements()];
}

Eigen::VectorXd ForwardModel::tap_correlation(double depth_bin) const {
  Eigen::RowVectorXd values(tap_values());
  for (int i = 0; i < tap_values(); ++i)
    values[i] = functions_[static_cast<std::size_t>(i)](depth_bin / samples_);
  mix_taps(values, taps_, contrast_);
  return signal_gain_ * values.transpose().cwiseProduct(sensitivity_);
}

Eigen::VectorXd ForwardModel::correlation(double depth_bin) const {
  return readout_ * tap_correlation(depth_bin);
}

Eigen::MatrixXd ForwardModel::tap_correlation_table(int points) const {
  Eigen::MatrixXd table(points, tap_values());
  for (int i = 0; i < tap_values(); ++i)
    table.col(i) = functions_[static_cast<std::size_t>(i)].table(points);
  mix_taps(table, taps_, contrast_);
  return table * (signal_gain_ * sensitivity_).asDiagonal();
}

Eigen::MatrixXd ForwardModel::correlation_table(int points) const {
  return tap_correlation_table(points) * readout_.transpose();
}

Eigen::VectorXd ForwardModel::dark_electrons() const {
  return readout_ * (dark_current_e_per_s_ * tap_exposure_s_);
}

Eigen::VectorXd ForwardModel::constant_variance_e2() const {
  return tap_constant_variance_e2_ * readout_.cwiseAbs().rowwise().sum();
}

Eigen::VectorXd ForwardModel::expected_tap_electrons(std::span<const Return> returns,
                                                     double ambient_e_per_s) const {
  Eigen::VectorXd rate = (ambient_e_per_s * tap_ambient_gain_).array() + dark_current_e_per_s_;
  for (const Return& r : returns) rate += r.signal_e_per_s * tap_correlation(r.depth_bin);
  return tap_exposure_s_.cwiseProduct(rate);
}

Eigen::VectorXd ForwardModel::expected_electrons(std::span<const Return> returns,
                                                 double ambient_e_per_s) const {
  return readout_ * expected_tap_electrons(returns, ambient_e_per_s);
}

Eigen::VectorXd ForwardModel::variance_e2(std::span<const Return> returns,
                                          double ambient_e_per_s) const {
  return readout_.cwiseAbs() * expected_tap_electrons(returns, ambient_e_per_s) +
         constant_variance_e2();
}

Eigen::VectorXd unknown_ambient_gain(const ForwardModel& model, const Camera& camera) {
  constexpr double share_of_noise = 0.05;
  const std::vector<double>& ambient = camera.operating.ambient_e_per_s;
  const double max_e_per_s =
      ambient.empty() ? 0.0 : *std::max_element(ambient.begin(), ambient.end());
  const Eigen::VectorXd light_e = max_e_per_s * model.exposure_s();
  const Eigen::ArrayXd leak_e = light_e.cwiseProduct(model.ambient_gain()).array().abs();
  const Eigen::ArrayXd variance_e2 = model.variance_e2({}, max_e_per_s).array();
  const bool cancels = camera.sensor.readout == Readout::difference && !ambient.empty() &&
                       (leak_e <= share_of_noise * variance_e2.sqrt()).all();
  if (cancels) return Eigen::VectorXd::Zero(model.measurements());
  return model.ambient_gain();
}

}  // namespace tofsmith
