// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "capture_arguments.hpp"
#include "lens.hpp"
#include "progress.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/sweep/training_set.hpp"

namespace tofsmith::python {

namespace {

void read_range(OptionReader& reader, const char* name, LightRange& range) {
  std::vector<double> ends;
  reader.value(name, ends);
  if (ends.empty()) return;
  if (ends.size() != 2) refuse(name, std::to_string(ends.size()) + " numbers", "(low, high)");
  range = {ends[0], ends[1]};
  range.validate(name);
}

LightRange always(double level_e_per_s) { return {level_e_per_s, level_e_per_s}; }

TrainingSetOptions set_options(const py::dict& values, const Camera& camera) {
  TrainingSetOptions options;
  OptionReader reader(values, "");
  reader.fields(options.capture, {"signal_e_per_s", "ambient_e_per_s"});
  const OperatingPoint usual = capture_light(camera, options.capture.reference_distance_m);
  options.signal = always(usual.signal_e_per_s);
  options.ambient = always(usual.ambient_e_per_s);
  read_range(reader, "signal_range", options.signal);
  read_range(reader, "ambient_range", options.ambient);
  std::vector<int> shard;
  reader.value("shard", shard);
  reader.finish();
  if (shard.size() == 2)
    options.shard = {shard[0], shard[1]};
  else if (!shard.empty())
    refuse("shard", std::to_string(shard.size()) + " numbers", "(index, count)");
  options.validate();
  return options;
}

/// Asks Python for a scene, from any thread.
LoadedTrainingScene load_scene(const py::object& load, const std::string& name) {
  const py::gil_scoped_acquire gil;
  try {
    const py::dict scene = load(name);
    LoadedTrainingScene loaded{scene_of(scene), {}};
    loaded.view =
        checked_view(py::dict(scene["lens"]), loaded.image.width(), loaded.image.height());
    return loaded;
  } catch (const py::error_already_set& error) {  // goes with its thread state
    throw std::runtime_error(error.what());
  }
}

py::dict write_set(const std::string& directory, const std::vector<std::string>& names,
                   const py::object& load, const CodeSet& code, const Camera& camera,
                   const py::dict& values, const py::object& callback) {
  const TrainingSetOptions options = set_options(values, camera);
  std::vector<TrainingScene> scenes;
  for (const std::string& name : names) scenes.push_back({name, name});
  const TrainingSetRun run = without_gil(callback, [&](const Progress& progress) {
    make_output_directory(directory);
    return write_training_set(
        directory, scenes, code.resampled(camera.samples), camera,
        [&](const TrainingScene& scene) { return load_scene(load, scene.name); }, options,
        progress);
  });
  py::dict dict;
  dict["scenes"] = run.scenes;
  dict["written"] = run.written;
  dict["kept"] = run.kept;
  dict["failures"] = run.failures;
  dict["index"] = run.index.string();
  return dict;
}

}  // namespace

void bind_training_set(py::module_& module) { module.def("write_training_set", &write_set); }

}  // namespace tofsmith::python
