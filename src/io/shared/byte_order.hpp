// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace tofsmith {

inline constexpr bool host_is_little_endian = std::endian::native == std::endian::little;

void swap_byte_order(std::span<std::byte> bytes, std::size_t item_size);

template <typename Value>
Value load_little_endian(const std::byte* from) {
  std::byte raw[sizeof(Value)];
  std::memcpy(raw, from, sizeof(Value));
  if constexpr (!host_is_little_endian) swap_byte_order(raw, sizeof(Value));
  Value value;
  std::memcpy(&value, raw, sizeof(Value));
  return value;
}

template <typename Value>
void store_little_endian(Value value, std::byte* to) {
  std::memcpy(to, &value, sizeof(Value));
  if constexpr (!host_is_little_endian) swap_byte_order({to, sizeof(Value)}, sizeof(Value));
}

}  // namespace tofsmith
