// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// Camera properties that a family must respect.
struct FamilyOptions {
  int samples = 240;         ///< N
  double peak_factor = 1e9;  ///< p = P_max / P_ave >= 1; very large: the ideal code
  /// From 3 taps on, they are open one after another. For two buckets it is 1; see
  /// CodeSet::with_two_buckets().
  int taps = 1;
  void validate() const;
};

/// Sinusoid with equal phase steps of the demodulation. Modulation is 1 + min(1, p - 1) cos, to
/// respect the peak factor.
CodeSet sinusoid_code(int phase_steps, const FamilyOptions& options);

/// Frequency of a multi-frequency code.
struct FrequencySteps {
  int frequency = 1;  ///< multiple of the fundamental
  int steps = 3;      ///< 2 means a quadrature pair (0 and 90 degrees)
};

/// Sinusoids at several frequencies. The paper's K = 5 code is {{1, 3}, {7, 2}}. With n >= 3 taps,
/// S steps (a multiple of n) need S / n exposures, and each tap has the gain (1 + cos) / n.
CodeSet multi_frequency_code(const std::vector<FrequencySteps>& frequencies,
                             const FamilyOptions& options);

/// Entry in the list of families.
struct FamilyDescription {
  std::string name;     ///< pattern such as "hamiltonian-k3..k10"
  std::string example;  ///< a member
  std::string description;
};

std::vector<FamilyDescription> list_families();

/// Returns why no code of that name can be built: unknown family, member out of range, or an N that
/// would round its switching times. None: make_family() succeeds.
std::optional<std::string> why_no_family(std::string_view name, const FamilyOptions& options);

/// Builds a family member by name, such as `hamiltonian-k5`, `multifrequency-1x3-7x2` (frequency x
/// steps), `pulsed-multifrequency-k5-q4` (high frequency 4) or, as rows of one exposure,
/// `fourier-k8`. See list_families().
/// @throws InvalidArgument with the text of why_no_family()
CodeSet make_family(std::string_view name, const FamilyOptions& options);

/// Returns true for the name of a family member with any options.
bool is_family(std::string_view name);

/// Converts a code of one tap, whose exposures share the same light, to rows of one exposure: each
/// demodulation minus its mean unless it is constant, so that constant light contributes nothing.
/// @throws InvalidArgument with the text of why_no_rows()
CodeSet rows_of(const CodeSet& code);
/// Returns why a code cannot be converted to rows; none if it can.
std::optional<std::string> why_no_rows(const CodeSet& code);

/// The coding curve is the closed path of the vector of K correlations over depth. Tables are (N,
/// K), without the end point.

double coding_curve_length(const Eigen::MatrixXd& table);

/// Lowest harmonic h such that harmonics 1..h hold `share` of the energy without the mean.
int harmonics_used(const Eigen::MatrixXd& table, double share = 0.99);

/// Projection onto the three principal axes, (N, 3), for plots; 0 for missing axes.
Eigen::MatrixXd coding_curve_in_space(const Eigen::MatrixXd& table);

/// Number of independent directions about the mean: singular values above `tolerance` times the
/// largest.
int coding_curve_rank(const Eigen::MatrixXd& table, double tolerance = 1e-6);

}  // namespace tofsmith
