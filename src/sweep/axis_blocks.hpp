// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

/// Axes of one index: an axis with those linked to it, or all of a group that is zipped.
using AxisDigit = std::vector<std::size_t>;

/// An axis, or a group of axes, as it meets the others: its digits make a number, the last one
/// varies fastest.
struct AxisBlock {
  std::vector<AxisDigit> digits;
  std::int64_t size = 1;  ///< at most 2^62, beyond which it is not counted
};

/// Blocks by how they meet: those of one list advance together, lists make a product whose last one
/// varies fastest.
std::vector<std::vector<AxisBlock>> axis_blocks(const SweepSpec& spec);

/// a b, at most 2^62.
std::int64_t counted_product(std::int64_t a, std::int64_t b);

/// What errors call a block: "axis samples", "group optics".
std::string name_of(const SweepSpec& spec, const AxisBlock& block);

}  // namespace tofsmith
