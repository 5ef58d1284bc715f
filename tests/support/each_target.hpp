// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "tofsmith/core/build_info.hpp"

namespace tofsmith {

/// Runs `body(target)` or `body()` for every instruction set that both the machine and the library
/// support.
template <typename Body>
void for_each_target(const Body& body) {
  const std::vector<std::string> with_kernels = dispatch_targets();
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (std::ranges::find(with_kernels, hwy::TargetName(target)) == with_kernels.end()) continue;
    hwy::SetSupportedTargetsForTest(target);
    SCOPED_TRACE(hwy::TargetName(target));
    if constexpr (std::is_invocable_v<Body, std::int64_t>)
      body(target);
    else
      body();
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace tofsmith
