// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/factorize/alternation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "camera/shared/actual_code.hpp"
#include "code/shared/on_intervals.hpp"
#include "core/shared/random.hpp"
#include "design/circulant_tv/least_squares_term.hpp"
#include "design/grid_transfer.hpp"
#include "design/run_lengths.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

PairModel::PairModel(const CorrelationTarget& target, const Camera& camera)
    : target_(target),
      camera_(camera),
      shortest_run_(shortest_run_periods(camera)),
      transform_(static_cast<int>(target.samples.size())),
      reversed_target_(target.samples.size()) {
  const Eigen::Index size = target.samples.size();
  for (Eigen::Index n = 0; n < size; ++n) reversed_target_[n] = target.samples[(size - n) % size];
  target_spectrum_ = spectrum(target.samples);
  grid_transfer_ = grid_transfer(camera, samples()) / static_cast<double>(samples());
}

Eigen::VectorXcd PairModel::spectrum(const Eigen::VectorXd& samples) const {
  Eigen::VectorXcd result;
  transform_.forward(samples, result);
  return result;
}

Eigen::VectorXd PairModel::demodulation_kernel(const Eigen::VectorXd& modulation) const {
  Eigen::VectorXd kernel;
  transform_.inverse(spectrum(modulation).conjugate().cwiseProduct(grid_transfer_), kernel);
  return kernel;
}

Eigen::VectorXd PairModel::modulation_kernel(const Eigen::VectorXd& demodulation) const {
  Eigen::VectorXd kernel;
  transform_.inverse(spectrum(demodulation).cwiseProduct(grid_transfer_).conjugate(), kernel);
  return kernel;
}

double PairModel::residual_rms(const Eigen::VectorXcd& modulation,
                               const Eigen::VectorXcd& demodulation) const {
  const Eigen::VectorXd energy =
      (demodulation.cwiseProduct(modulation.conjugate()).cwiseProduct(grid_transfer_) -
       target_spectrum_)
          .cwiseAbs2();
  // Parseval: coefficients other than k = 0 (and N/2) count twice.
  double sum = 2.0 * energy.sum() - energy[0];
  if (samples() % 2 == 0) sum -= energy[energy.size() - 1];
  return std::sqrt(sum) / samples();
}

double PairModel::residual_rms(const Eigen::VectorXd& modulation,
                               const Eigen::VectorXd& demodulation) const {
  return residual_rms(spectrum(modulation), spectrum(demodulation));
}

WaveformPair PairModel::actual(const WaveformPair& pair) const {
  const double f0_hz = camera_.fundamental_frequency_hz;
  WaveformPair generated_pair = pair;
  if (const auto& generator = camera_.light.generator)
    generated_pair.modulation = at_average_power(generated(pair.modulation, *generator, f0_hz));
  if (const auto& generator = camera_.sensor.generator)
    generated_pair.demodulation = generated(pair.demodulation, *generator, f0_hz);
  return generated_pair;
}

