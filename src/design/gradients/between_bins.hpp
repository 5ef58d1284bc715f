// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "core/shared/periodic.hpp"
#include "design/gradients/harmonic_sums.hpp"
#include "design/optimize/sampled_camera.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/design/code_gradients.hpp"

namespace tofsmith {

/// Exact correlation functions at any depth, from N samples of waveforms constant within N cells:
/// linear between bins without impulse responses, otherwise by harmonics (as ForwardModel).
class BetweenBins {
 public:
  BetweenBins(const Camera& camera, int samples);

  /// Columns of a table (N, F).
  struct Functions {
    HarmonicFunctions harmonics;
    Eigen::MatrixXd chords;  ///< (F, N); empty if harmonics are used
    int count() const { return harmonics.functions; }
    void add(const Functions& others);
  };
  Functions of(const Eigen::MatrixXd& table) const;
  Functions zeros(int functions) const;

  /// Computes values (F, harmonic_block) at up to harmonic_block positions [bin], and slopes per
  /// bin unless null.
  void evaluate(const Functions& functions, std::span<const double> depth_bin, double* values,
                double* slopes) const;
  /// Adds the gradient of sum weights[f][p] f(depth_bin[p]); weights (F, harmonic_block).
  void add(std::span<const double> depth_bin, const double* weights, Functions& gradient) const;
  Eigen::MatrixXd fine_table(const Functions& functions, int finer) const;
  /// Adjoint of fine_table().
  Functions pull_back_fine(const Eigen::MatrixXd& by_fine, int finer) const;
  Eigen::MatrixXd pull_back(const Functions& gradient) const;

 private:
  struct Chord {
    Eigen::Index bin, next;
    double fraction;
  };
  Chord chord_at(double depth_bin) const;
  template <typename Visit>
  void fold(int points, const Visit& visit) const;

  int samples_;
  bool straight_;
  PeriodicTransform transform_;
  Eigen::VectorXcd shares_;
};

}  // namespace tofsmith
