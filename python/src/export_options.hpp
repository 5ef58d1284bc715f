// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith::python {

/// Options of an export from a dict; the format is the caller's.
/// @throws std::invalid_argument naming an unknown name, TypeError for a value of another type
ExportOptions export_options(const std::string& format, const pybind11::dict& values);

}  // namespace tofsmith::python
