// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "paper/reproduction.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/design/factorize.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

/// The correlation function of a pair on a camera, at `points` equal steps of depth.
Eigen::VectorXd correlation_table(const WaveformPair& pair, const Camera& camera, int points);

/// rms over depth between the pair's correlation function on `camera` and the target.
double residual_rms(const WaveformPair& pair, const CorrelationTarget& target,
                    const Camera& camera);

/// The same pair, both waveforms moved in time so that the middle of the longest pulse comes at
/// half the period: drawings of different pairs can be compared. Sampled pairs stay.
WaveformPair centred(const WaveformPair& pair);

/// One row: nominal input and output of the arms, and the correlation function over the
/// target, which is grey and dotted.
PanelRow pair_row(std::string title, const WaveformPair& pair, const Camera& camera,
                  const Eigen::VectorXd& target, const LineStyle& style);

/// Correlation function and target as curves over depth.
std::vector<Series> correlation_series(const Eigen::VectorXd& correlation,
                                       const Eigen::VectorXd& target, double range_m,
                                       const LineStyle& style);

/// Waveforms and correlation functions of several pairs, collected for an NPZ file.
class PairArrays {
 public:
  /// Adds a row.
  void add(const WaveformPair& pair, const Camera& camera, const Eigen::VectorXd& target);
  /// Stores PREFIX_modulation, _demodulation (rows, N; averages over cells, nominal),
  /// _modulation_output, _demodulation_output (output of the arms), _correlation and _target.
  void store(Reproduction& result, const std::string& prefix) const;

 private:
  std::map<std::string, std::vector<Eigen::VectorXd>> rows_;
};

/// A residual for reading: "0" where it is rounding.
std::string rms_text(double residual_rms);

/// The ideal correlation functions of a family without limits, on the camera's samples.
TargetSet ideal_targets(std::string_view family, const Camera& camera);

}  // namespace tofsmith
