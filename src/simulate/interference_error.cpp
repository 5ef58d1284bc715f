// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/interference_error.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "camera/shared/actual_code.hpp"
#include "core/shared/periodic.hpp"
#include "simulate/interference_light.hpp"
#include "simulate/pixel_trials.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr int highest_of_light = 255;  // twice this is below the number of phases
constexpr int highest_of_gate = 511;

/// The code with other light in every exposure.
CodeSet with_light(const CodeSet& code, const Waveform& light) {
  if (code.is_rows()) return CodeSet::create_rows(code.name(), light, code.demodulation_samples());
  const CodeSet buckets = code.is_signed() ? code.buckets_of_signed() : code;
  std::vector<Waveform> demodulation;
  for (int i = 0; i < buckets.measurements(); ++i) demodulation.push_back(buckets.demodulation(i));
  const CodeSet lit =
      CodeSet::create(code.name(), code.samples(), buckets.taps(),
                      std::vector<Waveform>(static_cast<std::size_t>(code.exposures()), light),
                      std::move(demodulation))
          .with_exposure_shares(code.exposure_shares());
  return code.is_signed() ? lit.signed_of_buckets() : lit;
}

/// The camera with a light source for any waveform and with lists of one value per exposure,
/// because the number of frequencies is another one. Reversal only changes the sign of beats.
Camera with_any_light(const CodeSet& code, Camera camera) {
  if (!camera.sensor.modulation_contrasts.empty())
    camera.sensor.modulation_contrasts = camera.sensor.contrasts_of(code);
  if (camera.playback && camera.playback->has_list())
    camera.playback->set_offsets_m(camera.playback->offsets_of(code, camera.range_m()));
  if (camera.playback) camera.playback->reversed = false;
  camera.light.generator.reset();
  camera.light.binary = false;
  camera.light.peak_factor = 1e9;
  return camera;
}

/// Harmonics of the tap values for light whose harmonics are all 1, (highest_of_gate + 1, tap
/// values), from the response to a short pulse.
Eigen::MatrixXcd gate_harmonics(const CodeSet& code, const Camera& camera) {
  constexpr int points = 16 * (highest_of_gate + 1);
  const Waveform pulse = rectangular_pulse(1.0 / points);
  const Eigen::VectorXcd of_pulse = pulse.harmonics(highest_of_gate).conjugate();
  const ForwardModel model(with_light(code, pulse), with_any_light(code, camera));
  const PeriodicTransform transform(points);
  const auto harmonics_of = [&](const Eigen::VectorXd& values) {
    Eigen::VectorXcd spectrum(transform.coefficients());
    transform.forward(values, spectrum);
    return Eigen::VectorXcd(
        (spectrum.head(highest_of_gate + 1) / double(points)).cwiseQuotient(of_pulse));
  };
  Eigen::MatrixXcd gates(highest_of_gate + 1, model.tap_values());
  if (model.has_rows()) {
    const Eigen::VectorXcd first = harmonics_of(model.time_bin_table(points));
    for (Eigen::Index bin = 0; bin < gates.cols(); ++bin)
      for (Eigen::Index n = 0; n < gates.rows(); ++n)
        gates(n, bin) = first[n] * std::polar(1.0, -2.0 * std::numbers::pi * double(n * bin) /
                                                       double(gates.cols()));
    return gates;
  }
  const Eigen::MatrixXd table = model.tap_correlation_table(points);
  for (Eigen::Index i = 0; i < gates.cols(); ++i) gates.col(i) = harmonics_of(table.col(i));
  return gates;
}

/// Harmonics of the modulation of another camera in its exposures; one if all are equal.
std::vector<Eigen::VectorXcd> light_harmonics(const CodeSet& own, const Camera& camera,
                                              const OperatingInterference& interference) {
  Camera other = camera;
  other.fundamental_frequency_hz += interference.frequency_offset_hz;
  if (interference.frequency_offset_hz != 0.0) other.light.generator.reset();
  std::optional<CodeSet> family;
  if (interference.code != "same") {
    other.playback.reset();
    if (const auto why = why_no_family(interference.code, other))
      reject("operating.interference.code", interference.code, *why);
    family = build_family(interference.code, other);
  }
  const CodeSet& code = family ? *family : own;
  std::vector<Eigen::VectorXcd> harmonics;
  for (const Waveform& light : actual_code(code, other).modulation)
    harmonics.push_back(light.harmonics(highest_of_light));
  if (std::all_of(harmonics.begin(), harmonics.end(), [&](const Eigen::VectorXcd& one) {
        return one.isApprox(harmonics.front(), 1e-9);
      }))
    harmonics.resize(1);
  return harmonics;
}

