// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/factorize/start_pool.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "code/shared/on_intervals.hpp"
#include "core/shared/random.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

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
