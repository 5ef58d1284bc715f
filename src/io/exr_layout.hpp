// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace tofsmith {

/// Walks over the header of an OpenEXR file before the OpenEXR library sees it, because the library
/// takes memory for whatever sizes a damaged header claims.
/// @throws IoError at a byte offset if the file is not what parse_exr() reads
void check_exr_layout(std::span<const std::byte> content, std::string_view file);

}  // namespace tofsmith