double sinc(double x) {
  return x == 0.0 ? 1.0 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
}

/// Returns true if a harmonic of the demodulation changes its phase from part to part.
bool is_spread(Spreading spreading, int harmonic) {
  return (spreading == Spreading::phases && harmonic > 0) ||
         (spreading == Spreading::signs && harmonic % 2 == 1);  // delay by half a period
}

}  // namespace

InterferenceLight::InterferenceLight(const CodeSet& code, const Camera& camera)
    : interference_(camera.operating.interference.value()), exposures_(code.exposures()) {
  const Eigen::MatrixXcd gates = gate_harmonics(code, camera);
  const std::vector<Eigen::VectorXcd> lights = light_harmonics(code, camera, interference_);
  Camera timed = camera;
  timed.exposure_s.each_s = exposure_times_s(code, camera);
  const auto exposures = static_cast<int>(exposures_);
  const Eigen::Index taps = gates.cols(), side = taps / exposures_;
  const double offset_hz = interference_.frequency_offset_hz;
  const double own_hz = camera.fundamental_frequency_hz;
  const double beat_sign = camera.playback && camera.playback->reversed ? -1.0 : 1.0;
  const PeriodicTransform transform(phases);
  for (const Eigen::VectorXcd& light : lights)
    mean_ += light[0].real() / static_cast<double>(lights.size());
  for (std::size_t start = 0; start < lights.size(); ++start) {
    whole_.emplace_back(phases, taps);
    part_.emplace_back(interference_.spreads() ? phases : 0, taps);
    for (int e = 0; e < exposures; ++e) {
      const Eigen::VectorXcd& light = lights[(start + static_cast<std::size_t>(e)) % lights.size()];
      const double exposure_s = timed.exposure_s.each_s[static_cast<std::size_t>(e)];
      const double middle_s =
          timed.exposure_middle_s(0, e, exposures) - timed.frame_middle_s(0, exposures);
      for (Eigen::Index i = e * side; i < (e + 1) * side; ++i) {
        Eigen::VectorXcd whole = Eigen::VectorXcd::Zero(transform.coefficients()), part = whole;
        whole[0] = gates(0, i) * light[0].real();
        for (int m = 1; m <= highest_of_light; ++m) {
          const auto n = static_cast<int>(std::lround(m * ((own_hz + offset_hz) / own_hz)));
          if (n > highest_of_gate) break;
          const double beat_hz = m * offset_hz - (n - m) * own_hz;
          const bool spread = is_spread(interference_.spreading, n);
          const double lasts_s = spread ? exposure_s / interference_.parts : exposure_s;
          (spread ? part : whole)[m] =
              gates(n, i) * std::conj(light[m]) * sinc(beat_hz * lasts_s) *
              std::polar(1.0, -2.0 * std::numbers::pi * beat_sign * beat_hz * middle_s);
        }
        Eigen::VectorXd values;
        transform.inverse(double(phases) * whole, values);
        whole_.back().col(i) = values;
        if (!interference_.spreads()) continue;
        transform.inverse(double(phases) * part, values);
        part_.back().col(i) = values;
      }
    }
  }
}

Eigen::MatrixXd InterferenceLight::second_moment(const Eigen::MatrixXd& measuring) const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(measuring.rows(), measuring.rows());
  const Eigen::Index side = measuring.cols() / exposures_;
  for (int start = 0; start < starts(); ++start) {
    const Eigen::MatrixXd in_all = whole(start) * measuring.transpose();
    sum += in_all.transpose() * in_all;
    if (!interference_.spreads()) continue;
    for (Eigen::Index e = 0; e < exposures_; ++e) {  // independent
      const Eigen::MatrixXd in_one =
          part(start).middleCols(e * side, side) * measuring.middleCols(e * side, side).transpose();
      sum += in_one.transpose() * in_one / interference_.parts;
    }
  }
  return sum / (phases * starts());
}

Eigen::VectorXd InterferenceLight::first_moment(const Eigen::MatrixXd& measuring) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(measuring.cols());
  for (int start = 0; start < starts(); ++start)
    sum += whole(start).colwise().mean().transpose() / starts();
  return measuring * sum;
}

