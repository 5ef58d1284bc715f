// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include "tofsmith/decode/filter.hpp"
#include "tofsmith/decode/time_filter.hpp"

namespace tofsmith::python {

namespace py = pybind11;

/// Returns the options of the strength in entry "strength", overridden by the other entries.
/// @throws std::invalid_argument for unknown names and violated rules
FilterOptions filter_options(const py::dict& values);
/// Returns the options of a temporal filter, which has no strength.
TimeFilterOptions time_filter_options(const py::dict& values);

}  // namespace tofsmith::python
