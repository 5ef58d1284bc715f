// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

SceneImage scene_of(const py::dict& planes) {
  const Image<float> depth_m = to_image(planes["depth_m"], "depth_m");
  const auto shape = [](const Image<float>& plane) {
    return fmt::format("shape ({}, {})", plane.height, plane.width);
  };
  if (depth_m.empty()) refuse("depth_m", shape(depth_m), "(H, W) with at least one pixel");
  SceneImage scene(depth_m.height, depth_m.width);
  scene.depth_m = depth_m;
  const auto take = [&](const char* name, Image<float>& plane) {
    const py::object values = planes[name];
    if (values.is_none()) return;
    plane = to_image(values, name);
    if (plane.height != depth_m.height || plane.width != depth_m.width)
      refuse(name, shape(plane), shape(depth_m) + " as of depth_m");
  };
  take("albedo", scene.albedo);
  take("cosine", scene.cosine);
  take("ambient_scale", scene.ambient_scale);
  scene.validate();
  return scene;
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

std::string shape_of(const py::array& array) { return py::str(array.attr("shape")); }

void refuse(const std::string& argument, const std::string& got, const std::string& needs) {
  throw std::invalid_argument(fmt::format("{}: got {}; needs {}", argument, got, needs));
}

namespace {

using Data = decltype(RawView::data);

/// Returns a typed pointer to the first number.
Data data_of(const py::array& array, py::ssize_t offset_bytes) {
  const auto* const begin = static_cast<const char*>(array.data()) + offset_bytes;
  const py::dtype type = array.dtype();
  const bool is_native = py::cast<bool>(type.attr("isnative"));
  const auto as = [begin](auto* of_type) { return reinterpret_cast<decltype(of_type)>(begin); };
  if (is_native && type.kind() == 'f' && type.itemsize() == 4)
    return as(static_cast<const float*>(nullptr));
  if (is_native && type.kind() == 'f' && type.itemsize() == 8)
    return as(static_cast<const double*>(nullptr));
  if (is_native && type.kind() == 'u' && type.itemsize() == 2)
    return as(static_cast<const std::uint16_t*>(nullptr));
  if (type.kind() == 'u' && type.itemsize() == 1)
    return as(static_cast<const std::uint8_t*>(nullptr));
  refuse("raw", "dtype " + std::string(py::str(static_cast<py::handle>(type))),
         "float32, float64, uint16 or uint8 in this machine's byte order");
}

/// Returns the distance between items of an axis, in elements.
std::ptrdiff_t stride_of(const py::array& array, py::ssize_t axis) {
  const py::ssize_t bytes = array.strides(axis), item = array.itemsize();
  if (bytes % item != 0)
    refuse("raw",
           "a stride of " + std::to_string(bytes) + " bytes along axis " + std::to_string(axis),
           "a multiple of the " + std::to_string(item) +
               " bytes of an item; np.ascontiguousarray "
               "makes one");
  return bytes / item;
}

int size_of(const py::array& array, py::ssize_t axis) {
  const py::ssize_t size = array.shape(axis);
  if (size < 1 || size > std::numeric_limits<int>::max())
    refuse("raw", "shape " + shape_of(array), "from 1 to 2^31 - 1 along every axis");
  return static_cast<int>(size);
}

std::string measurements_needed(const py::array& array, bool is_planar, int found, int needed) {
  std::string text =
      std::to_string(needed) + " measurements as of the code, not " + std::to_string(found);
  const py::ssize_t other = is_planar ? array.ndim() - 1 : array.ndim() - 3;
  if (array.shape(other) == needed)
    text += is_planar ? "; layout='interleaved' would fit" : "; layout='planar' would fit";
  return text;
}

void set_averaged(RawArray& raw, const Floats& averaged) {
  const std::vector<py::ssize_t> shape = raw.plane_shape();
  if (std::vector<py::ssize_t>(averaged.shape(), averaged.shape() + averaged.ndim()) != shape)
    refuse("averaged", "shape " + shape_of(averaged),
           "shape " + std::string(py::str(py::tuple(py::cast(shape)))));
  const float* const first = averaged.data();
  const auto is_count = [](float n) { return n > 0.0f && std::isfinite(n); };
  if (const float* const bad = std::find_if_not(first, first + averaged.size(), is_count);
      bad != first + averaged.size())
    refuse("averaged", fmt::format("{}", *bad), "finite numbers > 0");
  for (std::size_t f = 0; f < raw.frames.size(); ++f)
    raw.frames[f].averaged = first + static_cast<std::ptrdiff_t>(f) * raw.frames[f].pixels();
  raw.averaged = averaged;
}

}  // namespace

std::vector<py::ssize_t> RawArray::plane_shape() const {
  if (!is_stack) return {height, width};
  return {static_cast<py::ssize_t>(frames.size()), height, width};
}

RawArray view_raw(const py::array& array, bool is_planar, int needed, const py::object& averaged) {
  const py::ssize_t axes = array.ndim();
  const char* const shapes = is_planar ? "(K, H, W) or (F, K, H, W)" : "(H, W, K) or (F, H, W, K)";
  if (axes != 3 && axes != 4) refuse("raw", "shape " + shape_of(array), shapes);
  const py::ssize_t first = axes - 3;
  const py::ssize_t k_axis = is_planar ? first : first + 2;
  const py::ssize_t row_axis = is_planar ? first + 1 : first;
  RawView view;
  view.height = size_of(array, row_axis);
  view.width = size_of(array, row_axis + 1);
  view.measurements = size_of(array, k_axis);
  view.row_stride = stride_of(array, row_axis);
  view.column_stride = stride_of(array, row_axis + 1);
  view.measurement_stride = stride_of(array, k_axis);
  if (view.measurements != needed)
    refuse("raw", "shape " + shape_of(array),
           measurements_needed(array, is_planar, view.measurements, needed));
  RawArray raw{.is_stack = axes == 4, .height = view.height, .width = view.width};
  const int frames = raw.is_stack ? size_of(array, 0) : 1;
  if (raw.is_stack) static_cast<void>(stride_of(array, 0));
  for (int f = 0; f < frames; ++f) {
    view.data = data_of(array, raw.is_stack ? f * array.strides(0) : 0);
    raw.frames.push_back(view);
  }
  if (!averaged.is_none()) set_averaged(raw, Floats::ensure(averaged));
  return raw;
}

}  // namespace tofsmith::python
