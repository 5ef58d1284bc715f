// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/ambient_projection.hpp"

namespace tofsmith {

enum class LaterLight;

/// Whether measurements are enough for what is unknown: depth, signal, ambient light, and delay and
/// strength of a second return (5; a tail of known delay: 4), and one more to judge the fit by.
/// @throws std::invalid_argument saying how many independent means there are, how many are needed
///         and what would do
void require_support(const AmbientProjection& projection, LaterLight later);

}  // namespace tofsmith
