// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "design/optimize/sampled_camera.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

struct WaveformSpace {
  int cells = 120;  ///< per period, the grid of switching times
  int repeat = 1;   ///< samples per cell
  int exposures = 0;
  int taps = 1;
  /// Charge can be discarded: always for one tap, never for two buckets.
  bool drain = false;
  double peak_factor = 15.0;
  bool equal_duties = false;  ///< both buckets of an exposure at duty 1/2

  int samples() const { return cells * repeat; }
  /// Destinations of charge: taps, then the drain.
  int classes() const { return taps + (drain ? 1 : 0); }
  int columns() const { return classes() == 2 ? 1 : classes(); }

  friend bool operator==(const WaveformSpace&, const WaveformSpace&) = default;
};

/// Large values: nearly binary waveforms.
struct Sharpness {
  double modulation = 1.0;
  double demodulation = 1.0;
};

/// Parameters of waveforms; all values are feasible.
///   modulation    m = p s(k (phi - lambda)), s the logistic function, lambda such that mean m = 1
///   demodulation  two classes: s(k theta); more: softmax(k theta) over the classes
///   shares        shares_of_logits()
struct WaveformParameters {
  Eigen::MatrixXd modulation;    ///< phi (cells, E)
  Eigen::MatrixXd demodulation;  ///< theta (cells, E x columns)
  Eigen::MatrixXd shares = {};   ///< logits (E, 1); empty: the camera's times
};

SampledCode render(const WaveformSpace& space, const WaveformParameters& parameters,
                   const Sharpness& sharpness);

/// Converts a gradient w.r.t. the waveforms of render() to one w.r.t. the parameters.
WaveformParameters pull_back(const WaveformSpace& space, const SampledCode& code,
                             const Sharpness& sharpness, const SampledCode& gradient);

/// +scale where on, -scale where off.
WaveformParameters parameters_near(const WaveformSpace& space, const SampledCode& code,
                                   double scale);

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

/// Returns the first sample of each cell.
Eigen::ArrayXd first_samples(const Eigen::VectorXd& samples, int repeat);
/// Returns the shares of each destination of charge in an exposure (cells, classes).
Eigen::ArrayXXd class_shares(const WaveformSpace& space, const SampledCode& code, int e);

SampledCode sampled_on(const WaveformSpace& space, const SwitchedCode& code);

CodeSet code_set(const std::string& name, const WaveformSpace& space, const SwitchedCode& code,
                 int samples);

}  // namespace tofsmith
