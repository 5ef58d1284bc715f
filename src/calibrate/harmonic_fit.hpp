// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <vector>

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

inline constexpr double turn = 2 * std::numbers::pi;

/// Curves y(u) = c_0 + 2 Re sum_n c_n exp(2 pi i n u) at positions u.
class HarmonicBasis {
 public:
  /// @param places     in periods (F)
  /// @param harmonics  H, with 2 H + 1 <= number of distinct positions
  HarmonicBasis(const std::vector<double>& places, int harmonics);

  int harmonics() const { return harmonics_; }
  /// Least squares coefficients c (H + 1, K) of values (F, K).
  Eigen::MatrixXcd coefficients(const Eigen::MatrixXd& values) const;
  /// Values (F, K) of coefficients c (H + 1, K).
  Eigen::MatrixXd values(const Eigen::MatrixXcd& coefficients) const;

 private:
  int harmonics_;
  Eigen::MatrixXd basis_, inverse_;  // 1, cos, sin; (F, 2 H + 1) and its pseudo-inverse
};

/// Values (rows, K) of coefficients c (H + 1, K) at j / rows.
Eigen::MatrixXd curve_of(const Eigen::MatrixXcd& coefficients, int rows);

/// c_n exp(2 pi i n shift): y(u + shift).
Eigen::MatrixXcd advanced(Eigen::MatrixXcd coefficients, double shift);

struct ReferencePixels {
  Eigen::MatrixXd electrons;  // (K, P)
  std::vector<double> depth_m;
  std::vector<int> tile;
  int tiles = 0;

  Eigen::Index size() const { return electrons.cols(); }
};

struct Fundamentals {
  DecodingTable table;                 // with many rows
  std::vector<int> repetitions;        // of frequencies, in units of f0
  std::vector<std::size_t> frequency;  // of measurements
  std::vector<std::complex<double>> harmonic;

  int measurements() const { return table.measurements(); }
  /// Interpolates the correlation functions at a depth (K).
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

/// Fit of deviations b_h for each frequency, see calibrate_frequencies(). Columns are their real
/// and imaginary parts.
class HarmonicFit {
 public:
  /// @param rows  N, which limits the harmonics
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
  /// Term of a frequency's fundamental.
  std::size_t fundamental(std::size_t frequency) const;
  /// Ratio of a frequency's fundamental to the model's, 1 + b_1.
  std::complex<double> gain(std::size_t frequency) const {
    return 1.0 + deviation(fundamental(frequency));
  }
  /// Standard errors of the real and the imaginary part.
  std::array<double, 2> standard_errors(std::size_t term) const;
  /// Standard error of Re b_1 relative to its mean over all frequencies.
  double contrast_error(std::size_t frequency) const;
  /// Returns true if the frames determine a deviation (of fundamentals, the phase) better than the
  /// prior.
  bool is_determined(std::size_t term) const;
  /// Change of the correlation functions at a depth (K).
  Eigen::VectorXd added(double depth_m) const { return functions(depth_m) * deviation_; }

 private:
  struct Sums {
    Eigen::MatrixXd gram;    // (columns, columns)
    Eigen::MatrixXd moment;  // (columns, tiles)
  };
  struct PixelTerms {
    Eigen::MatrixXd design;    // weighted, without signal and ambient light
    Eigen::VectorXd residual;  // weighted, without signal and ambient light
    bool is_valid = false;
  };

  Eigen::Index columns() const { return 2 * static_cast<Eigen::Index>(terms_.size()); }
  /// Inverse prior covariance. The mean contrast is fixed, because the brightness of the scene is
  /// unknown.
  Eigen::MatrixXd prior_information() const;
  Eigen::MatrixXd information_of(const Sums& sums) const;

  /// Derivatives of the correlation functions by the deviations (K, columns).
  Eigen::MatrixXd functions(double depth_m) const;

  PixelTerms terms_of(Eigen::Index pixel) const;

  /// Calls add(pixel, block) for each pixel; blocks run in parallel.
  template <typename Add>
  void for_each_pixel(const Add& add) const;
  Sums all_sums() const;

  void weigh();

  void estimate_errors();

  static constexpr std::int64_t block_size = 512;
  const Fundamentals& model_;
  const ReferencePixels& pixels_;
  std::vector<Term> terms_;
  Eigen::VectorXd prior_;          // standard deviations
  Eigen::VectorXd mean_contrast_;  // of Re b_1 over frequencies
  Eigen::VectorXd deviation_;      // b
  Eigen::MatrixXd covariance_;
  Eigen::VectorXd posterior_;  // variances
  std::vector<double> weight_;
  double misfit_ = 1.0;  // median variance of residuals relative to noise
};

}  // namespace tofsmith
