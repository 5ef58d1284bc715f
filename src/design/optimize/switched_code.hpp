// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "design/optimize/waveform_parameters.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// label[i] applies from at[i] to the next switching time, cyclically. Times [periods] are
/// ascending, within one period; without times, label[0] always applies. Adjacent labels differ.
struct SwitchedLabels {
  std::vector<double> at;
  std::vector<int> label;

  static SwitchedLabels from_cells(const std::vector<int>& cells);

  std::size_t runs() const { return at.size(); }
  /// End of run i, in (0, 2).
  double end(std::size_t i) const { return i + 1 < at.size() ? at[i + 1] : at[0] + 1.0; }
  double length(std::size_t i) const { return end(i) - at[i]; }
  double share(int wanted) const;
  Waveform waveform(int wanted, double level) const;
};

struct SwitchedCode {
  std::vector<SwitchedLabels> light;  ///< per exposure, 1 = on; empty: sampled.modulation
  std::vector<SwitchedLabels> gates;  ///< per exposure, charge class; empty: sampled.demodulation
  SampledCode sampled;
};

Waveform light_waveform(const SwitchedLabels& light);

SampledCode sampled_on(const WaveformSpace& space, const SwitchedCode& code);

CodeSet code_set(const std::string& name, const WaveformSpace& space, const SwitchedCode& code,
                 int samples);

}  // namespace tofsmith
