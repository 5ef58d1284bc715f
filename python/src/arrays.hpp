// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tofsmith/core/image.hpp"

namespace tofsmith::python {

namespace py = pybind11;

/// What arguments of any number type become: float64, C order; a copy only where they are not.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// A NumPy array that owns the values: nothing is copied.
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

/// (rows, columns), in Eigen's order of memory: nothing is copied.
py::array_t<double> adopt(Eigen::MatrixXd&& matrix);
py::array_t<double> adopt(Eigen::VectorXd&& vector);
/// (H, W); shape (0, 0) of an empty image.
py::array_t<float> adopt(Image<float>&& image);

Eigen::VectorXd to_vector(const Doubles& values);
/// @throws std::invalid_argument naming the argument unless it has two axes
Eigen::MatrixXd to_matrix(const Doubles& values, const char* argument);
/// An image of shape (H, W); None is an empty one.
/// @throws std::invalid_argument naming the argument unless it has two axes
Image<float> to_image(const py::object& values, const char* argument);
/// The same out of a dict of options, where it stands no more; empty if it does not.
Image<float> taken_image(const py::dict& options, const char* name);

/// Frames of shape (F, H, W, K); None is none of them.
/// @throws std::invalid_argument naming the argument unless it has four axes
RawFrames to_raw_frames(const py::object& values, const char* argument);
/// (F, H, W, K): nothing is copied.
py::array_t<float> adopt(RawFrames&& raw);

/// As Python writes it: "(480, 640, 4)".
std::string shape_of(const py::array& array);

/// Throws std::invalid_argument "`argument`: got `got`; needs `needs`".
[[noreturn]] void refuse(const std::string& argument, const std::string& got,
                         const std::string& needs);

}  // namespace tofsmith::python