double PairModel::residual_rms(const WaveformPair& nominal) const {
  const WaveformPair pair = actual(nominal);
  if (pair.modulation.mean() <= 0.0) return infinity;
  const CorrelationFunction function =
      camera_.band_limited()
          ? CorrelationFunction(pair.demodulation, pair.modulation, camera_.transfer(4 * samples()))
          : CorrelationFunction(pair.demodulation, pair.modulation);
  constexpr int points_per_bin = 8;
  const Eigen::VectorXd values = function.table(points_per_bin * samples());
  double sum = 0.0;
  for (Eigen::Index j = 0; j < values.size(); ++j) {
    const Eigen::Index bin = j / points_per_bin;
    const double share = static_cast<double>(j % points_per_bin) / points_per_bin;
    const double target = (1.0 - share) * target_.samples[bin] +
                          share * target_.samples[(bin + 1) % target_.samples.size()];
    sum += (values[j] - target) * (values[j] - target);
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

namespace {

struct BinaryProjection {
  SampledPair pair;
  double residual_rms;
};

Eigen::VectorXd binary_demodulation(const Eigen::VectorXd& x, double threshold) {
  return (x.array() > threshold).cast<double>();
}

/// On where x > threshold * max(x), with unit mean power, or at the peak if lower.
Eigen::VectorXd binary_modulation(const Eigen::VectorXd& x, double threshold, double peak_factor) {
  Eigen::VectorXd on = (x.array() > threshold * x.maxCoeff()).cast<double>();
  const double duty = on.mean();
  if (duty > 0.0) on *= std::min(peak_factor, 1.0 / duty);
  return on;
}

/// Thresholds each binary arm at the best of 19 levels with the other arm fixed, twice.
BinaryProjection project_to_binary(const PairModel& model, const SampledPair& relaxed) {
  constexpr int levels = 20;
  BinaryProjection best{relaxed, 0.0};
  if (model.binary_demodulation())
    best.pair.demodulation = binary_demodulation(relaxed.demodulation, 0.5);
  if (model.binary_modulation())
    best.pair.modulation = binary_modulation(relaxed.modulation, 0.5, model.peak_factor());
  Eigen::VectorXcd modulation = model.spectrum(best.pair.modulation);
  Eigen::VectorXcd demodulation = model.spectrum(best.pair.demodulation);
  best.residual_rms = model.residual_rms(modulation, demodulation);

  const auto keep_better = [&](Eigen::VectorXd trial, Eigen::VectorXd& kept,
                               Eigen::VectorXcd& spectrum) {
    Eigen::VectorXcd other = model.spectrum(trial);
    std::swap(spectrum, other);
    const double residual = model.residual_rms(modulation, demodulation);
    if (residual >= best.residual_rms) return std::swap(spectrum, other);
    best.residual_rms = residual;
    kept = std::move(trial);
  };
  for (int round = 0; round < 2; ++round) {
    for (int level = 1; level < levels && model.binary_demodulation(); ++level)
      keep_better(binary_demodulation(relaxed.demodulation, static_cast<double>(level) / levels),
                  best.pair.demodulation, demodulation);
    for (int level = 1; level < levels && model.binary_modulation(); ++level)
      keep_better(binary_modulation(relaxed.modulation, static_cast<double>(level) / levels,
                                    model.peak_factor()),
                  best.pair.modulation, modulation);
  }
  return best;
}

constexpr double smallest_rms = 1e-4;  // keeps the majorizer's weight positive

Eigen::VectorXd fit(CirculantTvSolver& solver, const CirculantTvProblem& problem,
                    const Eigen::VectorXd& current) {
  if (problem.total_variation_weight == 0.0) return least_squares_within_bounds(problem, current);
  const CirculantTvResult result = solver.solve(problem);
  if (result.is_usable()) return result.x;
  const CirculantTvResult careful = solve_circulant_tv(problem);
  return careful.is_usable() ? careful.x : current;
}

}  // namespace

AlternationResult alternate(const PairModel& model, SampledPair start,
                            double total_variation_weight, const FactorizeOptions& options,
                            CirculantTvSolver& solver) {
  const double samples = model.samples();
  SampledPair x = std::move(start);
  AlternationResult result{x, x, infinity, {}};
  double rms = model.residual_rms(x.modulation, x.demodulation);
  double last_objective = infinity;
  int without_gain = 0;

  for (int iteration = 1; iteration <= options.max_iterations; ++iteration) {
    x.demodulation = fit(
        solver,
        {.kernel = model.demodulation_kernel(x.modulation),
         .target = model.target_samples(),
         .total_variation_weight = total_variation_weight * samples * std::max(rms, smallest_rms),
         .upper_bound = 1.0},
        x.demodulation);
    rms = model.residual_rms(x.modulation, x.demodulation);
    x.modulation = fit(solver,
                       {.kernel = model.modulation_kernel(x.demodulation),
                        .target = model.reversed_target_samples(),
                        .total_variation_weight = total_variation_weight / model.peak_factor() *
                                                  samples * std::max(rms, smallest_rms),
                        .upper_bound = model.peak_factor(),
                        .budget = samples},
                       x.modulation);
    rms = model.residual_rms(x.modulation, x.demodulation);
    const double objective =
        rms +
        total_variation_weight * (circular_total_variation(x.demodulation) +
                                  circular_total_variation(x.modulation) / model.peak_factor());

    const BinaryProjection projection = project_to_binary(model, x);
    result.history.push_back({objective, rms, projection.residual_rms});
    ++without_gain;
    if (projection.residual_rms < result.playable_residual_rms - 1e-12) {
      result.playable = projection.pair;
      result.playable_residual_rms = projection.residual_rms;
      without_gain = 0;
    }
    result.relaxed = x;
    if (options.feed_back_projection) {
      x = projection.pair;
      rms = projection.residual_rms;
      if (without_gain >= 3) break;
    } else if (std::abs(last_objective - objective) <
               options.objective_tolerance * std::max(objective, 1e-12)) {
      break;
    }
    if (result.playable_residual_rms < 1e-9) break;
    last_objective = objective;
  }
  return result;
}

namespace {

/// Equal pulses centred at zero; `spacing` and total duty in periods.
Waveform centred_pulses(int count, double spacing, double duty) {
  std::vector<OnInterval> on;
  for (int i = 0; i < count; ++i) {
    const double centre = (i - 0.5 * (count - 1)) * spacing;
    const double rise = wrap(centre - 0.5 * duty / count, 1.0);
    on.push_back({rise, rise + duty / count});
  }
  return Waveform::binary(within_period(std::move(on)), 1.0 / duty);
}

PairCandidate candidate(const PairModel& model, WaveformPair pair, std::string name) {
  const double residual = model.residual_rms(pair);
  return {std::move(pair), residual, std::move(name), 0};
}

}  // namespace

AlternationStart random_start(const PairModel& model, std::uint64_t seed, int index) {
  RandomStream random(seed, combine_keys(static_cast<std::uint64_t>(model.samples()), 0x57a7),
                      static_cast<std::uint32_t>(index));
  SampledPair pair{Eigen::VectorXd(model.samples()), Eigen::VectorXd(model.samples())};
  for (double& value : pair.modulation) value = random.uniform();
  for (double& value : pair.demodulation) value = random.uniform();
  pair.modulation /= pair.modulation.mean();
  pair.modulation = pair.modulation.cwiseMin(model.peak_factor());
  return {fmt::format("random {}", index), std::move(pair)};
}

std::vector<PairCandidate> structured_starts(const PairModel& model) {
  const Eigen::VectorXd& chi = model.target_samples();
  const double middle = 0.5 * (chi.minCoeff() + chi.maxCoeff());
  const Waveform d = Waveform::binary_from_samples(
      (chi.array() - chi.minCoeff()).matrix(), 1.0,
      (middle - chi.minCoeff()) / std::max(1e-300, chi.maxCoeff() - chi.minCoeff()));
  const int pulses = static_cast<int>(d.on_intervals().size());
  const double shortest = 1.0 / model.peak_factor();
  std::vector<double> duties{shortest, std::max(0.5, shortest)};
  if (const auto& ideal = model.target().ideal)
    duties.push_back(std::max(shortest, ideal->modulation.duty()));
  std::sort(duties.begin(), duties.end());
  duties.erase(std::unique(duties.begin(), duties.end()), duties.end());

  std::vector<PairCandidate> starts;
  for (const double duty : duties)
    for (int count = 1; count <= pulses + 1; ++count)
      for (const int per_period : {pulses, pulses + 1}) {
        if (count > per_period || duty * per_period / count > 0.95) continue;
        if (count == 1 && per_period > 1 && per_period != pulses) continue;  // same pulse
        const Waveform m = centred_pulses(count, 1.0 / per_period, duty);
        starts.push_back(
            candidate(model, {m, d},
                      fmt::format("{} pulses 1/{} apart, duty {:.3g}", count, per_period, duty)));
      }
  return starts;
}

std::vector<PairCandidate> naive_start(const PairModel& model) {
  const auto& ideal = model.target().ideal;
  if (!ideal) return {};
  if (model.binary_demodulation() && !ideal->demodulation.is_binary()) return {};
  const bool playable = ideal->modulation.is_binary() || !model.binary_modulation();
  if (playable && ideal->modulation.peak() <= model.peak_factor())
    return {candidate(model, *ideal, "naive")};
  const double duty = std::max(1.0 / model.peak_factor(), ideal->modulation.duty());
  return {candidate(model, {rectangular_pulse(duty), ideal->demodulation}, "naive")};
}

}  // namespace tofsmith
