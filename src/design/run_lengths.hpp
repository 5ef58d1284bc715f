// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// Represents a binary waveform by the start of its first run and the lengths of its runs (on, off,
/// on, ...), as unconstrained parameters: all values are valid, so a fit needs no constraints.
///
/// Without a duty limit: all run lengths are shares (a softmax) of the period.
/// With a shortest duty: duty = shortest + (1 - shortest) t^2; on-runs are shares of the duty and
/// off-runs are shares of the rest.
class RunLengths {
 public:
  /// @param shortest_duty  minimum duty; 0: no limit
  RunLengths(const Waveform& waveform, double shortest_duty);

  Eigen::Index parameter_count() const { return parameters_.size(); }
  const Eigen::VectorXd& parameters() const { return parameters_; }

  /// Computes the switching times rise, fall, rise, ... (2 P), not wrapped, and their derivatives
  /// (2 P, parameters).
  void edges(const Eigen::VectorXd& parameters, Eigen::VectorXd& times,
             Eigen::MatrixXd& derivatives) const;

  /// Returns the waveform. With a duty limit its level is 1 / duty, at most 1 / shortest duty;
  /// otherwise 1. Runs shorter than `shortest_run` [periods] are removed.
  Waveform waveform(const Eigen::VectorXd& parameters, double shortest_run) const;

 private:
  /// Computes the lengths of the runs (2 P) and their derivatives.
  void runs(const Eigen::VectorXd& parameters, Eigen::VectorXd& lengths,
            Eigen::MatrixXd& derivatives) const;

  double shortest_duty_;
  Eigen::Index runs_;           // 2 P
  Eigen::VectorXd parameters_;  // start, logits of the runs, [t]
};

}  // namespace tofsmith
