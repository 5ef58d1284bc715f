// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

struct SquareTone {
  int frequency = 1;  ///< multiple of the fundamental
  int phases = 2;
  double share = 1.0;  ///< of the total integration time
};

/// Square waves: gates that are open for half of the period, light of one duty.
struct SquareCode {
  double duty = 0.5;
  std::vector<SquareTone> tones;

  int exposures() const;
  /// Repetitions per fundamental period.
  int repetitions() const;
  /// "square-15x2-10x2": frequencies and numbers of phases.
  std::string name() const;
};

/// Returns phases in steps of 1 / phase_steps periods: a quadrature pair for two exposures,
/// otherwise equal spacing, rounded to the steps.
std::vector<int> phases_in_steps(int phases, int phase_steps);

CodeSet to_code_set(const SquareCode& code, const Camera& camera);

/// Closed-form estimate of the depth error of square-wave codes, from means over depth. Frequency f
/// with s exposures of T/s seconds measures s values whose noise has the variance v_f. With the
/// harmonics a_h of their correlation function, two depths u apart differ by
///   w_f(u) = s (S T/s)^2 sum_h 2 |a_h|^2 2 (1 - cos 2 pi h f u).
/// The correlation decoder confuses them with probability Q(d / 2), d = sum w_f / sqrt(sum w_f
/// v_f); the error near the true depth follows from the curvature of w_f at 0. The estimate is
///   min(sqrt(2 / pi) sigma_z + sum over lobes of u 2 Q(d(u) / 2), R / 4),
/// with one lobe per period of the highest frequency, at its most probable u, and the unambiguous
/// range R of the code; geometric mean over the operating points.
class SquareErrorEstimate {
 public:
  SquareErrorEstimate(const Camera& camera, double duty, int highest_frequency);

  double error_m(const SquareCode& code) const;
  /// Lower bound of error_m() for every split of the time: each frequency has all of the time to
  /// distinguish lobes, and the best frequency for the local error. Assumes a decoder that weights
  /// measurements by their noise, whose error is never larger.
  double lower_bound_m(const SquareCode& code) const;
  /// Local part of lower_bound_m() of one frequency. The smallest value of several frequencies is a
  /// lower bound for every set of them that repeats at most `max_repetitions` times.
  double local_bound_m(const SquareTone& tone, int max_repetitions) const;

 private:
  struct Point {
    double signal_e = 0.0;     ///< in the total time, of a fully open sensor
    double variance_e2 = 0.0;  ///< light and dark current in the total time, of one measurement
  };
  struct Spectrum {
    double curvature = 0.0;   ///< sum of 2 |a_h|^2 (2 pi h f)^2
    Eigen::ArrayXd distance;  ///< sum of 2 |a_h|^2 2 (1 - cos 2 pi h x) over x in [0, 1)
  };
  struct Contribution {
    const Spectrum* spectrum = nullptr;
    double weight = 0.0, variance_e2 = 0.0;
  };

  std::vector<Contribution> contributions(const SquareCode& code, const Point& point,
                                          bool all_of_the_time) const;
  template <typename ErrorOfPoint>
  double mean_m(const ErrorOfPoint& error_of_point) const;
  template <typename Distance2>
  double lobes_m(const SquareCode& code, const std::vector<Contribution>& tones,
                 const Distance2& distance2) const;
  double local_m(double information) const;
  double cap_m(const SquareCode& code) const;

  double range_m_ = 0.0, read_variance_e2_ = 0.0;
  std::vector<Point> points_;
  std::vector<Spectrum> spectra_;
};

}  // namespace tofsmith
