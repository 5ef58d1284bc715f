// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/shared/byte_order.hpp"

#include <algorithm>

namespace tofsmith {

void swap_byte_order(std::span<std::byte> bytes, std::size_t item_size) {
  if (item_size < 2) return;
  for (auto item = bytes.begin(); item != bytes.end(); item += item_size)
    std::reverse(item, item + item_size);
}

}  // namespace tofsmith
