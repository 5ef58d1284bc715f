// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/robustness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "code/shared/on_intervals.hpp"
#include "simulate/pixel_trials.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

namespace {

ImpulseResponse with_bandwidth(ImpulseResponse response, double factor) {
  response.f_max_hz *= factor;
  response.cutoff_hz *= factor;
  response.time_step_s /= factor;
  return response;
}

bool has_response(const Camera& camera) {
  return camera.light.impulse_response.kind != ImpulseResponse::Kind::none ||
         camera.sensor.impulse_response.kind != ImpulseResponse::Kind::none;
}

PerturbedCamera with_bandwidth(const Camera& camera, double change) {
  PerturbedCamera perturbed{fmt::format("bandwidth {:+.3g} %", 100 * change), camera};
  for (ImpulseResponse* response :
       {&perturbed.camera.light.impulse_response, &perturbed.camera.sensor.impulse_response})
    *response = with_bandwidth(*response, 1.0 + change);
  return perturbed;
}

PerturbedCamera with_peak(const Camera& camera, double change) {
  PerturbedCamera perturbed{fmt::format("peak power {:+.3g} %", 100 * change), camera,
                            1.0 + change};
  double& peak_factor = perturbed.camera.light.peak_factor;
  peak_factor = std::max(1.0, peak_factor * perturbed.peak);
  return perturbed;
}

PerturbedCamera with_jitter(const Camera& camera, double edge_jitter_s) {
  PerturbedCamera perturbed{fmt::format("edge jitter {:.3g} ps", 1e12 * edge_jitter_s), camera};
  for (double* jitter_s :
       {&perturbed.camera.light.edge_jitter_s, &perturbed.camera.sensor.edge_jitter_s})
    *jitter_s = std::hypot(*jitter_s, edge_jitter_s);
  return perturbed;
}

PerturbedCamera with_mismatch(const Camera& camera, double mismatch) {
  PerturbedCamera perturbed{fmt::format("tap mismatch {:.3g} %", 100 * mismatch), camera};
  perturbed.camera.sensor.tap_mismatch += mismatch;
  return perturbed;
}

PerturbedCamera with_clock(const Camera& camera, double clock_s) {
  const Generator clock{.sample_rate_hz = 1.0 / clock_s};
  clock.validate("clock", camera.fundamental_frequency_hz);
  const int points = clock.points_per_period(camera.fundamental_frequency_hz);
  PerturbedCamera perturbed{
      fmt::format("clock {:.3g} ns", 1e9 / (points * camera.fundamental_frequency_hz)), camera};
  perturbed.clock_s = clock_s;
  return perturbed;
}

PerturbedCamera with_droop(const Camera& camera, double droop) {
  PerturbedCamera perturbed{fmt::format("droop {:.3g} %", 100 * droop), camera};
  perturbed.droop = droop;
  return perturbed;
}

/// Rows do not differ in sensitivity.
bool has_taps(const Camera& camera) { return camera.sensor.readout != Readout::rows; }

PerturbedCamera with_everything(const Camera& camera, const RobustnessOptions& options) {
  PerturbedCamera perturbed{"all together", camera};
  if (options.bandwidth > 0.0)
    perturbed.camera = with_bandwidth(perturbed.camera, -options.bandwidth).camera;
  if (options.peak > 0.0) {
    const PerturbedCamera dim = with_peak(perturbed.camera, -options.peak);
    perturbed.camera = dim.camera;
    perturbed.peak = dim.peak;
  }
  perturbed.camera = with_jitter(perturbed.camera, options.edge_jitter_s).camera;
  if (has_taps(camera) && camera.sensor.tap_mismatch + options.tap_mismatch < 1.0)
    perturbed.camera.sensor.tap_mismatch += options.tap_mismatch;
  perturbed.clock_s = options.clock_s;
  perturbed.droop = options.droop;
  return perturbed;
}

/// A sum of cosines is also sampled, because clipping turns it into another waveform.
Eigen::VectorXd sampled_values(const Waveform& waveform) {
  if (waveform.is_sampled()) return waveform.samples();
  return waveform.cell_averages(static_cast<int>(waveform.steps().values.size()));
}

/// Scales deviations from the mean so that the peak changes by `factor`.
Waveform with_depth_of_modulation(const Waveform& modulation, double factor) {
  const double mean = modulation.mean(), peak = modulation.peak();
  if (mean <= 0.0 || peak <= mean) return modulation;
  const double depth = (factor * peak - mean) / (peak - mean);
  if (depth <= 0.0) return modulation.scaled(0.0, factor);
  if (!modulation.is_sampled() && depth <= 1.0)
    return modulation.scaled(mean - depth * mean, depth);
  const Eigen::VectorXd samples =
      (mean + depth * (sampled_values(modulation).array() - mean)).cwiseMax(0.0);
  return Waveform::sampled(samples * (mean / samples.mean()));
}

Waveform with_peak(const Waveform& modulation, double peak) {
  if (peak == 1.0) return modulation;
  if (!modulation.is_binary()) return with_depth_of_modulation(modulation, peak);
  if (modulation.on_intervals().empty()) return modulation;
  return Waveform::binary(stretched(modulation.on_intervals(), 1.0 / peak),
                          modulation.level() * peak);
}

/// Rounds switching times; preserves the average power of light.
Waveform on_clock(const Waveform& waveform, double clock_s, const Camera& camera) {
  if (clock_s == 0.0) return waveform;
  return generated(waveform, {.sample_rate_hz = 1.0 / clock_s, .amplitude_bits = 24},
                   camera.fundamental_frequency_hz);
}

Waveform within_power(const Waveform& modulation) {
  const double mean = modulation.mean();
  if (mean <= 1.0 + 1e-9) return modulation;  // same tolerance as the check of codes
  return modulation.is_binary() && !modulation.on_intervals().empty()
             ? Waveform::binary(modulation.on_intervals(), modulation.level() / mean)
         : modulation.is_binary() ? Waveform::constant(1.0)
                                  : modulation.scaled(0.0, 1.0 / mean);
}

Waveform on_samples(const Waveform& waveform, int samples) {
  if (!waveform.is_sampled() || waveform.samples().size() == samples) return waveform;
  return Waveform::sampled(waveform.cell_averages(samples));
}

/// Decays as exp(-t / s) from every rise; means over `samples` cells.
Waveform with_droop(const Waveform& modulation, double droop, int samples) {
  if (droop == 0.0 || !modulation.is_binary() || modulation.on_intervals().empty())
    return modulation;
  const double rate = -std::log1p(-droop) / 0.5;  // per period
  Eigen::VectorXd cells = Eigen::VectorXd::Zero(samples);
  for (const OnInterval& pulse : modulation.on_intervals()) {
    const auto first = static_cast<int>(std::floor(pulse.rise * samples));
    for (int n = first; n < pulse.fall * samples; ++n) {
      const double begin = std::max(pulse.rise, static_cast<double>(n) / samples) - pulse.rise;
      const double end = std::min(pulse.fall, static_cast<double>(n + 1) / samples) - pulse.rise;
      if (end <= begin) continue;
      cells[n % samples] +=
          modulation.level() * samples / rate * (std::exp(-rate * begin) - std::exp(-rate * end));
    }
  }
  return Waveform::sampled(std::move(cells));
}

}  // namespace

