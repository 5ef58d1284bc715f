// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// A binary waveform by the lengths of its runs on, off, on, .. and where the first begins, written
/// in free parameters: every choice of numbers is a valid waveform, so a fit needs no constraints.
///
/// Without a duty limit: all runs are shares (a softmax) of the period.
/// With a shortest duty: duty = shortest + (1 - shortest) t^2; on-runs are shares of the duty and
/// off-runs of the rest.
class RunLengths {
 public:
  /// @param shortest_duty  0: duty is free
  RunLengths(const Waveform& waveform, double shortest_duty);

  Eigen::Index parameter_count() const { return parameters_.size(); }
  const Eigen::VectorXd& parameters() const { return parameters_; }

  /// Switching times rise, fall, rise, .. (2 P) at these parameters, not wrapped, and their
  /// derivatives (2 P, parameters).
  void edges(const Eigen::VectorXd& parameters, Eigen::VectorXd& times,
             Eigen::MatrixXd& derivatives) const;

  /// The waveform at these parameters; level 1 / duty if a duty limit was given, never above
  /// 1 / shortest duty; else 1.
  /// Runs shorter than `shortest_run` [periods] are dropped.
  Waveform waveform(const Eigen::VectorXd& parameters, double shortest_run) const;

 private:
  /// Lengths of the runs (2 P) and their derivatives.
  void runs(const Eigen::VectorXd& parameters, Eigen::VectorXd& lengths,
            Eigen::MatrixXd& derivatives) const;

  double shortest_duty_;
  Eigen::Index runs_;           // 2 P
  Eigen::VectorXd parameters_;  // begin, logits of the runs, [t]
};

}  // namespace tofsmith
