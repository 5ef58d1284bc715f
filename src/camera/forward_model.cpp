// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/forward_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "camera/shared/actual_code.hpp"
#include "camera/shared/ambient_leak.hpp"
#include "camera/shared/listed_exposures.hpp"
#include "core/shared/periodic.hpp"

namespace tofsmith {

namespace {

/// Mixes taps for a contrast below 1: C x_j + (1 - C) / t sum_k x_k.
template <typename Columns>
void mix_taps(Columns& values, int taps, const std::vector<double>& contrasts) {
  for (Eigen::Index first = 0; first < values.cols(); first += taps) {
    const double contrast = contrasts[static_cast<std::size_t>(first / taps)];
    if (contrast == 1.0) continue;
    const Eigen::VectorXd mean = values.middleCols(first, taps).rowwise().mean();
    for (Eigen::Index j = first; j < first + taps; ++j)
      values.col(j) = contrast * values.col(j) + (1.0 - contrast) * mean;
  }
}

/// Sensitivity of every tap value relative to the mean of its pixel.
Eigen::VectorXd sensitivities(const CodeSet& code, const Sensor& sensor) {
  Eigen::VectorXd sensitivity = Eigen::VectorXd::Ones(code.measurements());
  for (int i = 0; i < code.measurements(); ++i) {
    const int place = code.taps() == 1 ? i : i % code.taps();
    sensitivity[i] += (place % 2 == 0 ? 0.5 : -0.5) * sensor.tap_mismatch;
  }
  if (!code.is_signed()) return sensitivity;
  return sensitivity.transpose().replicate(2, 1).reshaped();  // both signs of an exposure
}

/// x^2 of a waveform that is not binary.
Waveform squared(const Waveform& x) {
  if (x.is_sampled()) return Waveform::sampled(x.samples().array().square());
  const Eigen::VectorXcd& c = x.coefficients();
  const Eigen::Index highest = c.size() - 1;
  const auto at = [&](Eigen::Index n) {
    if (std::abs(n) > highest) return std::complex<double>(0.0);
    return n >= 0 ? c[n] : std::conj(c[-n]);
  };
  Eigen::VectorXcd product = Eigen::VectorXcd::Zero(2 * highest + 1);
  for (Eigen::Index n = 0; n <= 2 * highest; ++n)
    for (Eigen::Index j = -highest; j <= highest; ++j) product[n] += at(j) * at(n - j);
  product[0] = product[0].real();
  return Waveform::cosines(std::move(product));
}

/// a x + b y + c, of the same kind.
Waveform combined(const Waveform& x, double a, const Waveform& y, double b, double c) {
  if (x.is_sampled())
    return Waveform::sampled(a * x.samples().array() + b * y.samples().array() + c);
  Eigen::VectorXcd sum = a * x.coefficients();
  sum.head(y.coefficients().size()) += b * y.coefficients();
  sum[0] += c;
  return Waveform::cosines(std::move(sum));
}

/// Two taps of a mixer with drive x and weight w = 2 x - 1: (w^2 + w) / 2 and (w^2 - w) / 2.
std::array<Waveform, 2> taps_of_weight(const Waveform& drive) {
  if (drive.is_binary()) return {drive, drive.complement()};
  const Waveform square = squared(drive);
  // x (2 x - 1) and (1 - x) (1 - 2 x) = x (2 x - 1) + 1 - 2 x.
  return {combined(square, 2.0, drive, -1.0, 0.0), combined(square, 2.0, drive, -3.0, 1.0)};
}

/// Demodulation functions of the tap values.
std::vector<Waveform> tap_functions(const CodeSet& code, std::vector<Waveform> demodulation) {
  if (!code.is_signed()) return demodulation;
  std::vector<Waveform> taps;
  for (const Waveform& drive : demodulation)
    for (Waveform& tap : taps_of_weight(drive)) taps.push_back(std::move(tap));
  return taps;
}

/// Constant that [playback] adds to the depth of each exposure [m].
std::vector<double> offsets_m(const CodeSet& code, const Camera& camera) {
  const Playback playback = camera.playback.value_or(Playback());
  return in_camera_order(playback.offsets_of(code, camera.range_m()), camera);
}

}  // namespace

// Harmonics decrease as 1/n^2 for binary waveforms, as 1/n^3 for each arm with a Hann response, and
// as 1/n for a low-pass beyond its cutoff. For cutoffs within a few hundred f0, the omitted
// harmonics are below 1e-6; otherwise corners are rounded by 1/n of a period.
int harmonics_kept(int samples) { return std::max(2048, 8 * samples); }

Eigen::MatrixXd readout_matrix(int tap_values, Readout readout) {
  if (readout != Readout::difference) return Eigen::MatrixXd::Identity(tap_values, tap_values);
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
    : samples_(code.samples()), taps_(code.is_signed() ? 2 : code.taps()) {
  camera.validate();
  require_fits(code, camera);
  contrasts_ = in_camera_order(camera.sensor.contrasts_of(code), camera);
  sensitivity_ = sensitivities(code, camera.sensor);
  const Sensor sensor = in_buckets(camera).sensor;
  tap_dark_e_per_s_ = sensor.dark_current_e_per_s;
  readout_variance_e2_ = constant_variance_e2_of(sensor);

  const Eigen::VectorXcd transfer =
      camera.band_limited() ? camera.transfer(harmonics_kept(code.samples())) : Eigen::VectorXcd();
  const ActualCode actual = actual_code(code, camera);
  std::vector<double> offset_m = offsets_m(code, camera);
  playback_offset_m_ =
      std::accumulate(offset_m.begin(), offset_m.end(), 0.0) / static_cast<double>(offset_m.size());
  for (double& offset : offset_m)
    offset += camera.temperature ? camera.temperature->offset_m() : 0.0;
  const bool reversed = camera.playback && camera.playback->reversed;
  if (camera.temperature) signal_gain_ = camera.temperature->signal_gain();
  const std::vector<Waveform> demodulation = tap_functions(code, actual.demodulation);
  const auto tap_values = static_cast<int>(demodulation.size());
  Eigen::RowVectorXd gain(tap_values);
  tap_exposure_s_.resize(tap_values);
  const std::vector<double> times_s = exposure_times_s(code, camera);
  for (int i = 0; i < tap_values; ++i) {
    const int exposure = i / taps_;
    const Waveform& d = demodulation[static_cast<std::size_t>(i)];
    const Waveform& m = actual.modulation[static_cast<std::size_t>(exposure)];
    functions_.push_back(camera.band_limited() ? CorrelationFunction(d, m, transfer)
                                               : CorrelationFunction(d, m));
    const double moved = -offset_m[static_cast<std::size_t>(exposure)] / camera.range_m();
    if (moved != 0.0 || reversed) functions_.back() = functions_.back().moved(moved, reversed);
    gain[i] = d.mean();
    tap_exposure_s_[i] = times_s[static_cast<std::size_t>(exposure)];
  }
  if (code.is_rows()) {
    read_rows(code, actual.modulation.front(), transfer, -offset_m.front() / camera.range_m());
    return;
  }
  readout_ = readout_matrix(tap_values, sensor.readout);
  mix_taps(gain, taps_, contrasts_);
  tap_ambient_gain_ = gain.transpose().cwiseProduct(sensitivity_);
  ambient_gain_ = readout_ * tap_ambient_gain_;
  exposure_s_.resize(measurements());
  for (int i = 0; i < measurements(); ++i)
    exposure_s_[i] = tap_exposure_s_[i * tap_values / measurements()];
}

/// Taps are time bins, which share the light of the exposure.
void ForwardModel::read_rows(const CodeSet& code, const Waveform& light,
                             const Eigen::VectorXcd& transfer, double moved) {
  const double share = 1.0 / samples_;
  const Waveform bin = Waveform::binary({{0.0, share}});
  time_bin_ = transfer.size() > 0 ? CorrelationFunction(bin, light, transfer)
                                  : CorrelationFunction(bin, light);
  if (moved != 0.0) time_bin_ = time_bin_->moved(moved, false);
  readout_ = code.demodulation_samples().transpose();
  tap_dark_e_per_s_ *= share;
  tap_ambient_gain_ = Eigen::VectorXd::Constant(samples_, share);
  ambient_gain_ = readout_ * tap_ambient_gain_;
  const double exposure_s = tap_exposure_s_[0];
  tap_exposure_s_ = Eigen::VectorXd::Constant(samples_, exposure_s);
  exposure_s_ = Eigen::VectorXd::Constant(measurements(), exposure_s);
}

Eigen::VectorXd ForwardModel::tap_correlation(double depth_bin) const {
  if (time_bin_) {
    Eigen::VectorXd light(samples_);
    for (int n = 0; n < samples_; ++n) light[n] = (*time_bin_)((depth_bin - n) / samples_);
    return signal_gain_ * light;
  }
  Eigen::RowVectorXd values(tap_values());
  for (int i = 0; i < tap_values(); ++i)
    values[i] = functions_[static_cast<std::size_t>(i)](depth_bin / samples_);
  mix_taps(values, taps_, contrasts_);
  return signal_gain_ * values.transpose().cwiseProduct(sensitivity_);
}

Eigen::VectorXd ForwardModel::correlation(double depth_bin) const {
  if (!time_bin_) return readout_ * tap_correlation(depth_bin);
  Eigen::VectorXd values(measurements());
  for (int i = 0; i < measurements(); ++i)
    values[i] = signal_gain_ * functions_[static_cast<std::size_t>(i)](depth_bin / samples_);
  return values;
}

Eigen::VectorXd ForwardModel::time_bin_table(int points) const {
  require(has_rows(), "sensor.readout", "exposures", "must be \"rows\" for light in time bins");
  return signal_gain_ * time_bin_->table(points);
}

Eigen::MatrixXd ForwardModel::tap_correlation_table(int points) const {
  if (time_bin_) {
    Eigen::MatrixXd table(points, samples_);
    if (points % samples_ == 0) {
      const Eigen::VectorXd bin = time_bin_table(points);
      const int step = points / samples_;
      for (int n = 0; n < samples_; ++n) table.col(n) = circular_shift(bin, n * step);
      return table;
    }
    for (int j = 0; j < points; ++j)
      table.row(j) = tap_correlation(static_cast<double>(j) * samples_ / points);
    return table;
  }
  Eigen::MatrixXd table(points, tap_values());
  for (int i = 0; i < tap_values(); ++i)
    table.col(i) = functions_[static_cast<std::size_t>(i)].table(points);
  mix_taps(table, taps_, contrasts_);
  return table * (signal_gain_ * sensitivity_).asDiagonal();
}

Eigen::MatrixXd ForwardModel::correlation_table(int points) const {
  if (!time_bin_) return tap_correlation_table(points) * readout_.transpose();
  Eigen::MatrixXd table(points, measurements());
  for (int i = 0; i < measurements(); ++i)
    table.col(i) = signal_gain_ * functions_[static_cast<std::size_t>(i)].table(points);
  return table;
}

Eigen::VectorXd ForwardModel::harmonic_energies() const {
  Eigen::VectorXd energy;
  for (const CorrelationFunction& function : functions_) {
    const Eigen::VectorXcd& harmonics = function.harmonics();
    if (harmonics.size() == 0) return {};
    if (harmonics.size() > energy.size()) {
      Eigen::VectorXd longer = Eigen::VectorXd::Zero(harmonics.size());
      longer.head(energy.size()) = energy;
      energy = std::move(longer);
    }
    energy.head(harmonics.size()) += harmonics.cwiseAbs2();
  }
  return energy;
}

std::optional<int> ForwardModel::highest_harmonic() const {
  constexpr double negligible = 3e-7;
  const Eigen::VectorXd energy = harmonic_energies();
  if (energy.size() == 0) return std::nullopt;
  const double whole = energy.tail(energy.size() - 1).sum();
  double above = 0.0;
  Eigen::Index highest = energy.size() - 1;
  for (; highest > 1; --highest) {
    above += energy[highest];
    if (above > negligible * negligible * whole) break;
  }
  return static_cast<int>(highest);
}

int ForwardModel::straight_points_per_bin(int least) const {
  // The error of a chord of a cosine is (2 pi / points per period)^2 / 8 of its amplitude.
  constexpr double per_period = 96.0, most = 1 << 20;
  double curvature = 0.0, amplitude = 0.0;
  const Eigen::VectorXd energy = harmonic_energies();
  for (Eigen::Index n = 1; n < energy.size(); ++n) {
    amplitude += std::sqrt(energy[n]);
    curvature += static_cast<double>(n * n) * std::sqrt(energy[n]);
  }
  const double wanted = amplitude > 0.0 ? per_period * std::sqrt(curvature / amplitude) : 0.0;
  int points_per_bin = least;
  while (points_per_bin * samples_ < wanted && 2.0 * points_per_bin * samples_ <= most)
    points_per_bin *= 2;
  return points_per_bin;
}

bool ForwardModel::has_corners_at_rows(int rows) const {
  return std::all_of(functions_.begin(), functions_.end(),
                     [&](const CorrelationFunction& f) { return f.has_corners_at(rows); });
}

Eigen::VectorXd ForwardModel::dark_electrons() const {
  return readout_ * (tap_dark_e_per_s_ * tap_exposure_s_);
}

Eigen::VectorXd ForwardModel::constant_variance_e2() const {
  if (time_bin_) return Eigen::VectorXd::Constant(measurements(), readout_variance_e2_);
  return readout_variance_e2_ * readout_.cwiseAbs2().rowwise().sum();
}

Eigen::VectorXd ForwardModel::expected_tap_electrons(std::span<const Return> returns,
                                                     double ambient_e_per_s) const {
  Eigen::VectorXd rate = (ambient_e_per_s * tap_ambient_gain_).array() + tap_dark_e_per_s_;
  for (const Return& r : returns) rate += r.signal_e_per_s * tap_correlation(r.depth_bin);
  return tap_exposure_s_.cwiseProduct(rate);
}

Eigen::VectorXd ForwardModel::expected_electrons(std::span<const Return> returns,
                                                 double ambient_e_per_s) const {
  return readout_ * expected_tap_electrons(returns, ambient_e_per_s);
}

Eigen::VectorXd ForwardModel::variance_e2(std::span<const Return> returns,
                                          double ambient_e_per_s) const {
  return readout_.cwiseAbs2() * expected_tap_electrons(returns, ambient_e_per_s) +
         constant_variance_e2();
}

Eigen::MatrixXd ForwardModel::covariance_e2(std::span<const Return> returns,
                                            double ambient_e_per_s) const {
  Eigen::MatrixXd covariance = readout_ *
                               expected_tap_electrons(returns, ambient_e_per_s).asDiagonal() *
                               readout_.transpose();
  covariance.diagonal() += constant_variance_e2();
  return covariance;
}

Eigen::MatrixXd RowCovariance::at(Eigen::Index row, double signal_e_per_s,
                                  double ambient_e_per_s) const {
  Eigen::Index measurements = 0;
  while (pairs_of(static_cast<int>(measurements)) < ambient.size()) ++measurements;
  Eigen::MatrixXd covariance(measurements, measurements);
  for (Eigen::Index i = 0, pair = 0; i < measurements; ++i)
    for (Eigen::Index j = 0; j <= i; ++j, ++pair)
      covariance(i, j) = covariance(j, i) =
          signal_e_per_s * signal(row, pair) + ambient_e_per_s * ambient[pair] + floor[pair];
  return covariance;
}

RowCovariance row_covariance(const ForwardModel& model, int points) {
  const int samples = model.samples(), step = points / samples;
  require(points > 0 && points % samples == 0, "points", points,
          "must be a multiple of the samples");
  // Light in time bin 0 at depths with the same position in their bin.
  const Eigen::VectorXd bin = model.tap_exposure_s()[0] * model.time_bin_table(points);
  Eigen::MatrixXd phases(samples, step);
  for (int j = 0; j < points; ++j) phases(j / step, j % step) = bin[j];

  const Eigen::MatrixXd& rows = model.readout();
  const Eigen::VectorXd dark_e = model.expected_tap_electrons({}, 0.0);
  const Eigen::VectorXd ambient_e = model.expected_tap_electrons({}, 1.0) - dark_e;
  const Eigen::VectorXd constant_e2 = model.constant_variance_e2();
  const int pairs = pairs_of(model.measurements());
  RowCovariance covariance{Eigen::MatrixXd(points, pairs), Eigen::VectorXd(pairs),
                           Eigen::VectorXd(pairs)};
  for (Eigen::Index i = 0, pair = 0; i < rows.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j, ++pair) {
      const Eigen::VectorXd product = rows.row(i).cwiseProduct(rows.row(j)).transpose();
      for (int phase = 0; phase < step; ++phase) {
        const Eigen::VectorXd of_phase = circular_convolution(product, phases.col(phase));
        for (int n = 0; n < samples; ++n) covariance.signal(n * step + phase, pair) = of_phase[n];
      }
      covariance.ambient[pair] = product.dot(ambient_e);
      covariance.floor[pair] = product.dot(dark_e) + (i == j ? constant_e2[i] : 0.0);
    }
  return covariance;
}

Eigen::VectorXd unknown_ambient_gain(const ForwardModel& model, const Camera& camera) {
  const double max_e_per_s = brightest_ambient_e_per_s(camera);
  const Eigen::VectorXd light_e = max_e_per_s * model.exposure_s();
  if (ambient_cancels(camera, light_e.cwiseProduct(model.ambient_gain()),
                      model.variance_e2({}, max_e_per_s)))
    return Eigen::VectorXd::Zero(model.measurements());
  return model.ambient_gain();
}

}  // namespace tofsmith
