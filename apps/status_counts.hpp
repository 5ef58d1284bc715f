// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "tofsmith/decode/pixel_status.hpp"

namespace tofsmith::apps {

/// How many pixels have which status.
class StatusCounts {
 public:
  void add(std::span<const PixelStatus> statuses);
  void add(const StatusCounts& other);
  std::int64_t of(PixelStatus status) const { return counts_[static_cast<std::size_t>(status)]; }
  std::int64_t pixels() const;
  /// "ok 76.10 %, low_signal 3.20 %, .."; "" without pixels.
  std::string text() const;

 private:
  std::array<std::int64_t, all_pixel_statuses.size()> counts_{};
};

}  // namespace tofsmith::apps
