// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "design/chips/chip_light.hpp"
#include "tofsmith/design/chip_search.hpp"

namespace tofsmith {

/// Fisher matrix over (depth in chips, log S, ambient light in electrons per open chip) at one
/// depth. Matrices of several exposures add.
struct FisherMatrix {
  double zz = 0.0, zs = 0.0, ss = 0.0, za = 0.0, sa = 0.0, aa = 0.0;

  FisherMatrix& operator+=(const FisherMatrix& other);
  /// [inverse]_zz; infinite where depth cannot be separated from the other two.
  double depth_variance() const;
};

/// Nodes of the quadrature within a chip.
inline constexpr int nodes_per_chip = 4;

/// Fisher matrices of one exposure at all nodes, chip by chip (4 n), added to `nodes`.
void add_exposure(ChipWord modulation, const ChipWord* taps, int tap_count, const ChipLight& light,
                  FisherMatrix* nodes);

/// gamma [chips^2]: the mean over depth of depth_variance(). Stops at a value above `limit`.
double mean_depth_variance(const FisherMatrix* nodes, int chips,
                           double limit = std::numeric_limits<double>::infinity());

/// gamma of a code [chips^2]; stops at a value above `limit`.
double chip_gamma(const ChipCode& code, const ChipLight& light,
                  double limit = std::numeric_limits<double>::infinity());

/// Fisher matrix of one tap with its depth at the first of two neighbouring depths, but with the
/// largest weight, 1 / variance, it has anywhere between them: at the darker end.
FisherMatrix largest_tap_fisher(int correlation, int next, int open_chips,
                                double electrons_per_chip, const ChipLight& light);

/// Judges codes at all operating points of a camera, the cheapest question first.
class ChipJudge {
 public:
  ChipJudge(const Camera& camera, const ChipSearchOptions& options);

  int chips() const { return chips_; }
  int taps() const { return taps_; }
  const std::vector<ChipLight>& lights() const { return lights_; }

  /// Geometric mean over the points of gamma [chips^2].
  double score(const ChipCode& code) const;
  /// The same, but some value above `limit` where it is above that. `nodes` holds the Fisher
  /// matrices at every point (points x 4 n) of all exposures but the code's last.
  double score_with_last(const ChipCode& code, const std::vector<FisherMatrix>& nodes,
                         double limit) const;
  std::vector<FisherMatrix> nodes_of(const ChipCode& code, int exposures) const;

  /// Whether the code is unambiguous and keeps the margin at every point; counts what failed.
  bool is_safe(const ChipCode& code, ChipSearchCounts& counts) const;
  /// Least margin over the points, as a share of what is asked there; sampled, never too small.
  double sampled_margin_share(const ChipCode& code) const;
  /// Proven margin at the point where it is the smallest share of what is asked [sigma].
  double proven_margin_sigma(const ChipCode& code) const;
  /// Margin asked at every point [sigma].
  const std::vector<double>& asked_sigma() const { return asked_sigma_; }
  /// Asks of every point no more than one of these codes keeps there: the one whose smallest share
  /// of what is asked is the largest.
  void ask_no_more_than(const std::vector<ChipCode>& codes);

  /// Root of a score as depth [m].
  double rms_m(double score) const;
  /// Whether the words are a code at all: light and taps that change, duties as asked.
  bool is_allowed(const ChipCode& code) const;

 private:
  int chips_, taps_;
  bool equal_duty_, drain_;
  double separation_periods_;
  std::vector<ChipLight> lights_;
  std::vector<double> asked_sigma_;
};

}  // namespace tofsmith
