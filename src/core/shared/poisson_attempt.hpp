// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace tofsmith {

// Poisson counts from words of 32 random bits: the same on every processor and C++ library, which
// std::poisson_distribution is not.

/// From this mean on counts are attempted, below they are inverted.
inline constexpr double min_rejection_mean = 10.0;

/// An attempt of transformed rejection, for min_rejection_mean <= mean <= 1e9; none: not accepted,
/// try again with other words.
/// @see Hoermann, The transformed rejection method for generating Poisson random variables,
///      Insurance: Mathematics and Economics 12 (1993): PTRS
std::optional<double> attempted_poisson(double mean, std::uint32_t u_word, std::uint32_t v_word);

/// Smallest k whose distribution function reaches a uniform number of 53 bits; for small means.
double inverted_poisson(double mean, std::uint32_t high_word, std::uint32_t low_word);

}  // namespace tofsmith
