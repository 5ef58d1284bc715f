// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace tofsmith {

// Poisson counts from words of 32 random bits: unlike std::poisson_distribution, identical on every
// CPU and C++ library.

/// Counts with at least this mean use rejection, smaller ones inversion.
inline constexpr double min_rejection_mean = 10.0;

/// Attempts transformed rejection, for min_rejection_mean <= mean <= 1e9. None: rejected, try again
/// with other words.
/// @see Hoermann, The transformed rejection method for generating Poisson random variables,
///      Insurance: Mathematics and Economics 12 (1993): PTRS
std::optional<double> attempted_poisson(double mean, std::uint32_t u_word, std::uint32_t v_word);

/// Returns the smallest k whose distribution function reaches a uniform number of 53 bits; for
/// small means.
double inverted_poisson(double mean, std::uint32_t high_word, std::uint32_t low_word);

}  // namespace tofsmith