std::vector<PerturbedCamera> perturbations(const Camera& camera, const RobustnessOptions& options) {
  camera.validate();
  options.validate();
  std::vector<PerturbedCamera> cameras;
  if (options.bandwidth > 0.0 && has_response(camera))
    for (const double change : {-options.bandwidth, options.bandwidth})
      cameras.push_back(with_bandwidth(camera, change));
  if (options.peak > 0.0)
    for (const double change : {-options.peak, options.peak})
      cameras.push_back(with_peak(camera, change));
  if (options.edge_jitter_s > 0.0) cameras.push_back(with_jitter(camera, options.edge_jitter_s));
  if (options.tap_mismatch > 0.0 && has_taps(camera) &&
      camera.sensor.tap_mismatch + options.tap_mismatch < 1.0)
    cameras.push_back(with_mismatch(camera, options.tap_mismatch));
  if (options.clock_s > 0.0) cameras.push_back(with_clock(camera, options.clock_s));
  if (options.droop > 0.0) cameras.push_back(with_droop(camera, options.droop));
  if (options.together) cameras.push_back(with_everything(camera, options));
  return cameras;
}

CodeSet perturbed_code(const CodeSet& code, const PerturbedCamera& perturbed) {
  if (perturbed.peak == 1.0 && perturbed.clock_s == 0.0 && perturbed.droop == 0.0) return code;
  const Camera& camera = perturbed.camera;
  std::vector<Waveform> modulation, demodulation;
  for (int e = 0; e < code.exposures(); ++e) {
    Waveform m = with_peak(code.modulation(e), perturbed.peak);
    m = within_power(on_clock(m, perturbed.clock_s, camera));
    require(perturbed.clock_s == 0.0 || m.mean() > 0.0, "clock_s", perturbed.clock_s,
            fmt::format("must be short enough to leave modulation {} a pulse", e));
    modulation.push_back(
        on_samples(with_droop(m, perturbed.droop, code.samples()), code.samples()));
  }
  if (code.is_rows())  // sums of counts do not depend on the light's clock
    return CodeSet::create_rows(code.name(), std::move(modulation.front()),
                                code.demodulation_samples());
  for (int i = 0; i < code.measurements(); ++i)
    demodulation.push_back(
        on_samples(on_clock(code.demodulation(i), perturbed.clock_s, camera), code.samples()));
  CodeSet changed = CodeSet::create(code.name(), code.samples(), code.taps(), std::move(modulation),
                                    std::move(demodulation))
                        .with_exposure_shares(code.exposure_shares());
  return code.is_signed() ? changed.with_signed_weights() : changed;
}

