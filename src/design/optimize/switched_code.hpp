// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "design/optimize/waveform_parameters.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// Labels over one period: label[i] applies from at[i] to the next switching time, the last one
/// until the first of the next period. Times are in periods, ascending, within one period. Without
/// times, label[0] applies always. Adjacent labels differ.
struct SwitchedLabels {
  std::vector<double> at;
  std::vector<int> label;

  /// Creates labels from cells of equal length.
  static SwitchedLabels from_cells(const std::vector<int>& cells);

  std::size_t runs() const { return at.size(); }
  /// Returns the end of run i, in (0, 2).
  double end(std::size_t i) const { return i + 1 < at.size() ? at[i + 1] : at[0] + 1.0; }
  double length(std::size_t i) const { return end(i) - at[i]; }
  /// Returns the fraction of the period with this label.
  double share(int wanted) const;
  /// Returns a waveform that is on where the label equals `wanted`.
  Waveform waveform(int wanted, double level) const;
};

/// A feasible code: switching times for binary arms, samples for others.
struct SwitchedCode {
  std::vector<SwitchedLabels> light;  ///< per exposure, 1 = on; empty: sampled.modulation
  std::vector<SwitchedLabels>
      gates;            ///< per exposure, class of the charge; empty: sampled.demodulation
  SampledCode sampled;  ///< of arms that are not binary
};

/// Returns a light waveform with unit mean power.
Waveform light_waveform(const SwitchedLabels& light);

/// Returns the cell averages on the grid.
SampledCode sampled_on(const WaveformSpace& space, const SwitchedCode& code);

CodeSet code_set(const std::string& name, const WaveformSpace& space, const SwitchedCode& code,
                 int samples);

}  // namespace tofsmith
