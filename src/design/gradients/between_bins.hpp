// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/shared/periodic.hpp"
#include "design/gradients/harmonic_sums.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Correlation functions at any real depth, from their samples at the N bins of waveforms that are
/// held over the N cells: exact, as ForwardModel has them. Straight between bins without impulse
/// responses, else by the harmonics that the arms let through.
class BetweenBins {
 public:
  BetweenBins(const Camera& camera, int samples);

  /// Functions sampled in the columns of a table (N, F), ready to be evaluated.
  struct Functions {
    HarmonicFunctions harmonics;
    Eigen::MatrixXd chords;  ///< (F, N); empty where harmonics are kept
    int count() const { return harmonics.functions; }
    void add(const Functions& others);
  };
  Functions of(const Eigen::MatrixXd& table) const;
  Functions zeros(int functions) const;

  /// Values (F, harmonic_block) at so many positions [bin], at most harmonic_block; their slopes
  /// per bin too unless null.
  void evaluate(const Functions& functions, std::span<const double> depth_bin, double* values,
                double* slopes) const;
  /// Adds to `gradient` that of sum weights[f][p] f(depth_bin[p]); weights (F, harmonic_block),
  /// zero beyond the positions.
  void add(std::span<const double> depth_bin, const double* weights, Functions& gradient) const;
  /// Values at `finer` even positions a bin, (finer N, F).
  Eigen::MatrixXd fine_table(const Functions& functions, int finer) const;
  /// Its adjoint.
  Functions pull_back_fine(const Eigen::MatrixXd& by_fine, int finer) const;
  /// Gradient by the table of a function whose gradient by the functions is given.
  Eigen::MatrixXd pull_back(const Functions& gradient) const;

 private:
  /// The chord a position lies on.
  struct Chord {
    Eigen::Index bin, next;
    double fraction;
  };
  Chord chord_at(double depth_bin) const;
  /// Harmonics on a grid of so many points: those too high for it fold onto lower ones.
  template <typename Visit>
  void fold(int points, const Visit& visit) const;

  int samples_;
  bool straight_;
  PeriodicTransform transform_;
  Eigen::VectorXcd shares_;
};

}  // namespace tofsmith
