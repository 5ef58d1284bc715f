// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// cmake/TofsmithBuildInfo.cmake defines TOFSMITH_BUILD_... for this file.
#include "tofsmith/core/build_info.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hwy/targets.h>

#include <bit>

#include "core/build_commit.hpp"
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

}  // namespace tofsmith
