// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "arrays.hpp"
#include "tofsmith/core/image.hpp"

namespace tofsmith::python {

/// The frames of a raw array where they are: nothing is copied, whatever the strides.
struct RawArray {
  std::vector<RawView> frames;
  bool is_stack = false;  ///< had an axis of frames
  int height = 0;
  int width = 0;

  /// (H, W) or (F, H, W).
  std::vector<py::ssize_t> plane_shape() const;
  /// Of how many measurements each number is the mean.
  /// @param averaged  of plane_shape(), each > 0; outlives the frames
  /// @throws std::invalid_argument for another shape or numbers that are not > 0
  void set_averaged(const Floats& averaged);
};

/// @param array   float32, float64, uint16 or uint8; shape (H, W, K) or (F, H, W, K), or planar
///                (K, H, W) or (F, K, H, W)
/// @param needed  K of the decoder
/// @throws std::invalid_argument for any other type or shape
RawArray view_raw(const py::array& array, bool is_planar, int needed);

}  // namespace tofsmith::python
