// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/frequencies/square_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>

#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

int SquareCode::exposures() const {
  int sum = 0;
  for (const SquareTone& tone : tones) sum += tone.phases;
  return sum;
}

int SquareCode::repetitions() const {
  int common = 0;
  for (const SquareTone& tone : tones) common = std::gcd(common, tone.frequency);
  return common;
}

std::string SquareCode::name() const {
  std::string name = "square";
  for (const SquareTone& tone : tones) name += fmt::format("-{}x{}", tone.frequency, tone.phases);
  return name;
}

std::vector<int> phases_in_steps(int phases, int phase_steps) {
  const double spacing = phases == 2 ? 0.25 : 1.0 / phases;
  std::vector<int> steps;
  for (int i = 0; i < phases; ++i)
    steps.push_back(static_cast<int>(std::lround(i * spacing * phase_steps)));
  return steps;
}

namespace {

constexpr int phases_tabulated = 512;
constexpr int points_per_period = 16;  ///< of the highest frequency
constexpr int highest_odd_harmonic = 9;

/// Power while the light is on, divided by the average power.
double square_level(double duty, double peak_factor) { return std::min(1.0 / duty, peak_factor); }

Waveform square_light(const SquareTone& tone, double duty, double peak_factor) {
  std::vector<OnInterval> on;
  for (int i = 0; i < tone.frequency; ++i)
    on.push_back({static_cast<double>(i) / tone.frequency, (i + duty) / tone.frequency});
  return Waveform::binary(std::move(on), square_level(duty, peak_factor));
}

double harmonic_of_square(int h, double duty) {
  return std::sin(std::numbers::pi * h * duty) / (std::numbers::pi * h);
}

}  // namespace

CodeSet to_code_set(const SquareCode& code, const Camera& camera) {
  const int phase_steps = camera.light.square->phase_steps;
  std::vector<Waveform> modulation, demodulation;
  std::vector<double> shares;
  for (const SquareTone& tone : code.tones) {
    const Waveform light = square_light(tone, code.duty, camera.light.peak_factor);
    for (const int step : phases_in_steps(tone.phases, phase_steps)) {
      modulation.push_back(light);
      demodulation.push_back(
          square_wave(tone.frequency, static_cast<double>(step) / phase_steps / tone.frequency));
      shares.push_back(tone.share / tone.phases);
    }
  }
  const CodeSet one_tap = CodeSet::create(code.name(), camera.samples, 1, std::move(modulation),
                                          std::move(demodulation))
                              .with_exposure_shares(std::move(shares));
  if (camera.sensor.is_signed()) return one_tap.with_signed_weights();
  return camera.sensor.taps == 2 ? one_tap.with_two_buckets() : one_tap;
}

SquareErrorEstimate::SquareErrorEstimate(const Camera& on, double duty, int highest_frequency)
    : range_m_(on.range_m()) {
  const Camera camera = judged_camera(on);
  const Sensor& sensor = camera.sensor;
  const double level = square_level(duty, camera.light.peak_factor);
  const double time_s = camera.exposure_s.total_s;
  // Two taps collect all light, one tap half of it. A mixer reads the difference once.
  const double collected = sensor.mixes_taps() ? 1.0 : 0.5;
  const double readouts = sensor.taps == 2 ? 2.0 : 1.0;
  read_variance_e2_ = readouts * constant_variance_e2_of(sensor);
  const double albedo = camera.operating.uniform_albedo ? 0.5 : camera.operating.albedo;
  for (const OperatingPoint& point : camera.operating.points()) {
    const double signal_e = time_s * albedo * point.signal_e_per_s;
    points_.push_back(
        {signal_e, collected * (signal_e * level * duty + time_s * point.ambient_e_per_s) +
                       readouts * time_s * sensor.dark_current_e_per_s});
  }
  const Eigen::VectorXcd transfer = camera.transfer(highest_odd_harmonic * highest_frequency);
  // Ratio of a measurement to the correlation function of one gate.
  const double gain = sensor.mixes_taps() ? 2.0 * sensor.modulation_contrast : 1.0;
  for (int f = 0; f <= highest_frequency; ++f) {
    Spectrum spectrum{.curvature = 0.0, .distance = Eigen::ArrayXd::Zero(phases_tabulated)};
    for (int h = 1; h <= highest_odd_harmonic; h += 2) {
      const double amplitude = gain * level * std::abs(harmonic_of_square(h, duty)) /
                               (std::numbers::pi * h) * std::abs(transfer[h * f]);
      const double power = 2.0 * amplitude * amplitude;
      spectrum.curvature += power * std::pow(2.0 * std::numbers::pi * h * f, 2);
      for (int i = 0; i < phases_tabulated; ++i)
        spectrum.distance[i] +=
            2.0 * power * (1.0 - std::cos(2.0 * std::numbers::pi * h * i / phases_tabulated));
    }
    spectra_.push_back(std::move(spectrum));
  }
}

