// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith::python {

/// (value, standard error).
pybind11::tuple pair_of(const Estimate& estimate);

/// What is not of its kind is left out.
pybind11::dict impulse_response_dict(const ImpulseResponse& response);

/// Results as dicts of numbers and arrays, under the names of the C++ fields; what belongs to
/// operating points is an array of one entry per point.
pybind11::dict report_dict(const DepthErrorReport& report);
/// The report that such a dict is of. @throws pybind11 errors for what is missing or of another
/// type
DepthErrorReport report_of(const pybind11::dict& values);
pybind11::dict loss_dict(const GeneratorLoss& loss);
pybind11::dict robustness_dict(const RobustnessReport& report);
pybind11::dict operating_multipath_dict(const OperatingMultipathReport& report);

}  // namespace tofsmith::python
