// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Returns bytes as a definite-length block of IEEE 488.2: '#', number of digits, length, data.
/// @throws std::invalid_argument beyond 999999999 bytes
std::vector<std::byte> ieee488_block(std::span<const std::byte> data);

}  // namespace tofsmith
