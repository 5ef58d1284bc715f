// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "tofsmith/core/image.hpp"

namespace tofsmith {

/// Calls use(number, length, done) for every run of pixels within a row: pointer to the first
/// number, number of pixels, and number of pixels before. Pixels of a run are column_stride apart,
/// their measurements measurement_stride.
template <typename Use>
void for_each_run(const RawView& view, std::int64_t first, std::int64_t count, const Use& use) {
  std::visit(
      [&](const auto* data) {
        std::int64_t row = first / view.width, column = first % view.width;
        for (std::int64_t done = 0; done < count; ++row, column = 0) {
          const std::int64_t length = std::min(count - done, view.width - column);
          use(data + row * view.row_stride + column * view.column_stride, length, done);
          done += length;
        }
      },
      view.data);
}

}  // namespace tofsmith
