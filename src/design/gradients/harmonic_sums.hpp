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

/// Number of points per block: a multiple of the vector length for all instruction sets.
constexpr int harmonic_block = 64;

/// Computes the values of all functions (functions, harmonic_block) at harmonic_block positions
/// [periods], and the slopes per period unless `slopes` is null.
void sum_harmonics(const HarmonicFunctions& functions, const double* periods, double* values,
                   double* slopes);

/// Adjoint of the values: adds to `gradient` the gradient of sum weights[f][p] f(periods[p]).
void add_harmonics(const double* periods, const double* weights, HarmonicFunctions& gradient);

}  // namespace tofsmith
