// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/ieee488_block.hpp"

#include <fmt/format.h>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

std::vector<std::byte> ieee488_block(std::span<const std::byte> data) {
  require(data.size() <= 999'999'999, "block bytes", data.size(), "must be <= 999999999");
  const std::string length = fmt::format("{}", data.size());
  const std::string header = fmt::format("#{}{}", length.size(), length);
  const auto begin = std::as_bytes(std::span(header));
  std::vector<std::byte> block(begin.begin(), begin.end());
  block.insert(block.end(), data.begin(), data.end());
  return block;
}

}  // namespace tofsmith
