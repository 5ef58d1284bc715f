// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace tofsmith {

/// How many returns a pixel shows. It stands beside PixelStatus, which says whether the depth of a
/// single return can be trusted: a pixel may be saturated and still be two returns.
enum class ReturnStatus : std::uint8_t {
  none = 0,        ///< no depth: invalid or no return at all
  single = 1,      ///< one return explains the pixel
  two = 2,         ///< a second return, or a tail, explains it better by more than the threshold
  unresolved = 3,  ///< one return does not explain it, and neither does a second: the depth is that
                   ///< of one return and may be biased
};

inline constexpr std::array all_return_statuses = {ReturnStatus::none, ReturnStatus::single,
                                                   ReturnStatus::two, ReturnStatus::unresolved};

/// "none", "single", "two", "unresolved".
std::string_view name_of(ReturnStatus status);

}  // namespace tofsmith
