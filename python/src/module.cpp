// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "bindings.hpp"
#include "tofsmith/core/build_info.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith::python {

namespace {

/// Replaces --force of the command line by overwrite.
std::string in_words_of_python(std::string message) {
  constexpr std::string_view flag = "--force";
  const std::size_t place = message.find(flag);
  if (place != std::string::npos) message.replace(place, flag.size(), "overwrite=True");
  return message;
}

/// Raises `type` with the message and with details of the error as attributes.
void raise(PyObject* type, const std::string& message,
           std::initializer_list<std::pair<const char*, std::string>> attributes) {
  const py::object error = py::reinterpret_borrow<py::object>(type)(message);
  for (const auto& [name, value] : attributes) error.attr(name) = value;
  PyErr_SetObject(type, error.ptr());
}

py::dict build_info_dict() {
  const BuildInfo info = build_info();
  py::dict dict;
  dict["version"] = info.version;
  dict["commit"] = info.commit;
  dict["compiler"] = info.compiler;
  dict["build_type"] = info.build_type;
  dict["library"] = info.library;
  dict["targets"] = info.targets;
  dict["features"] = info.features;
  return dict;
}

/// Number of threads for all calls.
class ThreadSetting {
 public:
  void set(int threads) {
    limit_.reset();
    if (threads > 0) limit_ = std::make_unique<ThreadLimit>(threads);
  }

 private:
  std::unique_ptr<ThreadLimit> limit_;
};

}  // namespace

// The package tofsmith checks classes and documents them; the functions here have unnamed
// arguments, and options are dicts. std::invalid_argument becomes ValueError, with field, value and
// rule if known; IoError becomes OSError with its place.
PYBIND11_MODULE(_tofsmith, module) {
  py::options options;
  options.disable_function_signatures();
  module.doc() = "Compiled part of the package tofsmith; use that.";
  module.attr("version") = TOFSMITH_VERSION;
  module.def("build_info", build_info_dict);
  py::register_exception<Interrupted>(module, "Interrupted", PyExc_RuntimeError);
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const IoError& io) {
      raise(PyExc_OSError, in_words_of_python(io.what()), {{"place", io.place()}});
    } catch (const InvalidArgument& bad) {
      raise(PyExc_ValueError, bad.what(),
            {{"field", bad.field()}, {"value", bad.value()}, {"rule", bad.rule()}});
    }
  });
  auto* const setting = new ThreadSetting;  // lives as long as the module
  module.def("set_threads", [setting](int threads) { setting->set(threads); });

  bind_camera(module);
  bind_code(module);
  bind_forward_model(module);
  bind_decode(module);
  bind_filter(module);
  bind_scene(module);
  bind_capture(module);
  bind_simulate(module);
  bind_multipath(module);
  bind_design(module);
  bind_gradients(module);
  bind_files(module);
  bind_export(module);
  bind_sweep(module);
  bind_figures(module);
  bind_calibrate(module);
  bind_delay_sweep(module);
  bind_training_set(module);
}

}  // namespace tofsmith::python
