// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// Prefix of arrays such as correction_height.
inline constexpr std::string_view correction_prefix = "correction_";

void add_correction(const DepthCorrection& correction, NpzArrays& arrays);

/// Returns none if the archive has no depth correction.
/// @throws IoError naming file and array if it is missing, invalid or of another shape
std::optional<DepthCorrection> correction_of(const NpzReader& archive, const std::string& file);

}  // namespace tofsmith
