// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simulate/trial_kernel.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

/// What trials of rows of one exposure measure. Poisson noise is drawn for every time bin and
/// weighted by the rows; normal noise has the covariance of that depth and light, by its Cholesky
/// factor. Light and covariance are linear between 16 points per bin.
class RowTrials {
 public:
  RowTrials(const ForwardModel& model, const Camera& camera);

  int measurements() const { return measurements_; }
  /// Fills `taps` with raw numbers, [K][trials_per_tile], from row, share, signal and K rows of
  /// normals.
  void draw(const TrialStreams& streams, double ambient_e_per_s, int trials, TrialTile& tile) const;

 private:
  void draw_poisson_rows(const TrialStreams& streams, double ambient_e_per_s, int trials,
                         TrialTile& tile) const;
  void draw_normal_rows(double ambient_e_per_s, int trials, TrialTile& tile) const;

  int measurements_, samples_, points_;
  bool is_poisson_;
  double read_noise_e_;
  std::vector<double> bin_e_;   // electrons in time bin 0 per unit of S, (points + 1)
  double bin_ambient_e_ = 0.0;  // per unit of A
  double bin_dark_e_ = 0.0;
  std::vector<float> weights_;                    // [N][K]
  Eigen::MatrixXd mean_e_;                        // of the rows per unit of S, (K, points)
  Eigen::VectorXd mean_ambient_e_, mean_dark_e_;  // (K)
  RowCovariance covariance_;                      // of normal noise alone
};

}  // namespace tofsmith
