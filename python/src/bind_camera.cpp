// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include <cmath>

#include "arrays.hpp"
#include "bindings.hpp"
#include "options.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith::python {

void bind_camera(py::module_& module) {
  using Texts = std::vector<std::string>;
  py::class_<Camera>(module, "Camera")
      .def_static("load", [](const std::string& name,
                             const Texts& settings) { return load_camera(name, settings); })
      .def_static("parse",
                  [](const std::string& toml, const std::string& source, const Texts& settings) {
                    return parse_camera_toml(toml, source, settings);
                  })
      .def("with_settings", [](const Camera& camera,
                               const Texts& settings) { return with_settings(camera, settings); })
      .def("to_toml", [](const Camera& camera) { return camera_to_toml(camera); })
      .def("to_json", [](const Camera& camera) { return camera_to_json(camera); })
      .def("at_distances",
           [](const Camera& camera, const std::vector<double>& distances_m, double albedo,
              std::optional<double> klux) {
             return at_distances(camera, distances_m, albedo, klux);
           })
      .def("range_m", &Camera::range_m)
      .def("bin_m", &Camera::bin_m)
      .def("transfer",
           [](const Camera& camera, int highest) {
             if (highest < 0 || highest > 1'000'000)
               refuse("highest", std::to_string(highest), "a harmonic from 0 to 1000000");
             const Eigen::VectorXcd transfer = camera.transfer(highest);
             return adopt(std::vector<std::complex<double>>(transfer.begin(), transfer.end()));
           })
      .def("write", [](const Camera& camera, const std::string& path,
                       bool overwrite) { write_camera_toml(path, camera, policy_of(overwrite)); })
      .def("is_equal", [](const Camera& a, const Camera& b) { return a == b; });
  module.def("camera_keys", &camera_keys);
  module.def("built_in_camera_names", &built_in_camera_names);
}

namespace {

/// One row per depth.
template <typename OfDepth>
py::array_t<double> rows_by_depth(const ForwardModel& model, const Doubles& depth_bin,
                                  OfDepth of_depth) {
  for (py::ssize_t i = 0; i < depth_bin.size(); ++i)
    if (!std::isfinite(depth_bin.data()[i]))
      refuse("depth_bin",
             fmt::format("{:f}", depth_bin.data()[i]) + " at index " + std::to_string(i),
             "finite numbers");
  Eigen::MatrixXd rows(depth_bin.size(), model.measurements());
  for (py::ssize_t i = 0; i < depth_bin.size(); ++i)
    rows.row(i) = of_depth(depth_bin.data()[i]).transpose();
  return adopt(std::move(rows));
}

void check_light(double signal_e_per_s, double ambient_e_per_s) {
  if (!(std::isfinite(signal_e_per_s) && signal_e_per_s >= 0.0))
    refuse("signal_e_per_s", fmt::format("{:f}", signal_e_per_s), "a finite number >= 0");
  if (!(std::isfinite(ambient_e_per_s) && ambient_e_per_s >= 0.0))
    refuse("ambient_e_per_s", fmt::format("{}", ambient_e_per_s), "a finite number >= 0");
}

/// @tparam moment  member of ForwardModel: a vector of the measurements of returns
template <auto moment>
py::array_t<double> moments(const ForwardModel& model, const Doubles& depth_bin, double signal,
                            double ambient) {
  check_light(signal, ambient);
  return rows_by_depth(model, depth_bin, [&](double depth) {
    const Return seen{signal, depth};
    return (model.*moment)({&seen, 1}, ambient);
  });
}

py::array_t<double> covariance(const ForwardModel& model, double depth_bin, double signal,
                               double ambient) {
  check_light(signal, ambient);
  const Return seen{signal, depth_bin};
  return adopt(model.covariance_e2({&seen, 1}, ambient));
}

py::array_t<double> table(const ForwardModel& model, int points) {
  if (points < 1 || points > 10'000'000)
    refuse("points", std::to_string(points), "a whole number from 1 to 10000000");
  return adopt(model.correlation_table(points));
}

}  // namespace

void bind_forward_model(py::module_& module) {
  py::class_<ForwardModel>(module, "ForwardModel")
      .def(py::init<const CodeSet&, const Camera&>())
      .def("measurements", &ForwardModel::measurements)
      .def("tap_values", &ForwardModel::tap_values)
      .def("samples", &ForwardModel::samples)
      .def("correlation",
           [](const ForwardModel& model, const Doubles& depth_bin) {
             return rows_by_depth(model, depth_bin,
                                  [&](double depth) { return model.correlation(depth); });
           })
      .def("correlation_table", &table)
      .def("ambient_gain",
           [](const ForwardModel& m) { return adopt(Eigen::VectorXd(m.ambient_gain())); })
      .def("exposure_s",
           [](const ForwardModel& m) { return adopt(Eigen::VectorXd(m.exposure_s())); })
      .def("dark_electrons", [](const ForwardModel& m) { return adopt(m.dark_electrons()); })
      .def("constant_variance_e2",
           [](const ForwardModel& m) { return adopt(m.constant_variance_e2()); })
      .def("expected_electrons", &moments<&ForwardModel::expected_electrons>)
      .def("variance_e2", &moments<&ForwardModel::variance_e2>)
      .def("covariance_e2", &covariance);
}

}  // namespace tofsmith::python
