// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace tofsmith {

// Poisson counts that, unlike std::poisson_distribution, are identical on every CPU and C++
// library.

/// Smaller means use inversion instead of rejection.
inline constexpr double min_rejection_mean = 10.0;

/// Transformed rejection, for min_rejection_mean <= mean <= 1e9. None: rejected, try other words.
/// @see Hoermann, The transformed rejection method for generating Poisson random variables,
///      Insurance: Mathematics and Economics 12 (1993): PTRS
std::optional<double> attempted_poisson(double mean, std::uint32_t u_word, std::uint32_t v_word);

/// Smallest k whose distribution function reaches a uniform number of 53 bits; for small means.
double inverted_poisson(double mean, std::uint32_t high_word, std::uint32_t low_word);

}  // namespace tofsmith
