// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <tuple>

#include "bindings.hpp"
#include "field_dicts.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/sweep/training_set.hpp"

namespace tofsmith::python {

namespace {

TrainingSetOptions set_options(const py::dict& values, const Camera& camera) {
  TrainingSetOptions options;
  CaptureOptions& capture = options.capture;
  OptionReader(values, "")
      .fields(options)
      .fields(capture, {"signal_e_per_s", "ambient_e_per_s"})
      .finish();
  const OperatingPoint usual = capture_light(camera, capture.reference_distance_m);
  capture.signal_e_per_s = usual.signal_e_per_s;
  capture.ambient_e_per_s = usual.ambient_e_per_s;
  options.validate();
  return options;
}

/// Loads a scene through Python, from any thread.
LoadedTrainingScene load_scene(const py::object& load, const std::string& name) {
  const py::gil_scoped_acquire gil;
  try {
    const py::dict scene = load(name);
    LoadedTrainingScene loaded{scene_of(scene), {}};
    loaded.view =
        checked_view(py::dict(scene["lens"]), loaded.image.width(), loaded.image.height());
    return loaded;
  } catch (const py::error_already_set& error) {  // destroyed with its thread state
    // Without the traceback, because the index must depend on the scenes only.
    const std::string text = error.what();
    throw std::runtime_error(text.substr(0, text.find("\n\nAt:\n")));
  }
}

std::vector<TrainingScene> scenes_of(const std::vector<std::string>& names) {
  std::vector<TrainingScene> scenes;
  for (const std::string& name : names) scenes.push_back({name, name});
  return scenes;
}

py::dict write_set(const std::string& directory, const std::vector<std::string>& names,
                   const py::object& load, const CodeSet& code, const Camera& camera,
                   const py::dict& values, const py::object& callback) {
  const TrainingSetOptions options = set_options(values, camera);
  const std::vector<TrainingScene> scenes = scenes_of(names);
  const TrainingSetRun run = without_gil(callback, [&](const Progress& progress) {
    make_output_directory(directory);
    return write_training_set(
        directory, scenes, code.resampled(camera.samples), camera,
        [&](const TrainingScene& scene) { return load_scene(load, scene.name); }, options,
        progress);
  });
  return fields_dict(run);
}

/// Name, entry of the index, problem, and whether the scene was written by this call.
using SceneTuple = std::tuple<std::string, std::string, std::string, bool>;

/// A training set whose scenes are written by several processes.
class BoundTrainingSet {
 public:
  BoundTrainingSet(const std::string& directory, const CodeSet& code, const Camera& camera,
                   const py::dict& values)
      : writer_(directory, code.resampled(camera.samples), camera, set_options(values, camera)) {
    make_output_directory(directory);
  }

  std::vector<std::string> names_of_shard(const std::vector<std::string>& names) const {
    std::vector<std::string> ours;
    for (const TrainingScene& scene : writer_.scenes_of_shard(scenes_of(names)))
      ours.push_back(scene.name);
    return ours;
  }
  std::vector<SceneTuple> write(const std::vector<std::string>& names, const py::object& load,
                                int threads) const {
    const py::gil_scoped_release release;
    const SharedThreadLimit limit(threads);
    std::vector<SceneTuple> outcomes(names.size());
    parallel_for_indices(names.size(), [&](std::size_t at) {
      const std::string& name = names[at];
      const TrainingSceneOutcome outcome = writer_.write(
          {name, name}, [&](const TrainingScene& scene) { return load_scene(load, scene.name); });
      outcomes[at] = {name, outcome.entry, outcome.problem, outcome.is_new};
    });
    return outcomes;
  }
  /// @param tuples  in the order of the index
  py::dict write_index(const std::vector<SceneTuple>& tuples) const {
    std::vector<TrainingScene> scenes;
    std::vector<TrainingSceneOutcome> outcomes;
    for (const auto& [name, entry, problem, is_new] : tuples) {
      scenes.push_back({name, name});
      outcomes.push_back({entry, problem, is_new});
    }
    return fields_dict(writer_.write_index(scenes, outcomes));
  }

 private:
  TrainingSetWriter writer_;
};

}  // namespace

void bind_training_set(py::module_& module) {
  module.def("write_training_set", &write_set);
  py::class_<BoundTrainingSet>(module, "TrainingSet")
      .def(py::init<const std::string&, const CodeSet&, const Camera&, const py::dict&>())
      .def("names_of_shard", &BoundTrainingSet::names_of_shard)
      .def("write", &BoundTrainingSet::write)
      .def("write_index", &BoundTrainingSet::write_index);
}

}  // namespace tofsmith::python
