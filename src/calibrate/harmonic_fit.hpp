// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include "calibrate/harmonic_basis.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Measurements with known depth.
struct ReferencePixels {
  Eigen::MatrixXd electrons;  // (K, P)
  std::vector<double> depth_m;
  std::vector<int> tile;
  int tiles = 0;

  Eigen::Index size() const { return electrons.cols(); }
};

/// Correlation functions of a camera and their fundamentals.
struct Fundamentals {
  DecodingTable table;                         // with many rows
  std::vector<int> repetitions;                // of every frequency, in units of f0
  std::vector<std::size_t> frequency;          // of every measurement
  std::vector<std::complex<double>> harmonic;  // of every measurement

  int measurements() const { return table.measurements(); }
  /// Returns the correlation functions at a depth (K), interpolated between rows of the table.
  Eigen::VectorXd at(double depth_m) const {
    const auto rows = static_cast<double>(table.samples());
    const double row = (depth_m / table.range_m - std::floor(depth_m / table.range_m)) * rows;
    const auto low = static_cast<Eigen::Index>(row) % table.samples();
    const double share = row - std::floor(row);
    return (1.0 - share) * table.correlation.row(low) +
           share * table.correlation.row((low + 1) % table.samples());
  }
  double phase_rad(std::size_t its_frequency, double depth_m) const {
    return turn * repetitions[its_frequency] * depth_m / table.range_m;
  }
};

/// Fit of deviations b_h from the correlation functions for each frequency, see
/// calibrate_frequencies(). Columns are the real and imaginary parts of b_h.
class HarmonicFit {
 public:
  /// @param rows  N, which limits the number of harmonics
  HarmonicFit(const Fundamentals& model, const ReferencePixels& pixels, int rows);

  void solve();

  struct Term {
    std::size_t frequency;
    int harmonic;
  };
  const std::vector<Term>& terms() const { return terms_; }
  std::complex<double> deviation(std::size_t term) const {
    const auto at = 2 * static_cast<Eigen::Index>(term);
    return {deviation_[at], deviation_[at + 1]};
  }
  /// Returns the index of the term of a frequency's fundamental.
  std::size_t fundamental(std::size_t frequency) const;
  /// Returns the ratio of a frequency's fundamental to that of the model, 1 + b_1.
  std::complex<double> gain(std::size_t frequency) const {
    return 1.0 + deviation(fundamental(frequency));
  }
  /// Returns the standard errors of the real and the imaginary part of a deviation.
  std::array<double, 2> standard_errors(std::size_t term) const;
  /// Returns the standard error of Re b_1 of a frequency relative to its mean over all frequencies.
  double contrast_error(std::size_t frequency) const;
  /// Returns true if the frames determine a deviation better than the prior does. For fundamentals,
  /// the phase is tested.
  bool is_determined(std::size_t term) const;
  /// Returns the change of the correlation functions by the deviations at a depth (K).
  Eigen::VectorXd added(double depth_m) const { return functions(depth_m) * deviation_; }

 private:
  struct Sums {
    Eigen::MatrixXd gram;    // (columns, columns)
    Eigen::MatrixXd moment;  // (columns, tiles)
  };
  struct PixelTerms {
    Eigen::MatrixXd design;  // (K, columns), weighted, with signal and ambient light projected out
    Eigen::VectorXd residual;  // (K), weighted and projected in the same way
    bool is_valid = false;
  };

  Eigen::Index columns() const { return 2 * static_cast<Eigen::Index>(terms_.size()); }
  /// Returns the inverse prior covariance. The mean contrast is kept fixed, because it cannot be
  /// distinguished from the unknown brightness of the scene.
  Eigen::MatrixXd prior_information() const;
  Eigen::MatrixXd information_of(const Sums& sums) const;

  /// Returns the derivatives of the correlation functions by the deviations at a depth (K,
  /// columns).
  Eigen::MatrixXd functions(double depth_m) const;

  PixelTerms terms_of(Eigen::Index pixel) const;

  /// Calls add(pixel, block) for each pixel; blocks run in parallel.
  template <typename Add>
  void for_each_pixel(const Add& add) const;
  Sums all_sums() const;

  /// Updates the weights and the misfit from the residuals.
  void weigh();

  void estimate_errors();

  static constexpr std::int64_t block_size = 512;
  const Fundamentals& model_;
  const ReferencePixels& pixels_;
  std::vector<Term> terms_;
  Eigen::VectorXd prior_;          // standard deviations
  Eigen::VectorXd mean_contrast_;  // coefficients of the mean of Re b_1 over frequencies
  Eigen::VectorXd deviation_;      // b
  Eigen::MatrixXd covariance_;
  Eigen::VectorXd posterior_;  // variances, with the prior
  std::vector<double> weight_;
  double misfit_ = 1.0;  // median variance of residuals relative to their noise
};

}  // namespace tofsmith
