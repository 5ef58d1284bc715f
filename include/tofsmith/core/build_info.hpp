// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Version, build options and instruction sets, for bug reports. Results do not depend on this;
/// result files contain only the version.
struct BuildInfo {
  std::string version;                ///< "0.1.0"
  std::string commit;                 ///< 12 digits, "+dirty" after local changes; or "unknown"
  std::string compiler;               ///< "GNU 12.2.0"
  std::string build_type;             ///< "Release"
  std::string library;                ///< "shared" or "static"
  std::vector<std::string> targets;   ///< instruction sets with dedicated kernels, best first
  std::vector<std::string> features;  ///< optional features of this build: "TBB", "FFTW"
};

BuildInfo build_info();

/// Four lines, starting with "tofsmith 0.1.0 (commit 0123456789ab)".
std::string to_text(const BuildInfo& info);

/// Instruction set of the vector code in this process, e.g. "AVX2". Results have the same bits
/// wherever it is the same; otherwise sums may be rounded differently.
std::string dispatch_target();

/// Instruction sets that both this machine and the library support, best first.
std::vector<std::string> dispatch_targets();

/// Selects the instruction set of vector code in this process. Call it before any other work.
/// @throws std::invalid_argument unless `name` is one of dispatch_targets(), case-insensitive
void pin_dispatch_target(std::string_view name);

}  // namespace tofsmith
