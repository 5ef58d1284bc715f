// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include "tofsmith/decode/filter.hpp"
#include "tofsmith/decode/time_filter.hpp"

namespace tofsmith::python {

namespace py = pybind11;

/// The options of a strength, the entry "strength", with the fields that a dict has of its own.
/// @throws std::invalid_argument for names that no field has, and rules that are broken
FilterOptions filter_options(const py::dict& values);
/// The same of a filter in time, without strength.
TimeFilterOptions time_filter_options(const py::dict& values);

}  // namespace tofsmith::python
