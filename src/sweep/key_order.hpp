// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// The places of all different keys, in the order of the keys; of equal ones the first place.
/// Whoever asks a store in this order reads it from its beginning to its end.
std::vector<std::int64_t> key_order(std::span<const std::string> keys);

/// The first 16 hexadecimal digits of a key as a number.
std::uint64_t key_number(std::string_view key);

}  // namespace tofsmith
