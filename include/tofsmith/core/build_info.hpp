// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// What was built, how and from what: for reports of faults. Results do not depend on it, and no
/// file of results names more of it than the version.
struct BuildInfo {
  std::string version;                ///< "0.1.0"
  std::string commit;                 ///< 12 digits, with "+dirty" if files differ; or "unknown"
  std::string compiler;               ///< "GNU 12.2.0"
  std::string build_type;             ///< "Release"
  std::string library;                ///< "shared" or "static"
  std::vector<std::string> targets;   ///< instruction sets with kernels of their own, best first
  std::vector<std::string> features;  ///< optional ones of this build: "TBB", "FFTW"
};

BuildInfo build_info();

/// Four lines, of which the first is "tofsmith 0.1.0 (commit 0123456789ab)".
std::string to_text(const BuildInfo& info);

/// The instruction set that vector code runs on here, such as "AVX2". Results have the same bits
/// wherever this is the same; on another one, sums may be rounded differently.
std::string dispatch_target();

/// The instruction sets that this machine offers and the library has code for, best first.
std::vector<std::string> dispatch_targets();

/// From now on vector code of this process runs on `name`. Call it before any work starts.
/// @throws std::invalid_argument unless it is one of dispatch_targets(), in any case of letters
void pin_dispatch_target(std::string_view name);

}  // namespace tofsmith