void InterferenceLight::add(double signal_e_per_s, RandomStream& random,
                            std::vector<double>& light) const {
  const auto draw = [&](int count) {
    return std::min(count - 1, static_cast<int>(random.uniform() * count));
  };
  Eigen::Map<Eigen::RowVectorXd> sum(light.data(), static_cast<Eigen::Index>(light.size()));
  const int start = draw(starts()), phase = draw(phases);
  sum += signal_e_per_s * whole(start).row(phase);
  if (!interference_.spreads()) return;
  const Eigen::Index side = sum.size() / exposures_;
  const double of_part_e_per_s = signal_e_per_s / interference_.parts;
  const Table& part_table = part(start);
  for (Eigen::Index e = 0; e < exposures_; ++e) {
    auto of_exposure = sum.segment(e * side, side);
    if (interference_.spreading == Spreading::phases) {
      for (int p = 0; p < interference_.parts; ++p)
        of_exposure += of_part_e_per_s * part_table.row(draw(phases)).segment(e * side, side);
      continue;
    }
    int signs = 0;
    for (int p = 0; p < interference_.parts; ++p) signs += draw(2) == 0 ? 1 : -1;
    of_exposure += signs * of_part_e_per_s * part_table.row(phase).segment(e * side, side);
  }
}

namespace {

/// Variance of a weighted sum of measurements [e^2], by cause.
struct WeightedNoise {
  double by_signal = 0.0, by_ambient = 0.0;  ///< per e/s
  double floor = 0.0;
};

/// WeightedNoise at the middles of equal cells of the range.
class NoiseOfCells {
 public:
  NoiseOfCells(const ForwardModel& model, Eigen::Index cells) : model_(model) {
    const auto points = static_cast<int>(2 * cells);
    if (model.has_rows())
      of_rows_ = row_covariance(model, points);
    else
      tap_signal_ = model.tap_correlation_table(points) * model.tap_exposure_s().asDiagonal();
    ambient_ = model.tap_ambient_gain().cwiseProduct(model.tap_exposure_s());
    dark_ = model.tap_dark_e_per_s() * model.tap_exposure_s();
    constant_ = model.constant_variance_e2();
  }

  WeightedNoise at(Eigen::Index cell, const Eigen::VectorXd& weights) const {
    const Eigen::Index row = 2 * cell + 1;
    if (of_rows_) {
      const auto variance = [&](double signal_e_per_s, double ambient_e_per_s) {
        return weights.dot(of_rows_->at(row, signal_e_per_s, ambient_e_per_s) * weights);
      };
      const double floor = variance(0.0, 0.0);
      return {variance(1.0, 0.0) - floor, variance(0.0, 1.0) - floor, floor};
    }
    const Eigen::VectorXd square = (model_.readout().transpose() * weights).cwiseAbs2();
    return {tap_signal_.row(row).dot(square), ambient_.dot(square),
            dark_.dot(square) + constant_.dot(weights.cwiseAbs2())};
  }

 private:
  const ForwardModel& model_;
  Eigen::MatrixXd tap_signal_;  // (2 cells, tap values); empty for rows
  Eigen::VectorXd ambient_, dark_, constant_;
  std::optional<RowCovariance> of_rows_;
};

/// First-order errors of zncc, root mean squares over the depths.
class ExpectedErrors {
 public:
  /// @param camera  the camera of `model`
  ExpectedErrors(const ForwardModel& model, const Camera& camera, const InterferenceLight& other);

  /// Without noise [m].
  double interference_rms_m() const { return range_m_ * std::sqrt(interference_); }
  /// With noise [m].
  double rmse_m(const OperatingPoint& point) const;

