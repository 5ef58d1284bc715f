// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Returns the positions of all distinct keys, sorted by key; the first position if a key is
/// repeated. This is the order of the store, so that it is accessed sequentially.
std::vector<std::int64_t> key_order(std::span<const std::string> keys);

/// Returns the first 16 hexadecimal digits of a key as a number.
std::uint64_t key_number(std::string_view key);

}  // namespace tofsmith
