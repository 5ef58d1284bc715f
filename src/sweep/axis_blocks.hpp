// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

/// Axes with a common index.
using AxisDigit = std::vector<std::size_t>;

/// Digits form a number whose last digit varies fastest.
struct AxisBlock {
  std::vector<AxisDigit> digits;
  std::int64_t size = 1;  ///< at most 2^62
};

/// Blocks within a list advance together; the lists form a product whose last one varies fastest.
std::vector<std::vector<AxisBlock>> axis_blocks(const SweepSpec& spec);

/// Returns "axis samples" or "group optics", for errors.
std::string name_of(const SweepSpec& spec, const AxisBlock& block);

}  // namespace tofsmith