std::vector<SquareErrorEstimate::Contribution> SquareErrorEstimate::contributions(
    const SquareCode& code, const Point& point, bool all_of_the_time) const {
  std::vector<Contribution> tones;
  for (const SquareTone& tone : code.tones) {
    const double share = (all_of_the_time ? 1.0 : tone.share) / tone.phases;
    tones.push_back({.spectrum = &spectra_[static_cast<std::size_t>(tone.frequency)],
                     .weight = tone.phases * std::pow(share * point.signal_e, 2),
                     .variance_e2 = share * point.variance_e2 + read_variance_e2_});
  }
  return tones;
}

template <typename ErrorOfPoint>
double SquareErrorEstimate::mean_m(const ErrorOfPoint& error_of_point) const {
  double logarithms = 0.0;
  for (const Point& point : points_) logarithms += std::log(error_of_point(point));
  return std::exp(logarithms / static_cast<double>(points_.size()));
}

double SquareErrorEstimate::local_m(double information) const {
  return range_m_ * std::sqrt(2.0 / std::numbers::pi / information);
}

double SquareErrorEstimate::cap_m(const SquareCode& code) const {
  return 0.25 * range_m_ / code.repetitions();
}

template <typename Distance2>
double SquareErrorEstimate::lobes_m(const SquareCode& code, const std::vector<Contribution>& tones,
                                    const Distance2& distance2) const {
  constexpr double far2 = 120.0;  // beyond it 2 Q(d / 2) is below 1e-7
  const int repetitions = code.repetitions();
  const int periods = code.tones.front().frequency / repetitions;
  const int points = points_per_period * periods;
  double sum = 0.0, worst_of_lobe = 0.0;
  for (int j = points_per_period / 2; j <= points / 2; ++j) {
    double weight = 0.0, white = 0.0, noise = 0.0;
    for (std::size_t i = 0; i < tones.size(); ++i) {
      const int cycles = code.tones[i].frequency / repetitions;
      const auto phase = static_cast<std::int64_t>(cycles) * j % points;
      const double w =
          tones[i].weight * tones[i].spectrum->distance[phase * phases_tabulated / points];
      weight += w;
      white += w / tones[i].variance_e2;
      noise += w * tones[i].variance_e2;
    }
    const double d2 = distance2(weight, white, noise);
    if (d2 < far2)
      worst_of_lobe =
          std::max(worst_of_lobe, static_cast<double>(j) / points * std::erfc(std::sqrt(d2 / 8.0)));
    if (j % points_per_period == points_per_period / 2 - 1 || j == points / 2)
      sum += std::exchange(worst_of_lobe, 0.0);
  }
  return sum * range_m_ / repetitions;
}

double SquareErrorEstimate::error_m(const SquareCode& code) const {
  return mean_m([&](const Point& point) {
    const std::vector<Contribution> tones = contributions(code, point, false);
    double slope = 0.0, noise = 0.0;
    for (const Contribution& tone : tones) {
      slope += tone.weight * tone.spectrum->curvature;
      noise += tone.weight * tone.spectrum->curvature * tone.variance_e2;
    }
    const double lobes = lobes_m(code, tones, [](double weight, double /*white*/, double noise_e4) {
      return noise_e4 > 0.0 ? weight * weight / noise_e4 : 0.0;
    });
    return std::min(local_m(slope * slope / noise) + lobes, cap_m(code));
  });
}

double SquareErrorEstimate::lower_bound_m(const SquareCode& code) const {
  return mean_m([&](const Point& point) {
    const std::vector<Contribution> tones = contributions(code, point, true);
    double information = 0.0;
    for (const Contribution& tone : tones)
      information =
          std::max(information, tone.weight * tone.spectrum->curvature / tone.variance_e2);
    const double lobes = lobes_m(
        code, tones, [](double /*weight*/, double white, double /*noise*/) { return white; });
    return std::min(local_m(information) + lobes, cap_m(code));
  });
}

double SquareErrorEstimate::local_bound_m(const SquareTone& tone, int max_repetitions) const {
  const SquareCode alone{.duty = 0.5, .tones = {tone}};
  return mean_m([&](const Point& point) {
    const Contribution all = contributions(alone, point, true).front();
    return std::min(local_m(all.weight * all.spectrum->curvature / all.variance_e2),
                    0.25 * range_m_ / max_repetitions);
  });
}

}  // namespace tofsmith
