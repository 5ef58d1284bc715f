// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <type_traits>

namespace tofsmith {

/// Runs `body(target)` or `body()` once for every instruction set this machine offers.
template <typename Body>
void for_each_target(const Body& body) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
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
