// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/shared/random.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

using FileBytes = std::vector<std::byte>;
using FileParser = std::function<void(std::span<const std::byte>)>;

inline FileBytes bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// Returns the message of the IoError that `action` must throw.
inline std::string io_error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const IoError& error) {
    return error.what();
  }
  ADD_FAILURE() << "expected an IoError";
  return {};
}

/// Expects an IoError for every proper prefix of the file.
inline void expect_truncations_refused(const FileBytes& whole, const FileParser& parse) {
  for (std::size_t length = 0; length < whole.size(); ++length) {
    // A copy of exactly this length lets the address sanitizer detect reads past the end.
    const FileBytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_THROW(parse(part), IoError) << "cut after " << length << " bytes";
  }
}

/// Replaces, removes or inserts some bytes.
inline FileBytes damaged(FileBytes bytes, RandomStream& random) {
  const int wounds = 1 + static_cast<int>(random() % 6);
  for (int i = 0; i < wounds && !bytes.empty(); ++i) {
    const std::size_t at = random() % bytes.size();
    const auto where = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    constexpr std::byte telling[] = {std::byte{0}, std::byte{0xff}, std::byte{0x7f}, std::byte{'9'},
                                     std::byte{'\n'}};
    switch (random() % 6) {
      case 0:
        *where ^= static_cast<std::byte>(1u << (random() % 8));
        break;
      case 1:
        *where = static_cast<std::byte>(random());
        break;
      case 2:
        *where = telling[random() % std::size(telling)];
        break;
      case 3:
        bytes.insert(where, static_cast<std::byte>(random()));
        break;
      case 4:
        bytes.erase(where);
        break;
      default:  // four consecutive bytes, like a length or a size
        std::fill(where, where + std::min<std::ptrdiff_t>(4, bytes.end() - where),
                  telling[random() % std::size(telling)]);
    }
  }
  return bytes;
}

/// Expects that each of `count` damaged copies is read, or rejected with IoError or
/// std::invalid_argument; returns the number of rejected copies.
inline int expect_damage_read_or_refused(const FileBytes& whole, int count, std::uint64_t seed,
                                         const FileParser& parse) {
  int refused = 0;
  for (int i = 0; i < count; ++i) {
    RandomStream random(seed, static_cast<std::uint64_t>(i));
    const FileBytes copy = damaged(whole, random);
    try {
      parse(copy);
    } catch (const IoError&) {
      ++refused;
    } catch (const std::invalid_argument&) {
      ++refused;
    } catch (const std::exception& error) {
      ADD_FAILURE() << "copy " << i << " of seed " << seed << ": " << error.what();
    }
  }
  return refused;
}

}  // namespace tofsmith
