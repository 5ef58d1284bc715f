// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace tofsmith {

using TiffBytes = std::vector<std::byte>;

/// Compresses bytes by LZW as defined in the TIFF 6.0 specification.
inline TiffBytes pack_lzw(const TiffBytes& bytes) {
  TiffBytes packed;
  std::uint32_t held = 0;
  int held_bits = 0, width = 9;
  const auto put = [&](int code) {
    held = held << width | static_cast<std::uint32_t>(code);
    for (held_bits += width; held_bits >= 8; held_bits -= 8)
      packed.push_back(static_cast<std::byte>(held >> (held_bits - 8)));
  };
  std::map<TiffBytes, int> table;
  const auto clear = [&] {
    put(256);
    table.clear();
    for (int i = 0; i < 256; ++i) table[{static_cast<std::byte>(i)}] = i;
    width = 9;
  };
  clear();
  int next = 258;
  TiffBytes string;
  for (const std::byte byte : bytes) {
    TiffBytes longer = string;
    longer.push_back(byte);
    if (table.contains(longer)) {
      string = longer;
      continue;
    }
    put(table.at(string));
    table[longer] = next++;
    if (next == 512 || next == 1024 || next == 2048) ++width;
    if (next == 4095) {
      clear();
      next = 258;
    }
    string = {byte};
  }
  if (!string.empty()) put(table.at(string));
  put(257);
  if (held_bits > 0) packed.push_back(static_cast<std::byte>(held << (8 - held_bits)));
  return packed;
}

struct TiffWriter {
  bool big_endian = false;
  std::vector<std::pair<int, std::vector<std::uint32_t>>> tags;  ///< in ascending order
  std::vector<TiffBytes> blocks;                                 ///< strips or tiles
  std::uint32_t next_page = 0;

  /// @param offsets, counts  tags of the offsets and byte counts of the blocks
  TiffBytes file(int offsets = 273, int counts = 279) const {
    TiffBytes bytes;
    const auto put = [&](std::uint32_t number, int size) {
      for (int i = 0; i < size; ++i)
        bytes.push_back(static_cast<std::byte>(number >> 8 * (big_endian ? size - 1 - i : i)));
    };
    std::map<int, std::vector<std::uint32_t>> all(tags.begin(), tags.end());
    std::uint32_t at = 8;
    for (const TiffBytes& block : blocks) {
      all[offsets].push_back(at);
      all[counts].push_back(static_cast<std::uint32_t>(block.size()));
      at += static_cast<std::uint32_t>(block.size());
    }
    put(big_endian ? 0x4d4d : 0x4949, 2);
    put(42, 2);
    put(at, 4);
    for (const TiffBytes& block : blocks) bytes.insert(bytes.end(), block.begin(), block.end());
    put(static_cast<std::uint32_t>(all.size()), 2);
    std::uint32_t lists = at + 2 + 12 * static_cast<std::uint32_t>(all.size()) + 4;
    for (const auto& [tag, values] : all) {
      put(static_cast<std::uint32_t>(tag), 2);
      put(4, 2);
      put(static_cast<std::uint32_t>(values.size()), 4);
      put(values.size() == 1 ? values.front() : lists, 4);
      if (values.size() > 1) lists += 4 * static_cast<std::uint32_t>(values.size());
    }
    put(next_page, 4);
    for (const auto& [tag, values] : all)
      if (values.size() > 1)
        for (const std::uint32_t value : values) put(value, 4);
    return bytes;
  }
};

}  // namespace tofsmith
