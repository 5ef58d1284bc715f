// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/shared/periodic.hpp"
#include "design/optimize/sampled_camera.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/design/code_gradients.hpp"

namespace tofsmith {

/// Periodic functions, represented by their harmonics:
///   f(u) = sum_n real[n] cos(2 pi n u) - imag[n] sin(2 pi n u),  0 <= n < harmonics
struct HarmonicFunctions {
  HarmonicFunctions(int harmonic_count, int function_count)
      : harmonics(harmonic_count),
        functions(function_count),
        real(static_cast<std::size_t>(harmonic_count) * static_cast<std::size_t>(function_count)),
        imag(real.size()) {}

  std::size_t at(int harmonic, int function) const {
    return static_cast<std::size_t>(harmonic) * static_cast<std::size_t>(functions) +
           static_cast<std::size_t>(function);
  }

  int harmonics, functions;
  std::vector<double> real, imag;  ///< (harmonics, functions)
};

/// Points per block: whole vectors of any instruction set.
constexpr int harmonic_block = 64;

/// Computes all functions (functions, harmonic_block) at harmonic_block positions [periods], and
/// slopes per period unless null.
void sum_harmonics(const HarmonicFunctions& functions, const double* periods, double* values,
                   double* slopes);

/// Adjoint: adds the gradient of sum weights[f][p] f(periods[p]).
void add_harmonics(const double* periods, const double* weights, HarmonicFunctions& gradient);

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

  int samples_;
  bool straight_;
  PeriodicTransform transform_;
  Eigen::VectorXcd shares_;
};

}  // namespace tofsmith
