// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "arrays.hpp"
#include "tofsmith/core/image.hpp"

namespace tofsmith::python {

/// A view of the frames of a raw array with any strides. Nothing is copied.
struct RawArray {
  std::vector<RawView> frames;
  bool is_stack = false;  ///< has an axis of frames
  int height = 0;
  int width = 0;

  /// (H, W) or (F, H, W).
  std::vector<py::ssize_t> plane_shape() const;
  /// Sets the number of measurements averaged in each pixel.
  /// @param averaged  of plane_shape(), each > 0; must outlive the frames
  /// @throws std::invalid_argument for another shape or numbers that are not > 0
  void set_averaged(const Floats& averaged);
};

/// @param array   float32, float64, uint16 or uint8; shape (H, W, K) or (F, H, W, K), or planar
///                (K, H, W) or (F, K, H, W)
/// @param needed  K of the decoder
/// @throws std::invalid_argument for any other type or shape
RawArray view_raw(const py::array& array, bool is_planar, int needed);

}  // namespace tofsmith::python
