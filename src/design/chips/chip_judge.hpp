// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "design/chips/chip_margin.hpp"
#include "tofsmith/design/chip_search.hpp"

namespace tofsmith {

/// Fisher matrix at one depth over (depth in chips, log S, ambient light in electrons per open
/// chip). Exposures add.
struct FisherMatrix {
  double zz = 0.0, zs = 0.0, ss = 0.0, za = 0.0, sa = 0.0, aa = 0.0;

  FisherMatrix& operator+=(const FisherMatrix& other);
  /// Returns [inverse]_zz; infinite if depth cannot be separated from the light levels.
  double depth_variance() const;
};

inline constexpr int nodes_per_chip = 4;

/// Returns the Fisher matrix of one tap at the first of two adjacent depths, with the largest
/// weight 1 / variance between them.
FisherMatrix largest_tap_fisher(int correlation, int next, int open_chips,
                                double electrons_per_chip, const ChipLight& light);

/// Evaluates codes at all operating points, cheapest tests first.
class ChipJudge {
 public:
  ChipJudge(const Camera& camera, const ChipSearchOptions& options);

  int chips() const { return chips_; }
  int taps() const { return taps_; }
  ChipMetric metric() const { return metric_; }
  const std::vector<ChipLight>& lights() const { return lights_; }

  /// Returns the geometric mean over the operating points of the mean variance over depth of the
  /// best unbiased depth estimate [chips^2],
  ///   gamma = mean over z of [inverse Fisher matrix over (z, S, A)]_zz,
  /// or, with known light, the mean of 1 / [Fisher matrix]_zz, with variances
  /// v_i = T_e (S chi_i + A kappa_i + dark) + constant. Infinite if depth cannot be separated from
  /// light levels.
  double score(const ChipCode& code) const;
  /// Returns score(), or any value above `limit` if the score is larger. `nodes` contains the
  /// Fisher matrices (points x 4 n) of all exposures except the last.
  double score_with_last(const ChipCode& code, const std::vector<FisherMatrix>& nodes,
                         double limit) const;
  std::vector<FisherMatrix> nodes_of(const ChipCode& code, int exposures) const;

  /// Returns true for unambiguous codes with sufficient margin at every point; counts failures.
  bool is_safe(const ChipCode& code, ChipSearchCounts& counts) const;
  /// Returns an upper bound of the smallest ratio of margin to required margin, by sampling.
  double sampled_margin_share(const ChipCode& code) const;
  /// Returns the proven margin at the point with the smallest such ratio [sigma].
  double proven_margin_sigma(const ChipCode& code) const;
  const std::vector<double>& asked_sigma() const { return asked_sigma_; }
  /// Lowers the required margins to the margins of the best of these codes.
  void ask_no_more_than(const std::vector<ChipCode>& codes);

  double rms_m(double score) const;
  bool is_allowed(const ChipCode& code) const;

 private:
  int chips_, taps_;
  bool equal_duty_, drain_;
  ChipMetric metric_;
  double separation_periods_;
  std::vector<ChipLight> lights_;
  std::vector<double> asked_sigma_;
};

}  // namespace tofsmith
