// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calibrate/depth_error_fit.hpp"
#include "calibrate/reference_samples.hpp"

namespace tofsmith {

struct DepthFit {
  std::vector<ReferenceSample> samples;
  double range_m = 0.0;
  int height = 0, width = 0;
  double start_m = 0.0;  // subtracted before the fit
  double signal_e_per_s = 1.0, min_signal_e_per_s = 0.0, max_signal_e_per_s = 0.0;
  Eigen::MatrixXd terms;    // (error_terms, samples)
  Eigen::VectorXd error_m;  // depth - reference - start
  Eigen::VectorXd base;     // from the predicted noise
  Eigen::VectorXd weight;   // base times the residual's weight
  double scale_m = 0.0;     // robust standard deviation of residuals

  Eigen::Index size() const { return static_cast<Eigen::Index>(samples.size()); }
};

template <typename Get>
std::vector<double> each(const std::vector<ReferenceSample>& samples, const Get& get) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const ReferenceSample& s : samples) values.push_back(get(s));
  return values;
}

/// Terms within and beyond the depths of the reference, with held-out residuals [m], if any.
struct Chosen {
  TermChoice known, beyond;
  std::optional<double> known_rms_m, beyond_rms_m;
  int skipped_blocks = 0;  ///< folds without samples in or out
  int skipped_parts = 0;   ///< for quarters of the range
};

/// Selects terms by cross-validation on alternate blocks and on quarters of the reference's range.
/// Without samples to hold out, selects the smallest set.
/// @param prefer_few  of sets that predict equally well, select the smallest, for tables with
///                    calibrated harmonics; otherwise the largest
Chosen choose(const DepthFit& fit, int highest_harmonic, int max_degree, bool prefer_few);

}  // namespace tofsmith
