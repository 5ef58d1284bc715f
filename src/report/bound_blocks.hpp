// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report/error_sections.hpp"

namespace tofsmith {

/// How far the codes are from the bounds: a table of all three, and maps of how many times as large
/// as the receiver bound (without impulse responses, the Cramer-Rao bound) the circular error is.
/// @param order  of the codes, best first
std::vector<Block> bound_blocks(const Camera& camera, std::span<const DepthErrorRow> codes,
                                const std::vector<std::size_t>& order);

}  // namespace tofsmith
