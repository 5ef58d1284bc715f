// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "output_policy.hpp"
#include "tofsmith/camera/camera.hpp"
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

}  // namespace tofsmith::python
