// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// What names of a depth correction's arrays begin with: correction_height,
/// correction_known_field_m.
inline constexpr std::string_view correction_prefix = "correction_";

/// Adds an array for each field of the correction.
void add_correction(const DepthCorrection& correction, NpzArrays& arrays);

/// The correction that an archive holds; none: it holds none.
/// @throws IoError naming file and array for what is missing, of another shape, or invalid
std::optional<DepthCorrection> correction_of(const NpzReader& archive, const std::string& file);

}  // namespace tofsmith
