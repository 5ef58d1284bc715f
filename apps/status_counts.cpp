// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "status_counts.hpp"

#include <fmt/format.h>

#include <numeric>

namespace tofsmith::apps {

void StatusCounts::add(std::span<const PixelStatus> statuses) {
  for (const PixelStatus status : statuses) ++counts_[static_cast<std::size_t>(status)];
}

void StatusCounts::add(const StatusCounts& other) {
  for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
}

std::int64_t StatusCounts::pixels() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0});
}

std::string StatusCounts::text() const {
  const auto pixels = static_cast<double>(this->pixels());
  std::string text;
  for (const PixelStatus status : all_pixel_statuses) {
    const std::int64_t count = of(status);
    if (count > 0)
      text += fmt::format("{}{} {:.2f} %", text.empty() ? "" : ", ", name_of(status),
                          100.0 * static_cast<double>(count) / pixels);
  }
  return text;
}

}  // namespace tofsmith::apps
