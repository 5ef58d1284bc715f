// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/fields.hpp"

namespace tofsmith {

/// A pair of waveforms that measure one value per pixel.
struct WaveformPair {
  Waveform modulation;
  Waveform demodulation;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<WaveformPair> auto& p) {
  return std::tuple(Field("modulation", p.modulation), Field("demodulation", p.demodulation));
}

/// The correlation function that one measurement should have.
struct CorrelationTarget {
  Eigen::VectorXd samples;         ///< chi at the N bins; linear in between
  double demodulation_mean = 0.5;  ///< mean gain to hold: what ambient light sees
  /// Waveforms that have this correlation function on a camera without limits, if known.
  std::optional<WaveformPair> ideal;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<CorrelationTarget> auto& t) {
  return std::tuple(Field("samples", t.samples), Field("demodulation_mean", t.demodulation_mean),
                    Field("ideal", t.ideal));
}

/// The correlation functions of a whole code.
struct TargetSet {
  std::string name;
  std::vector<CorrelationTarget> measurements;

  int samples() const { return static_cast<int>(measurements.front().samples.size()); }
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<TargetSet> auto& t) {
  return std::tuple(Field("name", t.name), Field("measurements", t.measurements));
}

/// The correlation functions of a one-tap code without impulse responses. Of a family built without
/// a peak limit these are the ideal ones.
TargetSet targets_of(const CodeSet& code);

/// The camera without what keeps it from playing ideal codes: one tap read by itself, full contrast
/// and any peak. A family built for it has the correlation functions that targets_of() is for.
Camera ideal_camera(const Camera& camera);

/// A user's own correlation functions.
/// @param table      (rows, K), values at equal steps of depth over one period, end point left out;
///                   resampled linearly onto `samples` bins
/// @param normalize  rescale every column to minimum 0 and maximum 1
/// @throws std::invalid_argument naming column and row of a value that is not finite
TargetSet targets_from_table(std::string name, const Eigen::MatrixXd& table, int samples,
                             bool normalize);

}  // namespace tofsmith
