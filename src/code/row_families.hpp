// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "code/shared/family_rules.hpp"

namespace tofsmith {

/// Truncated Fourier series: the shortest pulse within the peak, and rows cos and sin at f0, 2 f0,
/// ..; of an odd number the last is a cosine.
CodeSet fourier_rows(int rows, const FamilyOptions& options);
std::optional<BrokenRule> fourier_rows_misfit(int rows, const FamilyOptions& options);

/// A histogram of K time gates of equal length, behind one another, with a pulse as long as a gate
/// or as the peak asks for.
CodeSet histogram_rows(int rows, const FamilyOptions& options);
std::optional<BrokenRule> histogram_rows_misfit(int rows, const FamilyOptions& options);

}  // namespace tofsmith