namespace {

std::vector<double> correlation_changes(const ForwardModel& nominal, const ForwardModel& actual,
                                        int points) {
  const Eigen::MatrixXd a = nominal.correlation_table(points), b = actual.correlation_table(points);
  std::vector<double> changes;
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    const double variation = (a.col(k).array() - a.col(k).mean()).matrix().norm();
    const double change = (b.col(k) - a.col(k)).norm();
    changes.push_back(variation > 0.0 ? change / variation : change);
  }
  return changes;
}

const Estimate& larger(const Estimate& a, const Estimate& b) { return b.value > a.value ? b : a; }

}  // namespace

double GeneratorLoss::ratio(DepthErrorKind kind) const {
  return actual.of(kind).geometric_mean_m.value / nominal_m(kind).value;
}

double GeneratorLoss::uncalibrated_ratio(DepthErrorKind kind) const {
  return uncalibrated.of(kind).geometric_mean_m.value / nominal_m(kind).value;
}

GeneratorLoss generator_loss(const CodeSet& code, const Camera& on, const EvaluateOptions& options,
                             const Progress& progress) {
  const Camera camera = judged_camera(on);
  options.validate();
  Camera ideal = camera;
  ideal.light.generator.reset();
  ideal.sensor.generator.reset();
  const ForwardModel nominal(code, ideal), actual(code, camera);
  const DecodingTable nominal_table = make_decoding_table(nominal, ideal),
                      actual_table = make_decoding_table(actual, camera);
  const ProgressParts parts(progress, 3);
  const auto error = [&](const ForwardModel& model, const DecodingTable& believed,
                         std::size_t part) {
    const DepthTrials trials(model, camera, options, believed);
    return trial_errors(trials, code, camera, options, parts[part]);
  };
  return {.nominal = error(nominal, nominal_table, 0),
          .actual = error(actual, actual_table, 1),
          .uncalibrated = error(actual, nominal_table, 2),
          .correlation_change = correlation_changes(nominal, actual, 8 * camera.samples)};
}

void RobustnessOptions::validate() const { check_fields(*this); }

Estimate RobustnessReport::worst_calibrated_m() const {
  Estimate worst = nominal_m;
  for (const PerturbedError& p : perturbed) worst = larger(worst, p.calibrated_m);
  return worst;
}

Estimate RobustnessReport::worst_uncalibrated_m() const {
  Estimate worst = nominal_m;
  for (const PerturbedError& p : perturbed) worst = larger(worst, p.uncalibrated_m);
  return worst;
}

RobustnessReport robustness(const CodeSet& code, const Camera& on, const RobustnessOptions& options,
                            const Progress& progress) {
  const Camera camera = judged_camera(on);
  const std::vector<PerturbedCamera> cameras = perturbations(camera, options);
  const DepthErrorKind kind = camera.operating.error;
  const EvaluateOptions trials_options{.trials = options.trials,
                                       .seed = options.seed,
                                       .method = options.method,
                                       .unwrap_weights = options.unwrap_weights};
  const auto error_m = [&](const CodeSet& actual_code, const Camera& actual,
                           const ForwardModel& model, const DecodingTable& believed,
                           const Progress& part) {
    const DepthTrials trials(model, actual, trials_options, believed);
    return trial_errors(trials, actual_code, actual, trials_options, part)
        .of(kind)
        .geometric_mean_m;
  };
  const ProgressParts parts(progress, 2 * cameras.size() + 1);

  const ForwardModel said(code, camera);
  const DecodingTable said_table = make_decoding_table(said, camera);
  RobustnessReport report{.kind = kind,
                          .trials = options.trials + options.trials % 2,
                          .seed = options.seed,
                          .nominal_m = error_m(code, camera, said, said_table, parts[0])};
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Camera& actual = cameras[i].camera;
    const CodeSet actual_code = perturbed_code(code, cameras[i]);
    if (why_not_playable(actual_code, actual)) continue;
    const ForwardModel model(actual_code, actual);
    const DecodingTable table = make_decoding_table(model, actual);
    const DecodingTable& calibrated = why_not_decodable(table) ? said_table : table;
    report.perturbed.push_back(
        {.name = cameras[i].name,
         .calibrated_m = error_m(actual_code, actual, model, calibrated, parts[2 * i + 1]),
         .uncalibrated_m = error_m(actual_code, actual, model, said_table, parts[2 * i + 2])});
  }
  return report;
}

}  // namespace tofsmith
