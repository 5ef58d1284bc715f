// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "reports.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith::python {

namespace {

DepthSampling parse_depth_sampling(const std::string& word) {
  if (word == "uniform") return DepthSampling::uniform;
  if (word == "bins") return DepthSampling::bins;
  refuse("depth", "'" + word + "'", "uniform or bins");
}

EvaluateOptions evaluate_options(const py::dict& values) {
  EvaluateOptions options;
  OptionReader(values, "")
      .value("trials", options.trials)
      .value("seed", options.seed)
      .value("outlier_threshold_m", options.outlier_threshold_m)
      .value("sub_bin", options.sub_bin)
      .word("depth", options.depth, parse_depth_sampling)
      .value("clip_to_open_sensor", options.clip_to_open_sensor)
      .word("method", options.method, parse_decode_method)
      .word("unwrap_weights", options.unwrap_weights, parse_unwrap_weights)
      .finish();
  options.validate();
  return options;
}

RobustnessOptions robustness_options(const py::dict& values) {
  RobustnessOptions options;
  OptionReader(values, "")
      .value("bandwidth", options.bandwidth)
      .value("peak", options.peak)
      .value("edge_jitter_s", options.edge_jitter_s)
      .value("tap_mismatch", options.tap_mismatch)
      .value("clock_s", options.clock_s)
      .value("droop", options.droop)
      .value("together", options.together)
      .value("trials", options.trials)
      .value("seed", options.seed)
      .word("method", options.method, parse_decode_method)
      .word("unwrap_weights", options.unwrap_weights, parse_unwrap_weights)
      .finish();
  options.validate();
  return options;
}

SceneImage scene_of(const py::dict& planes) {
  const Image<float> depth_m = to_image(planes["depth_m"], "depth_m");
  if (depth_m.empty())
    refuse("depth_m",
           "shape (" + std::to_string(depth_m.height) + ", " + std::to_string(depth_m.width) + ")",
           "(H, W) with at least one pixel");
  SceneImage scene(depth_m.height, depth_m.width);
  scene.depth_m = depth_m;
  const auto take = [&](const char* name, Image<float>& plane) {
    const py::object values = planes[name];
    if (values.is_none()) return;
    plane = to_image(values, name);
    if (plane.height != depth_m.height || plane.width != depth_m.width)
      refuse(name,
             "shape (" + std::to_string(plane.height) + ", " + std::to_string(plane.width) + ")",
             "shape (" + std::to_string(depth_m.height) + ", " + std::to_string(depth_m.width) +
                 ") as of depth_m");
  };
  take("albedo", scene.albedo);
  take("cosine", scene.cosine);
  take("ambient_scale", scene.ambient_scale);
  scene.validate();
  return scene;
}

py::array_t<float> capture_array(const py::dict& planes, const CodeSet& code, const Camera& camera,
                                 const py::dict& values, const py::object& callback) {
  CaptureOptions options;
  const OperatingPoint middle = camera.operating.middle();
  options.signal_e_per_s = middle.signal_e_per_s;
  options.ambient_e_per_s = middle.ambient_e_per_s;
  OptionReader(values, "")
      .value("signal_e_per_s", options.signal_e_per_s)
      .value("ambient_e_per_s", options.ambient_e_per_s)
      .value("reference_distance_m", options.reference_distance_m)
      .value("falloff", options.falloff)
      .value("seed", options.seed)
      .value("frames", options.frames)
      .finish();
  const SceneImage scene = scene_of(planes);
  RawFrames raw = without_gil(callback, [&](const Progress& progress) {
    return capture(scene, code, camera, options, progress);
  });
  return adopt(std::move(raw.values), {raw.frames, raw.height, raw.width, raw.measurements});
}

}  // namespace

void bind_simulate(py::module_& module) {
  module.def("capture", &capture_array);
  module.def("evaluate", [](const CodeSet& code, const Camera& camera, const py::dict& values,
                            const py::object& callback) {
    const EvaluateOptions options = evaluate_options(values);
    return report_dict(without_gil(callback, [&](const Progress& progress) {
      return evaluate(code, camera, options, progress);
    }));
  });
  module.def("best_rotation", [](const CodeSet& code, const Camera& camera, const py::dict& values,
                                 const py::object& callback) {
    const EvaluateOptions options = evaluate_options(values);
    BestRotation best = without_gil(callback, [&](const Progress& progress) {
      return best_rotation(code, camera, options, progress);
    });
    return py::make_tuple(best.rotation_bin, adopt(std::move(best.linear_geometric_mean_m)));
  });
  module.def("robustness", [](const CodeSet& code, const Camera& camera, const py::dict& values,
                              const py::object& callback) {
    const RobustnessOptions options = robustness_options(values);
    return robustness_dict(without_gil(callback, [&](const Progress& progress) {
      return robustness(code, camera, options, progress);
    }));
  });
}

}  // namespace tofsmith::python
