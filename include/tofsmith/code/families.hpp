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
  double peak_factor = 1e9;  ///< p = P_max / P_ave >= 1; a very large value gives the ideal code
  bool exact_grid = true;    ///< for histogram-kK: reject N that would round its time gates
  /// Taps of an exposure. From 3 on, they are open one after another. For two buckets it is 1, and
  /// CodeSet::with_two_buckets() adds the second bucket.
  int taps = 1;
  void validate() const;
};

/// Sinusoid with demodulation in `phase_steps` equal phase steps. Modulation is 1 + min(1, p - 1)
/// cos, to respect the peak factor.
CodeSet sinusoid_code(int phase_steps, const FamilyOptions& options);

/// One frequency of a multi-frequency code and its number of phase steps.
struct FrequencySteps {
  int frequency = 1;  ///< multiple of the fundamental
  int steps = 3;      ///< 2 means a quadrature pair (0 and 90 degrees)
};

/// Sinusoids at several frequencies. The paper's K = 5 code is {{1, 3}, {7, 2}}.
/// With n >= 3 taps, S steps (a multiple of n) need S / n exposures, and each tap has the gain
/// (1 + cos) / n, so that the gains sum to 1.
CodeSet multi_frequency_code(const std::vector<FrequencySteps>& frequencies,
                             const FamilyOptions& options);

/// An entry in the list of built-in families.
struct FamilyDescription {
  std::string name;         ///< pattern such as "hamiltonian-k3..k10"
  std::string example;      ///< name of one member
  std::string description;  ///< one line
};

std::vector<FamilyDescription> list_families();

/// Explains why no code of that name can be built: unknown family, member out of range, or an N
/// that would round its switching times. None: make_family() succeeds.
std::optional<std::string> why_no_family(std::string_view name, const FamilyOptions& options);

/// Builds a family member by name: `sinusoid-k4`, `square-k4`, `hamiltonian-k3` to `k10`,
/// `multifrequency-k5` (3 steps at f0 and 2 at 7 f0), `multifrequency-1x3-7x2` (any list of
/// frequency x steps), `pulsed-multifrequency-k5` and `-k4` (high frequency 3; suffixes `-q2` to
/// `-q8` select another), `gray-k3` to `k10`, `single-ramp-k3`, `double-ramp-k3`; as rows of one
/// exposure `fourier-k2` to `k16` and `histogram-k3` to `k16`.
/// @throws InvalidArgument with the text of why_no_family()
CodeSet make_family(std::string_view name, const FamilyOptions& options);

/// Returns true if `name` is the name of a family member, for any options.
bool is_family(std::string_view name);

/// Converts a code of one tap, whose exposures share the same light, to rows of one exposure: each
/// demodulation minus its mean, so that constant light contributes nothing; constant demodulations
/// are kept.
/// @throws InvalidArgument with the text of why_no_rows()
CodeSet rows_of(const CodeSet& code);
/// Explains why a code cannot be converted to rows: several taps, light that differs between
/// exposures, a gate that never opens, or too many measurements. None: rows_of() succeeds.
std::optional<std::string> why_no_rows(const CodeSet& code);

/// The coding curve is the closed path of the vector of K correlations as depth runs through the
/// range. Tables are (N, K), one row per depth, without the end point.

/// Length of the closed coding curve of a table.
double coding_curve_length(const Eigen::MatrixXd& table);

/// Lowest harmonic h such that harmonics 1..h hold `share` of the energy of the non-constant part.
int harmonics_used(const Eigen::MatrixXd& table, double share = 0.99);

/// Projection of the curve onto its three principal axes, (N, 3), for plots; 0 for missing axes.
Eigen::MatrixXd coding_curve_in_space(const Eigen::MatrixXd& table);

/// Number of independent directions of the table about its mean: singular values above `tolerance`
/// times the largest.
int coding_curve_rank(const Eigen::MatrixXd& table, double tolerance = 1e-6);

}  // namespace tofsmith
