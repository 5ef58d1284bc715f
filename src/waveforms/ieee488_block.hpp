// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace tofsmith {

/// '#', number of digits, length, data (IEEE 488.2).
/// @throws std::invalid_argument beyond 999999999 bytes
std::vector<std::byte> ieee488_block(std::span<const std::byte> data);

}  // namespace tofsmith
