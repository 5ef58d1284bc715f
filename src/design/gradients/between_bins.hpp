// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/shared/periodic.hpp"
#include "design/gradients/harmonic_sums.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Correlation functions at any real depth, from samples at the N bins of waveforms that are
/// constant within each of N cells. Exact, as in ForwardModel: linear between bins without impulse
/// responses, otherwise by the harmonics within the bandwidth.
class BetweenBins {
 public:
  BetweenBins(const Camera& camera, int samples);

  /// Functions from the columns of a table (N, F), prepared for evaluation.
  struct Functions {
    HarmonicFunctions harmonics;
    Eigen::MatrixXd chords;  ///< (F, N); empty if harmonics are used
    int count() const { return harmonics.functions; }
    void add(const Functions& others);
  };
  Functions of(const Eigen::MatrixXd& table) const;
  Functions zeros(int functions) const;

  /// Computes the values (F, harmonic_block) at up to harmonic_block positions [bin], and the
  /// slopes per bin unless `slopes` is null.
  void evaluate(const Functions& functions, std::span<const double> depth_bin, double* values,
                double* slopes) const;
  /// Adds to `gradient` the gradient of sum weights[f][p] f(depth_bin[p]). weights (F,
  /// harmonic_block) must be zero for unused positions.
  void add(std::span<const double> depth_bin, const double* weights, Functions& gradient) const;
  /// Returns the values at `finer` equidistant positions per bin, (finer N, F).
  Eigen::MatrixXd fine_table(const Functions& functions, int finer) const;
  /// Adjoint of fine_table().
  Functions pull_back_fine(const Eigen::MatrixXd& by_fine, int finer) const;
  /// Converts a gradient with respect to the functions to one with respect to the table.
  Eigen::MatrixXd pull_back(const Functions& gradient) const;

 private:
  /// Chord that contains a position.
  struct Chord {
    Eigen::Index bin, next;
    double fraction;
  };
  Chord chord_at(double depth_bin) const;
  /// Visits the harmonics on a grid of `points` samples; high harmonics are aliased to lower ones.
  template <typename Visit>
  void fold(int points, const Visit& visit) const;

  int samples_;
  bool straight_;
  PeriodicTransform transform_;
  Eigen::VectorXcd shares_;
};

}  // namespace tofsmith
