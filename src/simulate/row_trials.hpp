// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simulate/trial_kernel.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

/// Measurements of rows of one exposure. Poisson noise is drawn for every time bin and weighted by
/// the rows; normal noise has the covariance at that depth and light.
class RowTrials {
 public:
  static constexpr int points_per_bin = 16;  // same as in TrialModel

  RowTrials(const ForwardModel& model, const Camera& camera);

  int measurements() const { return measurements_; }
  /// Fills `taps` with raw numbers, [K][trials_per_tile], from row, share, signal and K rows of
  /// normals.
  void draw(const TrialStreams& streams, double ambient_e_per_s, int trials, TrialTile& tile) const;

 private:
  /// Electrons and variances without the signal, in the layout of of_signal_.
  std::vector<double> beside_signal(double ambient_e_per_s) const;
  void draw_poisson_rows(const TrialStreams& streams, double ambient_e_per_s, int trials,
                         TrialTile& tile) const;
  void draw_normal_rows(double ambient_e_per_s, int trials, TrialTile& tile) const;

  int measurements_, samples_, points_;
  bool is_poisson_;
  double read_noise_e_;
  std::vector<double> of_signal_;
  std::vector<double> of_ambient_, of_dark_;  // per unit of A; without light
  std::vector<float> weights_;
};

}  // namespace tofsmith