 private:
  const OperatingRange& operating_;
  double range_m_, other_per_signal_;
  double interference_ = 0.0;  // mean square
  WeightedNoise noise_;        // mean
};

ExpectedErrors::ExpectedErrors(const ForwardModel& model, const Camera& camera,
                               const InterferenceLight& other)
    : operating_(camera.operating), range_m_(camera.range_m()) {
  const OperatingInterference& interference = *operating_.interference;
  other_per_signal_ = interference.cameras * interference.signal_ratio * other.mean() *
                      (camera.temperature ? camera.temperature->signal_gain() : 1.0);

  // Cameras are independent: variances add, and so do means.
  const Eigen::MatrixXd measuring = model.readout() * model.tap_exposure_s().asDiagonal();
  const Eigen::VectorXd mean = other.first_moment(measuring);
  const Eigen::MatrixXd of_mean = mean * mean.transpose();
  const double count = interference.cameras;
  const Eigen::MatrixXd moment =
      interference.signal_ratio * interference.signal_ratio *
      (count * (other.second_moment(measuring) - of_mean) + count * count * of_mean);

  const Eigen::Index cells = default_cells_per_bin(model) * model.samples();
  const NoiseOfCells noise(model, cells);
  for_each_depth_cell(model, camera, cells,
                      [&](Eigen::Index cell, double mass, const auto&, const auto& part) {
                        const Eigen::VectorXd weights = part.across / (part.length * part.length);
                        interference_ += mass * std::max(0.0, weights.dot(moment * weights));
                        const WeightedNoise of_cell = noise.at(cell, weights);
                        noise_.by_signal += mass * of_cell.by_signal;
                        noise_.by_ambient += mass * of_cell.by_ambient;
                        noise_.floor += mass * of_cell.floor;
                      });
}

double ExpectedErrors::rmse_m(const OperatingPoint& point) const {
  if (operating_.uniform_albedo) return std::numeric_limits<double>::infinity();
  const double signal_e_per_s = operating_.albedo * point.signal_e_per_s;
  const double ambient_e_per_s = point.ambient_e_per_s + other_per_signal_ * signal_e_per_s;
  const double noise_e2 =
      signal_e_per_s * noise_.by_signal + ambient_e_per_s * noise_.by_ambient + noise_.floor;
  return range_m_ * std::sqrt(interference_ + noise_e2 / (signal_e_per_s * signal_e_per_s));
}

/// Measures pixels with the light of the other cameras.
std::vector<PixelSums> run_trials(const PixelTrials& trials, const Camera& camera,
                                  const InterferenceLight& other, const Progress& progress) {
  const OperatingInterference& interference = *camera.operating.interference;
  const auto taps = static_cast<std::size_t>(trials.pixel().tap_values());
  const auto draw = [&](RandomStream& random, double quantile, const OperatingPoint& point,
                        float* raw) {
    const auto [depth_m, signal_e_per_s] =
        trials.draw_surface(quantile, point.signal_e_per_s, random);
    std::vector<double> work(taps), light(taps, 0.0);
    for (int i = 0; i < interference.cameras; ++i)
      other.add(interference.signal_ratio * signal_e_per_s, random, light);
    // Short pulses have more harmonics than the table, whose sum can be slightly negative.
    if (!camera.sensor.is_signed())
      for (double& value : light) value = std::max(value, 0.0);
    trials.pixel().add_light(depth_m, signal_e_per_s, work, light);
    trials.pixel().expose(point.ambient_e_per_s, random, light, raw);
    return TrueDepths{depth_m, depth_m};
  };
  return trials.run(0, draw, "interference", progress);
}

}  // namespace

InterferenceReport interference_error(const CodeSet& code, const Camera& on,
                                      const EvaluateOptions& options, const Progress& progress) {
  options.validate();
  require(on.operating.interference.has_value(), "operating.interference", "none",
          "must be given: it describes the other cameras");
  const Camera camera = judged_camera(on);
  const PixelTrials trials(code, camera, options);
  // The exposures of the judged camera are longer, because it adds neighbours.
  const InterferenceLight other(code, on);
  const ExpectedErrors expected(trials.model(), camera, other);
  InterferenceReport result;
  result.rms_m = expected.interference_rms_m();
  const std::vector<PixelSums> sums = run_trials(trials, camera, other, progress);
  const std::vector<OperatingPoint> points = camera.operating.points();
  std::vector<WrongShares> shares;
  for (std::size_t p = 0; p < points.size(); ++p) {
    shares.push_back(sums[p].shares());
    result.points.push_back({.point = points[p],
                             .expected_rmse_m = expected.rmse_m(points[p]),
                             .linear_mde_m = sums[p].linear_m.estimate(),
                             .circular_mde_m = sums[p].circular_m.estimate(),
                             .circular_rmse_m = sums[p].circular_rmse_m(),
                             .shares = shares.back()});
  }
  result.linear = mean_over_points(result.points, &InterferencePoint::linear_mde_m);
  result.circular = mean_over_points(result.points, &InterferencePoint::circular_mde_m);
  result.shares = mean_shares(shares);
  return result;
}

}  // namespace tofsmith
