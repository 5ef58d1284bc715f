// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <half.h>

#include <cstdint>

namespace tofsmith {

inline float float_of_half(std::uint16_t bits) { return half(half::FromBits, bits); }

}  // namespace tofsmith
