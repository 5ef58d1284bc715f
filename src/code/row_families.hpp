// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "code/shared/family_rules.hpp"

namespace tofsmith {

/// Truncated Fourier series: the shortest pulse within the peak factor, and rows cos and sin at f0,
/// 2 f0, ...; an odd last row is a cosine.
CodeSet fourier_rows(int rows, const FamilyOptions& options);
std::optional<BrokenRule> fourier_rows_misfit(int rows, const FamilyOptions& options);

/// Histogram of K consecutive gates of equal length; the pulse is as long, or longer if the peak
/// factor requires it.
CodeSet histogram_rows(int rows, const FamilyOptions& options);
std::optional<BrokenRule> histogram_rows_misfit(int rows, const FamilyOptions& options);

}  // namespace tofsmith
