// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Bytes as a definite-length block of IEEE 488.2: '#', the number of digits, the length, the data.
/// @throws std::invalid_argument beyond 999999999 bytes
std::vector<std::byte> ieee488_block(std::span<const std::byte> data);

/// A block at the beginning of `bytes`.
struct Ieee488Block {
  std::span<const std::byte> data;
  std::size_t size = 0;  ///< of the whole block, with its header
};

/// @param place  what errors call it, such as a file
/// @throws IoError "place: byte N: .." if there is none, or less data than it says
Ieee488Block parse_ieee488_block(std::span<const std::byte> bytes, std::string_view place);

}  // namespace tofsmith
