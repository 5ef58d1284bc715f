// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tofsmith {

/// 64-bit FNV-1a, identical on all machines and in all versions; not cryptographically secure.
constexpr std::uint64_t fnv1a_64(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ull;
  }
  return hash;
}

/// 128-bit FNV-1a as 32 hexadecimal digits, for large sets of keys in which 64 bits could collide.
/// Identical on all machines and in all versions.
std::string fnv1a_128_hex(std::string_view text);

}  // namespace tofsmith
