// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// Returns the camera's shortest pulse or gap [periods], or 0.
double shortest_run_periods(const Camera& camera);

/// Tolerates rounding errors; always true for sampled waveforms.
bool keeps_shortest_run(const Waveform& waveform, double shortest_run);

bool keeps_shortest_run(const CodeSet& code, const Camera& camera);

/// A binary waveform as the start of its first run and its run lengths (on, off, ...), in
/// unconstrained parameters.
///
/// Without a duty limit: run lengths are shares (a softmax) of the period.
/// With a shortest duty: duty = shortest + (1 - shortest) t^2; on-runs share the duty and off-runs
/// the rest.
class RunLengths {
 public:
  /// @param shortest_duty  0: no limit
  RunLengths(const Waveform& waveform, double shortest_duty);

  Eigen::Index parameter_count() const { return parameters_.size(); }
  const Eigen::VectorXd& parameters() const { return parameters_; }

  /// Computes the switching times rise, fall, ... (2 P), not wrapped, and their derivatives (2 P,
  /// parameters).
  void edges(const Eigen::VectorXd& parameters, Eigen::VectorXd& times,
             Eigen::MatrixXd& derivatives) const;

  /// Returns the waveform without runs below `shortest_run` [periods]. With a duty limit its level
  /// is 1 / duty, at most 1 / shortest duty; otherwise 1.
  Waveform waveform(const Eigen::VectorXd& parameters, double shortest_run) const;

 private:
  void runs(const Eigen::VectorXd& parameters, Eigen::VectorXd& lengths,
            Eigen::MatrixXd& derivatives) const;

  double shortest_duty_;
  Eigen::Index runs_;           // 2 P
  Eigen::VectorXd parameters_;  // start, logits of the runs, [t]
};

}  // namespace tofsmith
