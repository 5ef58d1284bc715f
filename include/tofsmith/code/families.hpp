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

/// What a family must respect of the camera it is built for.
struct FamilyOptions {
  int samples = 240;         ///< N
  double peak_factor = 1e9;  ///< p = P_max / P_ave >= 1; a huge value gives the ideal code
  bool exact_grid = true;    ///< of histogram-kK: reject N that would round its time gates
  /// Taps that share each exposure; from 3 on, no two are open at the same time. Two buckets are 1:
  /// CodeSet::with_two_buckets() adds the second one.
  int taps = 1;
  void validate() const;
};

/// Sinusoid modulation and demodulation, demodulation shifted in `phase_steps` equal steps.
/// Modulation is 1 + min(1, p - 1) cos, so that it stays within the peak.
CodeSet sinusoid_code(int phase_steps, const FamilyOptions& options);

/// One frequency of a multi-frequency code and how many phases of it are measured.
struct FrequencySteps {
  int frequency = 1;  ///< multiple of the fundamental
  int steps = 3;      ///< phase steps; 2 means a quadrature pair (0 and 90 degrees)
};

/// Multi-frequency sinusoids: for each entry a sinusoid with its phase steps.
/// The paper's K = 5 code is {{1, 3}, {7, 2}}. With n >= 3 taps, S steps (a multiple of n) take S / n
/// exposures, and the gain of a tap is (1 + cos) / n, so that the gains add up to 1.
CodeSet multi_frequency_code(const std::vector<FrequencySteps>& frequencies,
                             const FamilyOptions& options);

/// One line of the list of built-in families.
struct FamilyDescription {
  std::string name;         ///< pattern, such as "hamiltonian-k3..k10"
  std::string example;      ///< a name that can be built
  std::string description;  ///< one line
};

/// All built-in families.
std::vector<FamilyDescription> list_families();

/// Why no code of that name can be built with these options: no family is called so, the family has
/// no such member, or N would round its switching times. None: make_family() builds it.
std::optional<std::string> why_no_family(std::string_view name, const FamilyOptions& options);

/// Builds a family from its name: `sinusoid-k4`, `square-k4`, `hamiltonian-k3` .. `k10`,
/// `multifrequency-k5` (3 steps at f0 and 2 at 7 f0), `multifrequency-1x3-7x2` (any list of
/// frequency x steps), `pulsed-multifrequency-k5` and `-k4` (high frequency 3) or `..-q2` ..
/// `..-q8`, `gray-k3` .. `k10`, `single-ramp-k3`, `double-ramp-k3`; as rows of one exposure
/// `fourier-k2` .. `k16` and `histogram-k3` .. `k16`.
/// @throws InvalidArgument with the text of why_no_family(), if there is one
CodeSet make_family(std::string_view name, const FamilyOptions& options);

/// Whether `name` is the name of a family (whatever the options).
bool is_family(std::string_view name);

/// Rows of one exposure from a code of one tap whose exposures all have the same light: each
/// demodulation without its mean, so that constant light adds nothing; one that is constant as it
/// is.
/// @throws InvalidArgument with the text of why_no_rows(), if there is one
CodeSet rows_of(const CodeSet& code);
/// Why a code cannot become rows: several taps, light that differs between exposures, a gate that
/// never opens, or too many measurements. None: rows_of() makes them.
std::optional<std::string> why_no_rows(const CodeSet& code);

/// The coding curve is the closed path that the vector of K correlations draws as depth runs
/// through the range. Tables are (N, K), one row per depth, end point left out.

/// Length of the coding curve of a table, closed.
double coding_curve_length(const Eigen::MatrixXd& table);

/// Lowest harmonic h such that harmonics 1..h hold `share` of the energy of the non-constant part.
int harmonics_used(const Eigen::MatrixXd& table, double share = 0.99);

/// The curve in its three directions of largest extent (principal axes), (N, 3), for drawing; 0
/// along directions it does not have.
Eigen::MatrixXd coding_curve_in_space(const Eigen::MatrixXd& table);

/// Number of independent directions of the table, each column taken about its mean: singular values
/// above `tolerance` times the largest.
int coding_curve_rank(const Eigen::MatrixXd& table, double tolerance = 1e-6);

}  // namespace tofsmith
