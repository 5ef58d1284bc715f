// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/switched_code.hpp"

#include <algorithm>

#include "code/shared/on_intervals.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

SwitchedLabels SwitchedLabels::from_cells(const std::vector<int>& cells) {
  SwitchedLabels labels;
  const std::size_t count = cells.size();
  for (std::size_t c = 0; c < count; ++c) {
    if (cells[c] == cells[(c + count - 1) % count]) continue;
    labels.at.push_back(static_cast<double>(c) / static_cast<double>(count));
    labels.label.push_back(cells[c]);
  }
  if (labels.label.empty()) labels.label.push_back(cells.front());
  return labels;
}

double SwitchedLabels::share(int wanted) const {
  if (at.empty()) return label[0] == wanted ? 1.0 : 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < runs(); ++i)
    if (label[i] == wanted) sum += length(i);
  return sum;
}

Waveform SwitchedLabels::waveform(int wanted, double level) const {
  if (at.empty()) return Waveform::constant(label[0] == wanted ? level : 0.0);
  std::vector<OnInterval> on;
  for (std::size_t i = 0; i < runs(); ++i) {
    if (label[i] != wanted) continue;
    const double rise = wrap(at[i], 1.0);
    on.push_back({rise, rise + length(i)});
  }
  if (on.empty()) return Waveform::constant(0.0);
  return Waveform::binary(within_period(std::move(on)), level);
}

Waveform light_waveform(const SwitchedLabels& light) {
  return light.waveform(1, 1.0 / light.share(1));
}

SampledCode sampled_on(const WaveformSpace& space, const SwitchedCode& code) {
  SampledCode result = code.sampled;
  for (std::size_t e = 0; e < code.light.size(); ++e)
    result.modulation.col(static_cast<Eigen::Index>(e)) =
        light_waveform(code.light[e]).cell_averages(space.samples());
  for (std::size_t e = 0; e < code.gates.size(); ++e)
    for (int tap = 0; tap < space.taps; ++tap)
      result.demodulation.col(static_cast<Eigen::Index>(e) * space.taps + tap) =
          code.gates[e].waveform(tap, 1.0).cell_averages(space.samples());
  return result;
}

namespace {

Waveform resampled(const Eigen::VectorXd& values, int samples) {
  return Waveform::sampled(Waveform::sampled(values).cell_averages(samples));
}

}  // namespace

CodeSet code_set(const std::string& name, const WaveformSpace& space, const SwitchedCode& code,
                 int samples) {
  std::vector<Waveform> modulation, demodulation;
  for (int e = 0; e < space.exposures; ++e) {
    modulation.push_back(code.light.empty()
                             ? resampled(code.sampled.modulation.col(e), samples)
                             : light_waveform(code.light[static_cast<std::size_t>(e)]));
    for (int tap = 0; tap < space.taps; ++tap)
      demodulation.push_back(
          code.gates.empty()
              ? resampled(code.sampled.demodulation.col(e * space.taps + tap), samples)
              : code.gates[static_cast<std::size_t>(e)].waveform(tap, 1.0));
  }
  const Eigen::VectorXd& shares = code.sampled.shares;
  return CodeSet::create(name, samples, space.taps, std::move(modulation), std::move(demodulation))
      .with_exposure_shares({shares.begin(), shares.end()});
}

}  // namespace tofsmith
