// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// Prefix of the arrays of a depth correction: correction_height, correction_known_field_m.
inline constexpr std::string_view correction_prefix = "correction_";

/// Adds one array per field of the correction.
void add_correction(const DepthCorrection& correction, NpzArrays& arrays);

/// Reads the depth correction of an archive; none if it has none.
/// @throws IoError naming file and array if it is missing, invalid or of another shape
std::optional<DepthCorrection> correction_of(const NpzReader& archive, const std::string& file);

}  // namespace tofsmith
