// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Returns the first positions of all distinct keys, sorted by key as in the store.
std::vector<std::int64_t> key_order(std::span<const std::string> keys);

/// Returns the first 16 hexadecimal digits.
std::uint64_t key_number(std::string_view key);

}  // namespace tofsmith
