// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace tofsmith {

/// SHA-256 of some bytes as 64 hexadecimal digits, as `sha256sum` prints it.
/// @see FIPS 180-4
std::string sha256_hex(std::span<const std::byte> bytes);
std::string sha256_hex(std::string_view text);

}  // namespace tofsmith
