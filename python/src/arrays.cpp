// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"

#include <limits>
#include <stdexcept>

namespace tofsmith::python {

namespace {

using Stride = py::ssize_t;
constexpr Stride double_bytes = sizeof(double);

template <typename Dense>
py::capsule keep(Dense* dense) {
  return py::capsule(dense, [](void* p) { delete static_cast<Dense*>(p); });
}

}  // namespace

py::array_t<double> adopt(Eigen::MatrixXd&& matrix) {
  auto* const owner = new Eigen::MatrixXd(std::move(matrix));
  const py::capsule free = keep(owner);
  return py::array_t<double>({owner->rows(), owner->cols()},
                             {double_bytes, double_bytes * owner->rows()}, owner->data(), free);
}

py::array_t<double> adopt(Eigen::VectorXd&& vector) {
  auto* const owner = new Eigen::VectorXd(std::move(vector));
  const py::capsule free = keep(owner);
  return py::array_t<double>(owner->size(), owner->data(), free);
}

py::array_t<float> adopt(Image<float>&& image) {
  const Stride height = image.height, width = image.width;
  return adopt(std::move(image.pixels), {height, width});
}

Eigen::VectorXd to_vector(const Doubles& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), values.size());
}

Eigen::MatrixXd to_matrix(const Doubles& values, const char* argument) {
  if (values.ndim() != 2) refuse(argument, "shape " + shape_of(values), "two axes");
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(values.data(), values.shape(0), values.shape(1));
}

Image<float> to_image(const py::object& values, const char* argument) {
  if (values.is_none()) return {};
  const auto floats = Floats::ensure(values);
  if (!floats) throw py::error_already_set();
  if (floats.ndim() != 2) refuse(argument, "shape " + shape_of(floats), "(H, W)");
  constexpr Stride most = std::numeric_limits<int>::max();
  if (floats.shape(0) > most || floats.shape(1) > most)
    refuse(argument, "shape " + shape_of(floats), "at most 2^31 - 1 rows and columns");
  Image<float> image;
  image.height = static_cast<int>(floats.shape(0));
  image.width = static_cast<int>(floats.shape(1));
  image.pixels.assign(floats.data(), floats.data() + floats.size());
  return image;
}

Image<float> taken_image(const py::dict& options, const char* name) {
  return to_image(options.attr("pop")(name, py::none()), name);
}

RawFrames to_raw_frames(const py::object& values, const char* argument) {
  RawFrames raw;
  if (values.is_none()) return raw;
  const auto floats = Floats::ensure(values);
  if (!floats) throw py::error_already_set();
  if (floats.ndim() != 4) refuse(argument, "shape " + shape_of(floats), "(F, H, W, K)");
  int* const sizes[] = {&raw.frames, &raw.height, &raw.width, &raw.measurements};
  for (Stride axis = 0; axis < 4; ++axis) {
    if (floats.shape(axis) > std::numeric_limits<int>::max())
      refuse(argument, "shape " + shape_of(floats), "at most 2^31 - 1 along every axis");
    *sizes[axis] = static_cast<int>(floats.shape(axis));
  }
  raw.values.assign(floats.data(), floats.data() + floats.size());
  return raw;
}

py::array_t<float> adopt(RawFrames&& raw) {
  return adopt(std::move(raw.values), {raw.frames, raw.height, raw.width, raw.measurements});
}

std::string shape_of(const py::array& array) {
  std::string text = "(";
  for (Stride axis = 0; axis < array.ndim(); ++axis) {
    text += std::to_string(array.shape(axis));
    if (axis + 1 < array.ndim()) text += ", ";
  }
  if (array.ndim() == 1) text += ",";
  text += ")";
  return text;
}

void refuse(const std::string& argument, const std::string& got, const std::string& needs) {
  std::string text = argument;
  text += ": got ";
  text += got;
  text += "; needs ";
  text += needs;
  throw std::invalid_argument(text);
}

}  // namespace tofsmith::python
