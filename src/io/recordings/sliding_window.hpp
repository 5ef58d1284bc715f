// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "tofsmith/core/image.hpp"

namespace tofsmith {

/// Number of windows of `exposures` consecutive exposures in a recording of whole frames.
constexpr int windows_of(int frames, int exposures) { return (frames - 1) * exposures + 1; }

/// Latest recording of each exposure of a code, in the order of the code.
class SlidingWindow {
 public:
  explicit SlidingWindow(int exposures) : exposures_(exposures) {}

  /// Replaces one exposure. All frames must have the same size and type. All exposures must have
  /// been taken before view().
  void take(const RawView& frame, int exposure);
  /// Valid until the next take().
  RawView view() const;

 private:
  int exposures_;
  RawView newest_;  // frame; its numbers are not used
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint16_t>,
               std::vector<std::uint8_t>>
      numbers_;
};

}  // namespace tofsmith
