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

/// Returns a dict without the fields that the kind does not have.
pybind11::dict impulse_response_dict(const ImpulseResponse& response);

/// Converts results to dicts of numbers and arrays, with the names of the C++ fields; values per
/// operating point become arrays with one entry per point.
pybind11::dict report_dict(const DepthErrorReport& report);
/// Inverse of report_dict(). @throws pybind11 errors for missing entries or wrong types
DepthErrorReport report_of(const pybind11::dict& values);
pybind11::dict loss_dict(const GeneratorLoss& loss);
pybind11::dict robustness_dict(const RobustnessReport& report);
pybind11::dict operating_multipath_dict(const OperatingMultipathReport& report);

}  // namespace tofsmith::python
