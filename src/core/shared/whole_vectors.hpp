// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tofsmith {

constexpr int widest_vector = 16;  // floats, of any instruction set

/// The smallest multiple of `multiple` that is >= `count`.
constexpr int rounded_up(int count, int multiple) {
  return (count + multiple - 1) / multiple * multiple;
}

/// At least `count` floats that make up whole vectors of any width.
constexpr int whole_vectors(int count) { return rounded_up(count, widest_vector); }

/// Numbers as kernels read them.
inline std::vector<float> in_floats(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

}  // namespace tofsmith
