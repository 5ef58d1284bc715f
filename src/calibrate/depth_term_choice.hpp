// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/reference_samples.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

inline constexpr int max_error_harmonic = 8, max_error_degree = 4, max_error_signal = 2;
inline constexpr int field_terms = (max_error_degree + 1) * (max_error_degree + 2) / 2 - 1;
inline constexpr int error_terms = 1 + 2 * max_error_harmonic + field_terms + max_error_signal;

struct TermChoice {
  unsigned harmonics = 0;  ///< bit h - 1: harmonic h
  int degree = 0;          ///< over rows and columns
  int signal = 0;          ///< highest power of its logarithm

  /// Columns among all error_terms: offset, harmonics, field, signal.
  std::vector<int> columns() const;
  int size() const { return static_cast<int>(columns().size()); }
};

/// "offset", "cos 4", "row^2 column", "log signal^2".
std::string error_term_name(int column);

/// All terms of one pixel, see DepthErrorTerms.
void fill_error_terms(double phase_rad, double row, double column, double log_signal,
                      double* terms);

DepthErrorTerms terms_of(const TermChoice& choice, const Eigen::VectorXd& coefficient);

/// Sums for weighted least squares.
struct NormalSums {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(error_terms, error_terms);
  Eigen::VectorXd moment = Eigen::VectorXd::Zero(error_terms);
  double square = 0.0;
  double weight = 0.0;

  void add(const NormalSums& other);
  Eigen::VectorXd solve(const std::vector<int>& columns) const;
  /// Weighted residual sum of squares.
  double left(const std::vector<int>& columns, const Eigen::VectorXd& coefficient) const;
};

/// @param terms  (error_terms, samples)
/// @param cell   of each sample, in [0, cells)
std::vector<NormalSums> sums_of(const Eigen::MatrixXd& terms, const Eigen::VectorXd& error_m,
                                const Eigen::VectorXd& weight, const std::vector<int>& cell,
                                int cells);

/// Standard errors of coefficients whose residuals may be correlated within tiles (cluster-robust
/// sandwich estimator).
/// @param slope  derivative of each sample's influence with respect to its residual
/// @param influence  weight times residual
Eigen::VectorXd tile_errors(const Eigen::MatrixXd& terms, const std::vector<int>& columns,
                            const Eigen::VectorXd& slope, const Eigen::VectorXd& influence,
                            const std::vector<int>& tile, int tiles);

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
