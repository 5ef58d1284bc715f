// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// The instruction set that vector code runs on here, such as "AVX2". Results have the same bits
/// wherever this is the same; on another one, sums may be rounded differently.
std::string dispatch_target();

/// The instruction sets that this machine offers and the library has code for, best first.
std::vector<std::string> dispatch_targets();

/// From now on vector code of this process runs on `name`. Call it before any work starts.
/// @throws std::invalid_argument unless it is one of dispatch_targets(), in any case of letters
void pin_dispatch_target(std::string_view name);

}  // namespace tofsmith
