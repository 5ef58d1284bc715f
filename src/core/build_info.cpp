// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// cmake/TofsmithBuildInfo.cmake defines TOFSMITH_BUILD_... for this file.
#include "tofsmith/core/build_info.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>
#include <bit>

#include "core/build_commit.hpp"
#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

/// Better instruction sets have lower bits.
std::vector<std::string> compiled_targets() {
  std::vector<std::string> names;
  for (std::uint64_t left = HWY_TARGETS; left != 0; left &= left - 1)
    names.emplace_back(hwy::TargetName(std::int64_t{1} << std::countr_zero(left)));
  return names;
}

std::vector<std::string> compiled_features() {
  std::vector<std::string> names;
  if (TOFSMITH_BUILD_TBB) names.emplace_back("TBB");
  if (TOFSMITH_BUILD_FFTW) names.emplace_back("FFTW");
  return names;
}

}  // namespace

BuildInfo build_info() {
  return {.version = TOFSMITH_VERSION,
          .commit = build_commit,
          .compiler = TOFSMITH_BUILD_COMPILER,
          .build_type = TOFSMITH_BUILD_TYPE,
          .library = TOFSMITH_BUILD_SHARED ? "shared" : "static",
          .targets = compiled_targets(),
          .features = compiled_features()};
}

std::string to_text(const BuildInfo& info) {
  return fmt::format(
      "tofsmith {} (commit {})\nbuilt by {}, {}, {} library\nkernels for {}; this computer uses "
      "{}\nwith {}",
      info.version, info.commit, info.compiler, info.build_type, info.library,
      fmt::join(info.targets, " "), dispatch_target(),
      info.features.empty() ? "no optional features"
                            : fmt::format("{}", fmt::join(info.features, ", ")));
}

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
