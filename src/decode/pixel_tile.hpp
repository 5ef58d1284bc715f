// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith {

/// Pixels that are decoded together; their work space fits the first-level cache.
inline constexpr int pixels_per_tile = 256;

}  // namespace tofsmith
