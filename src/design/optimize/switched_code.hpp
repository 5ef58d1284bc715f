// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "design/optimize/waveform_parameters.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// What is on when, in one period: label[i] from at[i] to the next switching time, the last to the
/// first of the next period. Times in periods, increasing, all within one period; none: label[0] at
/// all times. Neighbouring labels differ.
struct SwitchedLabels {
  std::vector<double> at;
  std::vector<int> label;

  /// Label per cell of equal length.
  static SwitchedLabels from_cells(const std::vector<int>& cells);

  std::size_t runs() const { return at.size(); }
  /// Begin of the run after run i; a period later for the last.
  double end(std::size_t i) const { return i + 1 < at.size() ? at[i + 1] : at[0] + 1.0; }
  double length(std::size_t i) const { return end(i) - at[i]; }
  /// Share of the period with that label.
  double share(int wanted) const;
  /// On where the label is that.
  Waveform waveform(int wanted, double level) const;
};

/// A code that can be played: arms that only switch by their switching times, others by samples.
struct SwitchedCode {
  std::vector<SwitchedLabels> light;  ///< per exposure, 1 = on; empty: sampled.modulation
  std::vector<SwitchedLabels>
      gates;            ///< per exposure, class of charge; empty: sampled.demodulation
  SampledCode sampled;  ///< of arms that may play any value
};

/// Unit mean power where the light is on.
Waveform light_waveform(const SwitchedLabels& light);

/// Its cell averages on the grid.
SampledCode sampled_on(const WaveformSpace& space, const SwitchedCode& code);

CodeSet code_set(const std::string& name, const WaveformSpace& space, const SwitchedCode& code,
                 int samples);

}  // namespace tofsmith
