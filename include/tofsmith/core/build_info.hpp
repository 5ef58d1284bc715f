// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Version, build options and instruction sets, for bug reports. Results do not depend on it.
struct BuildInfo {
  std::string version;
  std::string commit;  ///< 12 digits, "+dirty" after local changes; or "unknown"
  std::string compiler;
  std::string build_type;
  std::string library;
  std::vector<std::string> targets;   ///< instruction sets with dedicated kernels, best first
  std::vector<std::string> features;  ///< optional features: "TBB", "FFTW"
};

BuildInfo build_info();

std::string to_text(const BuildInfo& info);

/// Instruction set of the vector code in this process, e.g. "AVX2". With another one, sums may be
/// rounded differently.
std::string dispatch_target();

/// Instruction sets that both machine and library support, best first.
std::vector<std::string> dispatch_targets();

/// Selects the instruction set in this process. Must be called before any other work.
/// @throws InvalidArgument unless `name` is one of dispatch_targets(), case-insensitive
void pin_dispatch_target(std::string_view name);

}  // namespace tofsmith
