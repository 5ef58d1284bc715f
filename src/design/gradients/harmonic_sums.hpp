// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

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

}  // namespace tofsmith
