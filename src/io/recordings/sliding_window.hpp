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

/// The last exposures of a recording, one of each kind that the code has, in the code's order.
class SlidingWindow {
 public:
  /// @param exposures  of a frame
  explicit SlidingWindow(int exposures) : exposures_(exposures) {}

  /// Replaces one exposure of the window by that of a frame, which must have the size and the type
  /// of the frames before it. All exposures of the first frame must be taken before view().
  void take(const RawView& frame, int exposure);
  /// Returns the numbers of the window, valid until the next take().
  RawView view() const;

 private:
  int exposures_;
  RawView newest_;  // frame; its numbers are not used
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint16_t>,
               std::vector<std::uint8_t>>
      numbers_;
};

}  // namespace tofsmith
