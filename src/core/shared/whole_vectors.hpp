// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tofsmith {

constexpr int widest_vector = 16;  // floats, over all instruction sets

/// Smallest multiple of `multiple` that is >= `count`.
constexpr int rounded_up(int count, int multiple) {
  return (count + multiple - 1) / multiple * multiple;
}

/// Rounds up to whole vectors of any width.
constexpr int whole_vectors(int count) { return rounded_up(count, widest_vector); }

inline std::vector<float> in_floats(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

}  // namespace tofsmith
