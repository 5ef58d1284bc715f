// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace tofsmith {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool with_sanitizers = true;
#else
inline constexpr bool with_sanitizers = false;
#endif

/// Number of repetitions of a long test: an eighth of `all` with sanitizers, which are about ten
/// times slower.
template <typename Count>
constexpr Count repetitions(Count all) {
  return with_sanitizers ? std::max(Count{1}, all / 8) : all;
}

}  // namespace tofsmith
