// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "decode/ambient_projection.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

enum class MultipathKind;

/// How measurements fall short of what is unknown: depth, signal, ambient light, and delay and
/// strength of a second return (5; a tail of known delay: 4), and one more to judge the fit by.
/// Says how many independent means there are, how many are needed and what would do; none: they
/// are enough.
std::optional<BrokenRule> missing_support(const AmbientProjection& projection, MultipathKind later);

}  // namespace tofsmith
