// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith::python {

namespace py = pybind11;

/// Arguments of any number type, converted to float64 in C order; copied only if necessary.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// Returns a NumPy array that owns the values. Nothing is copied.
template <typename Value>
py::array_t<Value> adopt(std::vector<Value>&& values, std::vector<py::ssize_t> shape) {
  auto* const owner = new std::vector<Value>(std::move(values));
  const py::capsule free(owner, [](void* p) { delete static_cast<std::vector<Value>*>(p); });
  return py::array_t<Value>(std::move(shape), owner->data(), free);
}

template <typename Value>
py::array_t<Value> adopt(std::vector<Value>&& values) {
  const auto size = static_cast<py::ssize_t>(values.size());
  return adopt(std::move(values), {size});
}

/// Returns an array (rows, columns) in Eigen's memory order. Nothing is copied.
py::array_t<double> adopt(Eigen::MatrixXd&& matrix);
py::array_t<double> adopt(Eigen::VectorXd&& vector);
/// Returns an array (H, W); shape (0, 0) for an empty image.
py::array_t<float> adopt(Image<float>&& image);

Eigen::VectorXd to_vector(const Doubles& values);
/// @throws std::invalid_argument naming the argument unless it has two axes
Eigen::MatrixXd to_matrix(const Doubles& values, const char* argument);
/// Converts an array (H, W) to an image; None to an empty image.
/// @throws std::invalid_argument naming the argument unless it has two axes
Image<float> to_image(const py::object& values, const char* argument);
/// Returns and removes an image from a dict of options; empty if there is none.
Image<float> taken_image(const py::dict& options, const char* name);

/// Creates a scene from its planes by name, each (H, W) or None.
/// @throws std::invalid_argument naming the invalid plane
SceneImage scene_of(const py::dict& planes);

/// Converts an array (F, H, W, K) to frames; None to no frames.
/// @throws std::invalid_argument naming the argument unless it has four axes
RawFrames to_raw_frames(const py::object& values, const char* argument);
/// Returns an array (F, H, W, K). Nothing is copied.
py::array_t<float> adopt(RawFrames&& raw);

/// Returns the shape in Python notation: "(480, 640, 4)".
std::string shape_of(const py::array& array);

/// Throws std::invalid_argument "`argument`: got `got`; needs `needs`".
[[noreturn]] void refuse(const std::string& argument, const std::string& got,
                         const std::string& needs);

/// A view of the frames of a raw array with any strides. Nothing is copied.
struct RawArray {
  std::vector<RawView> frames;
  bool is_stack = false;  ///< has an axis of frames
  int height = 0;
  int width = 0;
  Floats averaged = {};  ///< to which the frames refer; may be empty

  /// (H, W) or (F, H, W).
  std::vector<py::ssize_t> plane_shape() const;
};

/// @param array   float32, float64, uint16 or uint8; shape (H, W, K) or (F, H, W, K), or planar
///                (K, H, W) or (F, K, H, W)
/// @param needed  K of the decoder
/// @param averaged  number of measurements averaged in each pixel, of plane_shape(); None: one
/// @throws std::invalid_argument for any other type or shape, and for averages that are not > 0
RawArray view_raw(const py::array& array, bool is_planar, int needed,
                  const py::object& averaged = py::none());

}  // namespace tofsmith::python
