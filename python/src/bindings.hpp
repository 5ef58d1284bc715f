// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

// One function per part of the module, each in a separate file, because pybind11 compiles slowly.
namespace tofsmith::python {

namespace py = pybind11;

void bind_camera(py::module_& module);
void bind_code(py::module_& module);
void bind_forward_model(py::module_& module);
void bind_decode(py::module_& module);
void bind_filter(py::module_& module);
void bind_scene(py::module_& module);
void bind_capture(py::module_& module);
void bind_simulate(py::module_& module);
void bind_multipath(py::module_& module);
void bind_design(py::module_& module);
void bind_gradients(py::module_& module);
void bind_files(py::module_& module);
void bind_export(py::module_& module);
void bind_sweep(py::module_& module);
void bind_figures(py::module_& module);
void bind_calibrate(py::module_& module);
void bind_delay_sweep(py::module_& module);
void bind_training_set(py::module_& module);

}  // namespace tofsmith::python
