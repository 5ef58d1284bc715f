// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/build_info.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>

#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower_case(x) == lower_case(y); });
}

}  // namespace

std::vector<std::string> dispatch_targets() {
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    names.emplace_back(hwy::TargetName(target));
  return names;
}

std::string dispatch_target() { return dispatch_targets().front(); }

void pin_dispatch_target(std::string_view name) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (!same_word(name, hwy::TargetName(target))) continue;
    hwy::DisableTargets(~target);
    return;
  }
  reject("dispatch target", name, fmt::format("must be {}", fmt::join(dispatch_targets(), ", ")));
}

}  // namespace tofsmith
