// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chips/standard_chip_codes.hpp"

#include <algorithm>

#include "code/shared/on_intervals.hpp"
#include "design/chips/chip_metric.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

ChipWord repeated_pulse(int begin, int width, int period, int chips) {
  ChipWord word = 0;
  for (int k = 0; k < chips; ++k)
    if (((k - begin) % period + period) % period < width) word |= ChipWord{1} << k;
  return word;
}

struct MultiPhase {
  ChipWord light = 0;
  std::vector<ChipWord> taps;
};

std::vector<MultiPhase> multi_phase_exposures(int chips, int taps) {
  std::vector<MultiPhase> all;
  for (int period = taps; period <= chips; ++period) {
    if (chips % period != 0) continue;
    const int open = period / taps;
    std::vector<ChipWord> words;
    for (int i = 0; i < taps; ++i)
      words.push_back(repeated_pulse(i * period / taps, open, period, chips));
    std::vector<int> widths = {open, period / 2, (period + 1) / 2};
    std::sort(widths.begin(), widths.end());
    widths.erase(std::unique(widths.begin(), widths.end()), widths.end());
    for (const int width : widths)
      if (width < period) all.push_back({repeated_pulse(0, width, period, chips), words});
  }
  return all;
}

void add_combinations(const std::vector<MultiPhase>& exposures, std::size_t from, int left,
                      ChipCode& code, std::vector<ChipCode>& all) {
  if (left == 0) {
    if (!is_ambiguous(code)) all.push_back(code);
    return;
  }
  for (std::size_t i = from; i < exposures.size(); ++i) {
    const ChipCode before = code;
    code.modulation.push_back(exposures[i].light);
    code.demodulation.insert(code.demodulation.end(), exposures[i].taps.begin(),
                             exposures[i].taps.end());
    add_combinations(exposures, i, left - 1, code, all);
    code = before;
  }
}

Waveform pulse_of(double duty) { return Waveform::binary({{0.0, duty}}, 1.0); }

Waveform gate(double rise, double duty) { return Waveform::binary({{rise, rise + duty}}); }

CodeSet hamiltonian_in_turn(int samples) {
  const Waveform light = pulse_of(1.0 / 6);
  return CodeSet::create("hamiltonian-k3-in-turn", samples, 1, {light, light, light},
                         {gate(0, 0.5), gate(1.0 / 3, 0.5), gate(2.0 / 3, 0.5)});
}

CodeSet double_ramp_in_turn(int samples) {
  const CodeSet ramps = double_ramp_code({.samples = samples});
  const Waveform light = pulse_of(1.0 / 60);
  return CodeSet::create("double-ramp-in-turn", samples, 1, {light, light, Waveform::constant(0.0)},
                         {ramps.demodulation(0), ramps.demodulation(1), ramps.demodulation(2)});
}

}  // namespace

std::vector<ChipCode> multi_phase_codes(int chips, int taps, int exposures) {
  std::vector<ChipCode> all;
  ChipCode code{chips, taps, {}, {}};
  add_combinations(multi_phase_exposures(chips, taps), 0, exposures, code, all);
  return all;
}

std::vector<StandardCode> standard_chip_codes(const Camera& camera, int samples) {
  require(samples > 0 && samples % 36 == 0, "samples", samples, "must be a multiple of 36");
  Camera three_taps = camera;
  three_taps.samples = samples;
  three_taps.sensor.taps = 3;
  const ChipCode square{
      3, 3, {chip_word("100")}, {chip_word("100"), chip_word("010"), chip_word("001")}};
  ChipCode pair{12, 3, {}, {}};
  for (const int period : {3, 4}) {
    pair.modulation.push_back(repeated_pulse(0, (period + 1) / 2, period, 12));
    for (int i = 0; i < 3; ++i) pair.demodulation.push_back(repeated_pulse(i, 1, period, 12));
  }
  pair.modulation.front() = repeated_pulse(0, 1, 3, 12);
  return {{"hamiltonian-k3-in-turn", hamiltonian_in_turn(samples)},
          {"three-phase-square", to_code_set(square, three_taps, "three-phase-square")},
          {"double-ramp-in-turn", double_ramp_in_turn(samples)},
          {"coprime-three-phase", to_code_set(pair, three_taps, "coprime-three-phase")}};
}

}  // namespace tofsmith
